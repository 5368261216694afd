# SPDX-License-Identifier: MIT
# A case of run.sh.

# ring: 16 rings of 24 quads about the origin as MEDIT; edges of the inner circle have reference 1, of the outer one 2. With
# fewer of them triangles would have to invert.
ring()
{
    awk 'function v(i, j) { return j * 24 + i % 24 + 1 }
        BEGIN {
            print "MeshVersionFormatted 2\nDimension 2\nVertices\n408"
            for (j = 0; j < 17; ++j) for (i = 0; i < 24; ++i)
                printf "%.17g %.17g 0\n", (1 + j) * cos(i * 0.261799387799149436), (1 + j) * sin(i * 0.261799387799149436)
            print "Edges\n48"
            for (i = 0; i < 24; ++i) print v(i, 0), v(i + 1, 0), 1 "\n" v(i, 16), v(i + 1, 16), 2
            print "Triangles\n768"
            for (j = 0; j < 16; ++j) for (i = 0; i < 24; ++i)
                print v(i, j), v(i, j + 1), v(i + 1, j + 1), 3 "\n" v(i, j), v(i + 1, j + 1), v(i + 1, j), 3
            print "End"
        }'
}

# wound FILE DEGREES: the first column of vertices winds by so many degrees from the outer circle to the inner one.
wound()
{
    awk -v wanted="$2" '/^Vertices/ { first = NR + 2 } first && NR >= first && NR < first + 408 {
            k = NR - first; if (k % 24 == 0) a[k / 24] = atan2($2, $1) }
        END {
            pi = atan2(0, -1)
            for (j = 15; j >= 0; --j) { d = a[j] - a[j + 1]; while (d > pi) d -= 2 * pi; while (d < -pi) d += 2 * pi; sum += d }
            sum *= 180 / pi
            print sum
            exit sum - wanted > 1e-6 || wanted - sum > 1e-6
        }' "$1" >wound || fail "the ring winds by $(cat wound) degrees, not $2"
}

# Rotations go as far as they are asked to, whatever places they end at.
test_rotations()
{
    ring >ring.mesh
    for angle in 90 200 270 360 -200; do
        expect 0 deform ring.mesh -o out.mesh --fix edges:2 --move edges:1:rotate:0,0,1,$angle --stats stats.json
        wound out.mesh $angle
        keys stats.json pins_held inverted
        says values '^pins_held=(true|ON)$' '^inverted=0$'
    done
    expect 0 deform ring.mesh -o out.mesh --fix edges:2 --move edges:1:rotate:0,0,-1,270 --quiet
    wound out.mesh -270
}
