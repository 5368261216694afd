# SPDX-License-Identifier: MIT
# A case of run.sh.

test_pins()
{
    grid 4 >in.obj
    # The corner of the grid held exactly, one coordinate of another, a spring; the file keeps 17 digits of both.
    printf 'vertex,u,v,weight\n0,0.1,0.3,\n24,1.7,,\n12,0.9,0.8,10\n' >pins.csv
    expect 0 unwrap in.obj -o out.obj --pins pins.csv --stats stats.json --picture out.svg
    says out 'constraints +2 vertices pinned, 1 spring'
    keys stats.json constraints.pins constraints.springs seconds.untangle flipped
    says values '^constraints.pins=2$' '^constraints.springs=1$' '^flipped=0$'
    grep '^vt' out.obj | sed -n 1p | grep -qx 'vt 0.1 0.3' || fail "vertex 0 is not where it is pinned"
    grep '^vt' out.obj | sed -n 25p | grep -q '^vt 1.7 ' || fail "vertex 24 has not the u that is held"
    grep -q 'spring' out.svg || fail "the picture has no legend for springs"

    printf '0,0,0\n1,1,0\n6,1,-1\n' >flip.csv # a triangle of the grid
    expect 7 unwrap in.obj -o no.obj --pins flip.csv
    says err 'infeasible' 'all vertices pinned, flipped or flat'
    [ ! -e no.obj ] || fail "a map was written for an infeasible problem"
    printf '0,0,0\n0,1,0\n' >twice.csv
    expect 3 unwrap in.obj -o no.obj --pins twice.csv
    says err 'twice.csv, line 2: vertex 0'
    expect 3 unwrap in.obj -o no.obj --pins missing.csv
    echo 'vertex,u,v' >none.csv # as a page without pins saves it
    expect 0 unwrap in.obj -o out.obj --pins none.csv
    says err 'none.csv: has no pins'

    # Four vertices change places with those across within a fixed boundary. What is left is told once.
    grid 6 >six.obj
    awk 'BEGIN {
        for (v = 0; v < 49; ++v) {
            i = v % 7; j = int(v / 7)
            if (i % 6 == 0 || j % 6 == 0) print v "," i / 6 "," j / 6
            else if ((i == 2 || i == 4) && (j == 2 || j == 4)) print v "," 1 - i / 6 "," 1 - j / 6
        }
    }' >turned.csv
    expect 6 unwrap six.obj -o no.obj --pins turned.csv
    error_says 'no stage makes progress: [0-9]+ triangles? \([0-9, .]+\) flipped'
    [ "$(tr -cd '(' <err | wc -c)" = 1 ] || fail "ids are told twice"
}
