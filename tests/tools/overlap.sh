# SPDX-License-Identifier: MIT
# A case of run.sh.

# ramp TURNS: a strip that winds up around an axis, 8 rows of quads, split.
ramp()
{
    awk -v turns="$1" 'BEGIN {
        n = int(40 * turns)
        for (i = 0; i <= n; ++i) for (j = 0; j <= 4; ++j)
        {
            a = 6.283185307179586 * turns * i / n; r = 1 - 0.1 * j
            printf "v %.17g %.17g %.17g\n", r * cos(a), r * sin(a), 0.1 * a
        }
        for (i = 0; i < n; ++i) for (j = 0; j < 4; ++j)
        {
            a = 5 * i + j + 1
            print "f", a, a + 6, a + 5
            print "f", a, a + 1, a + 6
        }
    }'
}

test_overlap()
{
    ramp 1.4 >ramp.obj
    expect 0 unwrap ramp.obj -o free.obj --quiet
    expect 0 eval free.obj --json
    cp out free.json
    keys free.json quality.boundary_crossings
    says values '^quality.boundary_crossings=[1-9]'
    expect 0 unwrap ramp.obj -o apart.obj --no-overlap --stats apart.json
    says out '^overlap .*crossing.* none after [0-9]+ round'
    valid_map apart.obj
    keys apart.json overlap.crossings_before overlap.all_crossings_counted overlap.energy_before overlap.rounds overlap.crossings \
        seconds.overlap quality.boundary_crossings flipped
    says values '^overlap.crossings_before=[1-9]' '^overlap.rounds=[1-9]' '^overlap.crossings=0' '^quality.boundary_crossings=0' \
        '^flipped=0'
    expect 0 unwrap ramp.obj -o square.obj --no-overlap --placement unit-square --energy shape --stats square.json --quiet
    keys square.json quality.boundary_crossings
    says values '^quality.boundary_crossings=0'

    grid 12 >grid.obj
    expect 0 unwrap grid.obj -o plain.obj --quiet
    expect 0 unwrap grid.obj -o same.obj --no-overlap --stats same.json --quiet
    cmp -s plain.obj same.obj || fail '--no-overlap changed a map without crossings'
    expect 0 unwrap grid.obj -o same.obj --no-overlap --boundary circle
    says err '--no-overlap has no effect'
    keys same.json overlap.crossings_before overlap.rounds
    says values '^overlap.crossings_before=0' '^overlap.rounds=0'

    # The two ends of the strip, pinned across each other.
    printf '0,1,0\n1,0.9,0\n280,0.95,0.05\n281,0.95,-0.05\n' >cross.csv
    expect 0 unwrap ramp.obj -o crossed.obj --pins cross.csv --quiet
    rm crossed.obj
    expect 7 unwrap ramp.obj -o crossed.obj --no-overlap --pins cross.csv
    error_says '1 pair .0-1-280-281. of edges between pinned vertices that meet'
    absent crossed.obj

    # Corners in one point, and a corner on an edge.
    printf '0,0,0\n168,0,0\n' >point.csv
    expect 7 unwrap grid.obj -o crossed.obj --no-overlap --pins point.csv
    error_says '1 pair .0-168. of pinned vertices in one point'
    printf '0,0,0\n1,1,0\n168,0.5,0\n' >on.csv
    expect 7 unwrap grid.obj -o crossed.obj --no-overlap --pins on.csv
    error_says '.0-1-168-168. of edges between pinned vertices that meet'
}
