# SPDX-License-Identifier: MIT
# A case of run.sh.

test_untangle()
{
    strip 8 collapsed >in.prob
    cp in.prob copy.prob
    expect 3 untangle in.obj -o out.txt
    error_says 'in.obj: is a surface in space'
    expect 0 untangle in.prob -o out.txt --stats stats.json --picture out.png
    says out '^problem .*27 vertices, 32 triangles, 20 vertices pinned' '^inverted +[1-9][0-9]* -> 0 of 32' \
        '^outcome +injective' '^wrote +out.txt'
    silent err
    [ "$(wc -l <out.txt)" = 27 ] || fail "not one line a vertex"
    keeps_pins in.prob out.txt
    absent out.txt.invalid
    keys stats.json schema outcome inverted min_relative_det stage stages.0.name stages.0.stage seconds.solve seconds.total device
    says values '^outcome=injective$' '^inverted=0$'
    [ "$(od -An -tx1 -N8 out.png | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "out.png is no PNG"

    # The map, as the initial map of the same problem, is valid: nothing is left to do.
    awk 'NR == FNR { map[FNR] = $0; next } FNR == 1 { n = $1 } FNR > n + 2 && FNR <= 2 * n + 2 { $0 = map[FNR - n - 2] } 1' \
        out.txt in.prob >again.prob
    expect 0 check again.prob
    says out '^map +0 of 32'
    expect 0 untangle again.prob -o again.txt --quiet --picture again.svg
    silent out
    silent err
    says again.svg '<svg ' 'before' 'after' '>pin</text>'
    keeps_pins in.prob again.txt
    cmp -s in.prob copy.prob || fail "the input was changed"

    # Proofs come before anything is solved, and need no device.
    echo precious >kept.txt
    for kind in mirrored twisted pinched; do
        strip 8 $kind >$kind.prob
        expect 7 untangle $kind.prob -o kept.txt --stats stats.json --device 'no such device'
        error_says 'infeasible'
        keys stats.json outcome reason ids.0 output
        says values '^outcome=infeasible$'
    done
    [ "$(cat kept.txt)" = precious ] || fail "a failed run touched its output"

    # A map with flips never gets the name that was asked for.
    star 200 >large.prob
    for limit in 0.02 0.03 0.05 0.08 0.12 0.2 0.3 0.5 0.8 1.3 2 3 5; do # until there is time to begin
        expect 6 untangle large.prob -o late.txt --time-limit $limit --stats stats.json
        [ ! -e late.txt.invalid ] || break
        error_says 'time limit came before there was a map'
    done
    error_says 'no valid map' 'late.txt.invalid'
    absent late.txt
    keeps_pins large.prob late.txt.invalid
    keys stats.json outcome ids.0
    says values '^outcome=gave_up$'

    expect 0 untangle in.prob -o out.txt --progress json
    says err '"phase":"read"' '"phase":"untangle"' '"phase":"write"'

    # A tetrahedron of four, whose inner vertex starts outside.
    {
        printf '5 3\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n1 1 1\n5 3\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n3 3 3\n'
        printf '4 4\n4 1 2 3\n0 4 2 3\n0 1 4 3\n0 1 2 4\n4\n0\n1\n2\n3\n'
    } >volume.prob
    expect 0 check volume.prob
    says out 'problem of tetrahedra, 5 vertices, 4 tetrahedra' '^map +1 of 4 inverted'
    expect 0 untangle volume.prob -o volume.txt --stats stats.json
    keys stats.json element outcome
    says values '^element=tetrahedron$' '^outcome=injective$'
    expect 0 untangle volume.prob -o volume.txt --picture volume.png --clip x:0.9 --quiet
    png volume.png
    expect 2 untangle volume.prob -o volume.txt --picture volume.svg
    error_says 'volume.svg' '.png'
    expect 2 untangle in.prob -o out.txt --picture out.png --clip x
    error_says '--clip' 'planar'

    # A problem that has a solution where an element is split; what is written is a problem, too.
    {
        printf '6 3\n0 0 -1\n0 0 1\n1 -1 0\n1 1 0\n-1 1 0\n-1 -1 0\n6 3\n0 0 -1\n0 0 1\n-0.2 -1 0\n-0.2 1 0\n-1 1 0\n-1 -1 0\n'
        printf '4 4\n0 1 2 3\n0 1 3 4\n0 1 4 5\n0 1 5 2\n6\n0\n1\n2\n3\n4\n5\n'
    } >folded.prob
    expect 7 untangle folded.prob -o mended.prob
    expect 0 untangle folded.prob -o mended.prob --refine --quiet
    expect 0 check mended.prob
    says out '^input .*7 vertices, 8 tetrahedra' '^map +0 of 8'

    expect 2 untangle in.prob
    error_says '--output is required'
    expect 2 untangle in.prob -o missing/out.txt
    error_says 'no folder missing'
    expect 2 untangle in.prob -o in.prob
    error_says 'overwrite the input'
    expect 2 untangle in.prob -o out.txt --picture out.jpg
    error_says '.png or .svg'
    expect 2 untangle in.prob -o out.txt --time-limit 0
    error_says '--time-limit'
    expect 3 untangle nothing.prob -o out.txt
    error_says 'nothing.prob'
    printf '3 2\n0 0\n1 0\n0 one\n' >word.prob
    expect 3 untangle word.prob -o out.txt
    error_says 'line 4'
    expect 5 untangle in.prob -o out.txt --device 'no such device'
}
