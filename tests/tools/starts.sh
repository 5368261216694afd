# SPDX-License-Identifier: MIT
# A case of run.sh.

test_starts()
{
    grid 6 flat >flat.obj
    expect 0 unwrap flat.obj -o out.obj --start uv --stats stats.json
    keys stats.json energy_start energy
    valid_map out.obj
    grid 6 mirrored >mirrored.obj
    expect 0 unwrap mirrored.obj -o out.obj --start uv
    says err 'note: .*mirrored'
    valid_map out.obj
    rm out.obj

    grid 6 folded >folded.obj
    expect 0 unwrap folded.obj -o out.obj --start uv
    says err 'the start had 12 triangles .* flipped; it was untangled'
    valid_map out.obj
    rm out.obj
    grid 6 >bare.obj
    expect 4 unwrap bare.obj -o out.obj --start uv
    error_says 'no texture coordinates'
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 5 0\nvt 6 1\nvt 5 1\n' >seam.obj
    printf 'f 1/1 2/2 3/3\nf 2/4 4/5 3/6\n' >>seam.obj
    expect 4 unwrap seam.obj -o out.obj --start uv
    error_says 'seam'
    absent out.obj
}
