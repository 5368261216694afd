# SPDX-License-Identifier: MIT
# A case of run.sh.

test_surfaces()
{
    octahedron >closed.obj
    expect 4 unwrap closed.obj -o out.obj
    error_says '^taut: error: closed.obj: .*boundary' '--cut' 'taut atlas'
    expect 4 view closed.obj --no-browser
    error_says 'boundary' '--shell'
    if grep -q -e --cut err; then fail "view offers an option that it has not"; fi
    for command in 'unwrap closed.glb -o out.obj' 'eval closed.glb'; do
        # shellcheck disable=SC2086
        expect 3 $command
        error_says 'closed.glb' 'taut atlas.*writes .glb and .gltf'
    done
    expect 3 check closed.glb
    says out 'taut atlas'
    expect 0 unwrap closed.obj --cut -o cut.obj --stats stats.json
    keys stats.json flipped seam_vertices quality.boundaries
    says values '^flipped=0$' '^quality.boundaries=1$'
    [ "$(grep -c "^v " cut.obj)" = 6 ] || fail "vertices were added"
    ring >ring.obj
    expect 4 unwrap ring.obj -o out.obj
    error_says 'boundary loops' '--holes'
    expect 0 unwrap ring.obj -o ring_out.obj --holes --quiet
    valid_map ring_out.obj
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf 1 2 3\nf 4 5 6\n' >two.obj
    expect 4 unwrap two.obj -o out.obj
    error_says 'component'
    printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n' >flat.obj
    expect 4 unwrap flat.obj -o out.obj
    error_says 'flat'
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 3 4\n' >clash.obj
    expect 4 unwrap clash.obj -o out.obj
    error_says 'orient' 'taut atlas --repair'
    : >empty.obj
    expect 4 unwrap empty.obj -o out.obj
    absent out.obj
}
