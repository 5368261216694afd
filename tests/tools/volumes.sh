# SPDX-License-Identifier: MIT
# A case of run.sh.

# tangled: a volume on standard input whose inner vertices are moved by nearly an edge.
tangled()
{
    awk '/^Triangles/ { inside = 0 } inside && $1 > 0 && $1 < 1 && $2 > 0 && $2 < 1 && $3 > 0 && $3 < 3 {
        $1 += 0.3 * sin(7 * NR); $2 += 0.3 * cos(5 * NR); $3 += 0.3 * sin(3 * NR) } /^Vertices/ { inside = 1 } { print }'
}

# hexahedra [RAISED]: a bar of 2 x 2 x 4 hexahedra on a wedge, as VTK; corner (1, 1, 1) of the bar is raised.
hexahedra()
{
    awk -v raised="${1:-0}" 'function v(i, j, k) { return (k * 3 + j) * 3 + i }
        BEGIN {
            print "# vtk DataFile Version 3.0\nbar\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 47 double"
            for (k = 0; k < 5; ++k) for (j = 0; j < 3; ++j) for (i = 0; i < 3; ++i)
                print i, j, k + (i == 1 && j == 1 && k == 1 ? raised : 0)
            print "0 1 -1\n1 1 -1"
            print "CELLS 17 151"
            for (k = 0; k < 4; ++k) for (j = 0; j < 2; ++j) for (i = 0; i < 2; ++i)
                print 8, v(i, j, k), v(i + 1, j, k), v(i + 1, j + 1, k), v(i, j + 1, k),
                    v(i, j, k + 1), v(i + 1, j, k + 1), v(i + 1, j + 1, k + 1), v(i, j + 1, k + 1)
            print 6, v(0, 0, 0), v(0, 1, 0), 45, v(1, 0, 0), v(1, 1, 0), 46
            print "CELL_TYPES 17"
            for (c = 0; c < 16; ++c) print 12
            print "13\nPOINT_DATA 47\nSCALARS part int 1\nLOOKUP_TABLE default"
            for (p = 0; p < 47; ++p) print (p < 45 && p >= 36 ? 2 : p >= 45 ? 1 : 0)
        }'
}

test_volumes()
{
    # Tangled inside: the boundary stays, all but coordinates too.
    volume 3 | tangled >in.mesh
    expect 4 check in.mesh
    says out '^input +in.mesh: MEDIT, volume, 160 vertices, 486 tetrahedra' '^groups .*triangles:1 \(16\)' \
        '^orientation +as MEDIT files have it' '^inverted +[1-9][0-9]* of 486' '^error .*inverted, in a mesh that is oriented as MEDIT files are'
    expect 0 untangle in.mesh -o out.mesh --stats stats.json --picture out.png --clip x:0.6
    says out 'inverted +[1-9][0-9]* -> 0 of 486' '^outcome +injective' 'wrote +out.mesh, out.png, stats.json'
    keys stats.json schema format outcome inverted_start inverted branch_edges quality.mean_ratio.worst seconds.total
    says values 'schema=taut.untangle/1' '^inverted=0$' '^branch_edges=0$'
    png out.png
    echo 'vertex,x,y,z' >none.csv # as a page without pins saves it
    expect 0 untangle in.mesh -o out.mesh --boundary fixed --pins none.csv
    says err 'none.csv: has no pins'
    expect 0 check out.mesh --json
    cp out check.json
    keys check.json elements.tetrahedra components quality.mean_ratio.worst groups.0.name inverted
    says values '^elements.tetrahedra=486$' '^inverted=0$' '^components=1$'
    grep -v '^[-0-9.e]* [-0-9.e]* [-0-9.e]* 0$' in.mesh >before
    grep -v '^[-0-9.e]* [-0-9.e]* [-0-9.e]* 0$' out.mesh >after
    cmp before after || fail "more than coordinates has changed"
    [ "$(sed -n 7,22p in.mesh)" = "$(sed -n 7,22p out.mesh)" ] || fail "the boundary has moved"

    # Towards a rest shape, with groups and pins; a proof where what is held is turned over.
    volume 3 >rest.mesh
    expect 0 untangle in.mesh -o out.mesh --rest rest.mesh --fix triangles:1 --fix 2 --quiet --stats stats.json
    says stats.json '"pinned": 32'
    expect 0 untangle in.mesh -o out.mesh --boundary fixed --quiet
    volume 2 >other.mesh
    expect 4 untangle in.mesh -o late.mesh --rest other.mesh
    error_says 'other.mesh has 63 points, not 160'
    awk '/^Vertices/ { n = NR + 1 } n && NR == n + 1 { $3 = 2.5 } 1' rest.mesh >turned.mesh
    expect 7 untangle turned.mesh -o late.mesh --fix triangles:1 --fix triangles:2 --fix tetrahedra:7
    error_says 'infeasible' 'tetrahedra'
    expect 6 untangle in.mesh -o late.mesh --time-limit 1e-3 --stats late.json
    absent late.mesh
    absent late.json
    expect 2 untangle in.prob -o late.txt --fix 1
    error_says '--fix is for volume files'

    # Four tetrahedra around an edge, two pinned vertices beyond it: no map without splitting that.
    octahedron() # X of the two vertices
    {
        printf 'MeshVersionFormatted 2\nDimension 3\nVertices\n6\n0 0 -1 0\n0 0 1 0\n%s -1 0 3\n%s 1 0 3\n-1 1 0 0\n-1 -1 0 0\n' "$1" "$1"
        printf 'Tetrahedra\n4\n1 2 3 4 8\n1 2 4 5 8\n1 2 5 6 9\n1 2 6 3 9\nEnd\n'
    }
    octahedron 1 >flat.mesh
    octahedron -0.2 >folded.mesh
    expect 7 untangle folded.mesh -o mended.mesh --rest flat.mesh
    expect 0 untangle folded.mesh -o mended.mesh --rest flat.mesh --refine --refined-map parts.csv --stats stats.json
    says out '^refined +7 vertices, 8 elements in 1 round' '^wrote +mended.mesh, parts.csv'
    says err 'written anew'
    keys stats.json refined.rounds refined.vertices refined.elements outcome
    says values '^refined.elements=8$' '^outcome=injective$'
    [ "$(tr '\n' ' ' <parts.csv)" = 'element,of 0,0 1,0 2,1 3,1 4,2 5,2 6,3 7,3 ' ] || fail "parts.csv is wrong"
    expect 0 check mended.mesh --json
    cp out check.json
    keys check.json elements.tetrahedra inverted
    says values '^elements.tetrahedra=8$' '^inverted=0$'
    says mended.mesh '^0 0 -1 0$' '^-0.2 -1 0 3$' ' 9$'
    printf '0,0,0,-1\n1,0,0,1\n2,-0.2,-1,0\n3,-0.2,1,0\n4,-1,1,0\n5,-1,-1,0\n' >pins.csv
    expect 7 deform flat.mesh -o bent.mesh --pins pins.csv
    expect 0 deform flat.mesh -o bent.mesh --pins pins.csv --refine --refined-map parts.csv --stats stats.json
    says out '^refined +7 vertices, 8 elements'
    keys stats.json refined.rounds pins_held outcome
    says values '^refined.rounds=1$' '^pins_held=(true|ON)$'
    expect 0 deform flat.mesh -o same.mesh --move vertices:3:translate:0.1,0,0 --refine --quiet
    cmp -s flat.mesh same.mesh && fail "nothing was moved"
    awk 'NR > 4 && NR <= 10 { $1 = -$1 } 1' flat.mesh >mirrored.mesh
    expect 7 untangle mirrored.mesh -o late.mesh --rest flat.mesh --refine --refined-map late.csv
    error_says 'no split inside the mesh changes that'
    absent late.mesh
    absent late.csv
    {
        printf 'NDIME= 3\nNELEM= 1\n10 0 1 2 3\nNPOIN= 4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n'
    } >one.su2
    expect 3 deform one.su2 -o late.su2 --refine
    error_says 'convert it to MEDIT'
    expect 2 untangle folded.mesh -o late.mesh --refined-map late.csv
    error_says 'requires --refine'

    # Measures of a map, and of a mesh alone.
    expect 0 deform rest.mesh -o bent.mesh --fix 1 --move triangles:2:rotate:0,0,1,60 --quiet --picture bent.png --clip 0,1,0,0.4
    png bent.png
    expect 0 eval rest.mesh bent.mesh --picture eval.png
    says out '^inverted +0 of 486; det 0\.' '^winding +once around every inner edge' '^stretch +singular values' 'by volume'
    png eval.png
    expect 0 eval rest.mesh bent.mesh --json
    cp out eval.json
    keys eval.json schema inverted branch_edges quality.isometric.by_volume singular_values.least distortion.worst_ids.0
    says values 'schema=taut.eval/1' '^quality.isometric.by_volume=2\.'
    expect 0 eval bent.mesh
    says err 'no rest shape'
    expect 2 eval rest.mesh --clip x
    error_says '--clip needs --picture'
    expect 2 eval rest.mesh bent.mesh --picture eval.png --clip w
    error_says 'nx,ny,nz,d'
    expect 2 eval rest.mesh bent.mesh --picture eval.svg
    error_says 'pictures of volumes are PNG'

    # Hexahedra and a wedge: corners positive, insides judged.
    hexahedra >hex.vtk
    expect 0 check hex.vtk
    says out '1 wedge, 16 hexahedra' '^insides +all valid, by Bezier bounds'
    expect 0 deform hex.vtk -o out.vtk --fix part:1 --move part:2:rotate:0,0,1,60 --stats stats.json --picture hex.png --clip y
    says out '^wrote +out.vtk, hex.png, stats.json$'
    keys stats.json element elements inverted insides.negative insides.undecided
    says values '^element=mixed$' '^elements=17$' '^inverted=0$' '^insides.negative=0$'
    png hex.png
    expect 0 smooth out.vtk -o smooth.vtk --quiet
    hexahedra 1.4 >in.vtk
    expect 4 check in.vtk
    expect 0 untangle in.vtk -o out.vtk
    says out 'inverted +[1-9][0-9]* -> 0 of 17' '^insides +all valid'
    expect 0 check out.vtk

    # A cube whose pinned corners leave it negative inside has three free ones to mend that.
    {
        printf '# vtk DataFile Version 3.0\ncube\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n'
        printf '0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1\n'
        printf 'CELLS 1 9\n8 0 1 3 2 4 5 7 6\nCELL_TYPES 1\n12\n'
    } >cube.vtk
    printf '%s\n' 1,1.0692934568388306,-0.15830407000287444,-0.3420696437258779 \
        2,-0.08620260108766986,1.1336117301987767,0.2836630446159438 \
        3,0.7048490965511671,1.1249750254767161,-0.49951596637542817 \
        6,0.08104777577813349,1.131208164454124,0.4083118954171219 \
        7,0.5979066562316748,0.954349491440637,1.080404339472751 >pins.csv
    expect 0 deform cube.vtk -o out.vtk --pins pins.csv --stats stats.json
    says out '^insides +all valid'
    says err '1 cell was negative inside; solved again .* none left'
    keys stats.json insides.negative pins_held
    says values '^insides.negative=0$' '^pins_held=(true|ON)'

    # Quads of the plane.
    {
        printf 'MeshVersionFormatted 2\nDimension 2\nVertices\n9\n'
        printf '%s 0\n' '0 0' '1 0' '2 0' '0 1' '2.6 1.7' '2 1' '0 2' '1 2' '2 2'
        printf 'Quadrilaterals\n4\n1 2 5 4 1\n2 3 6 5 1\n4 5 8 7 1\n5 6 9 8 1\nEnd\n'
    } >quads.mesh
    expect 4 check quads.mesh
    says out 'MEDIT, planar, 9 vertices, 4 quads' 'error .*inverted'
    expect 0 untangle quads.mesh -o flat.mesh --picture quads.svg
    says quads.svg '<svg ' 'before' '>4 quads, 0 inverted  |'
    expect 0 check flat.mesh
    expect 0 smooth flat.mesh -o even.mesh --boundary fixed
    says out '^inverted +0 -> 0' 'mean ratio 1 worst'
    expect 2 smooth flat.mesh -o -
    error_says 'a mesh goes to a file'

    # A flat cell is told from one that is positive, if only just.
    {
        printf 'MeshVersionFormatted 2\nDimension 3\nVertices\n6\n'
        printf '%s 0\n' '0 0 0' '1 0 0' '0 1 0' '0.3 0.3 1' '0.3 0.3 -1e-17' '2 0 0'
        printf 'Tetrahedra\n3\n1 2 3 4 1\n1 3 2 5 1\n1 6 2 4 1\nEnd\n'
    } >thin.mesh
    expect 4 check thin.mesh
    says out '^error +1 tetrahedron \(2\) flat;' '^warning +1 tetrahedron \(1\) positive, but too thin'
    # What a command leaves with code 0 passes: it is certified, and no shape at rest.
    sed '/^1 6 2 4 1$/d; s/^3$/2/' thin.mesh >only_thin.mesh
    expect 0 untangle only_thin.mesh -o untangled.mesh
    expect 0 check untangled.mesh
    says out '^warning +1 tetrahedron \(1\) positive, but too thin' '^result +nothing wrong'
    expect 4 deform only_thin.mesh -o deformed.mesh
    error_says 'tetrahedron \(1\) flat'

    # Turned as another format has it: told, and read turned over.
    awk '$1 == 8 { print 8, $6, $7, $8, $9, $2, $3, $4, $5; next } 1' hex.vtk >turned.vtk
    expect 0 check turned.vtk
    says out 'warning +16 cells \(0, 1, 2, 3, 4, ...\) have their corners in the other order than VTK files or neighbours'
}
