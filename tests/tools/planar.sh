# SPDX-License-Identifier: MIT
# A case of run.sh.

# plate Z: 6 x 6 squares of two triangles each in the plane z = Z, as MEDIT; the edges at its ends have references 1 and 2.
plate()
{
    awk -v z="$1" 'function v(i, j) { return j * 7 + i + 1 }
        BEGIN {
            print "MeshVersionFormatted 2\nDimension 3\nVertices\n49"
            for (j = 0; j < 7; ++j) for (i = 0; i < 7; ++i) print i, j, z, 0
            print "Edges\n12"
            for (j = 0; j < 6; ++j) print v(0, j), v(0, j + 1), 1 "\n" v(6, j), v(6, j + 1), 2
            print "Triangles\n72"
            for (j = 0; j < 6; ++j) for (i = 0; i < 6; ++i)
                print v(i, j), v(i + 1, j), v(i + 1, j + 1), 3 "\n" v(i, j), v(i + 1, j + 1), v(i, j + 1), 3
            print "End"
        }'
}

# stands FILE VERTEX X Y Z: the vertex, counted from 0, of a MEDIT file is there, in these very words or to 1e-6.
stands()
{
    awk -v n="$2" -v x="$3" -v y="$4" -v z="$5" '
        function off(a, b) { return a - b > 1e-6 || b - a > 1e-6 }
        /^Vertices/ { first = NR + 2 } first && NR == first + n {
            found = 1; if (off($1, x) || off($2, y) || off($3, z)) { print "it is at", $0; exit 1 } exit }
        END { exit !found }' "$1" || fail "vertex $2 of $1 is not at $3 $4 $5"
}

# A planar mesh in a format of three coordinates: pins have z, the plane is any.
test_planar()
{
    for z in 0 5; do
        plate $z >plate.mesh
        printf '0,0,0,%s\n6,7,0.5,%s\n42,0,6,%s\n48,7,6.5,%s\n' $z $z $z $z >pins.csv
        for command in deform untangle; do
            expect 0 $command plate.mesh -o out.mesh --pins pins.csv --stats stats.json
            silent err
            stands out.mesh 6 7 0.5 $z
            stands out.mesh 48 7 6.5 $z
        done
        printf 'vertex,x,y,z,weight\n0,0,0,%s,\n6,6,0,,\n48,8,6,%s,50\n' $z $z >soft.csv
        expect 0 deform plate.mesh -o out.mesh --pins soft.csv --stats stats.json
        keys stats.json pins springs
        says values '^pins=2$' '^springs=1$'
        expect 0 deform plate.mesh -o out.mesh --fix edges:1 --move edges:2:translate:0.5,0.3,0 --quiet
        stands out.mesh 6 6.5 0.3 $z
        expect 0 smooth out.mesh -o even.mesh --quiet
        stands even.mesh 6 6.5 0.3 $z
        printf 'vertex,x,y,z\n6,7,1,%s\n' $z >end.csv
        expect 0 deform plate.mesh -o out.mesh --fix edges:1 --move edges:2=end.csv --quiet
        stands out.mesh 6 7 1 $z
    done
    expect 0 check plate.mesh --pins pins.csv
    printf '0,0,0,5\n6,7,0.5,4\n' >pins.csv
    for command in deform untangle check; do
        [ $command = check ] && out= || out='-o late.mesh'
        "$taut" $command plate.mesh $out --pins pins.csv >out 2>err && fail "$command takes a pin beside the plane"
        cat out err >both
        says both 'pins.csv, line 2: z is 4, and the mesh lies in the plane z = 5'
    done
    printf '0,0,0\n6,7,0.5,5,0\n' >pins.csv
    expect 3 deform plate.mesh -o late.mesh --pins pins.csv
    error_says 'pins.csv, line 2: a weight of 0, which does nothing'
    expect 4 deform plate.mesh -o late.mesh --fix edges:1 --move edges:2:translate:0,0,1
    error_says 'vertex 6 of edges:2 goes to z = 6, out of the plane of the mesh, z = 5'
    expect 4 deform plate.mesh -o late.mesh --fix edges:1 --move edges:2:rotate:1,0,0,30
    error_says 'out of the plane'
    absent late.mesh
}
