# SPDX-License-Identifier: MIT
# A case of run.sh.

# all_but_vt FILE: its lines without vt, and without what faces say of them.
all_but_vt() { awk '$1 != "vt" { if ($1 == "f" || $1 ~ /^[0-9]/) { gsub("/[0-9]*", "/"); gsub("/+", "") } print }' "$1"; }

test_roundtrip()
{
    # A closed surface is cut open along the seams that the file has; all it says stays, line by line.
    cube >cube.obj
    expect 0 unwrap cube.obj -o out.obj --stats stats.json
    says err 'note: cut open along the seams of its vt, on which 4 vertices lie' '6 polygons were split'
    says out '8 vertices, 12 triangles, 4 vertices on seams' '1 loop'
    keys stats.json vertices seam_vertices flipped
    says values '^vertices=8$' '^seam_vertices=4$' '^flipped=0$'
    all_but_vt cube.obj >before
    all_but_vt out.obj >after
    cmp -s before after || fail "more than vt has changed: $(diff before after)"
    [ "$(lines_of vt out.obj)" = 14 ] || fail "not one vt a vertex of the sheet"
    says out.obj '^f -8/[0-9]+ -7/[0-9]+ -3/[0-9]+ -4/[0-9]+$' '^f 4/[0-9]+/1 ' '# left$'
    valid_map out.obj
    expect 0 check cube.obj
    says out 'cut open along the seams' 'nothing wrong'

    # Again from its own output, and on from it.
    expect 0 unwrap out.obj -o again.obj --start uv --quiet
    all_but_vt again.obj >after
    cmp -s before after || fail "more than vt has changed"
    valid_map again.obj
    expect 0 unwrap cube.obj -o uv.obj --start uv --stats stats.json --quiet
    keys stats.json seam_vertices
    says values '^seam_vertices=4$'

    # Pins name vertices of the file; one that is cut apart has no single place.
    printf '4,0,0\n' >whole.csv
    printf '4,0,0\n0,1,1\n' >seam.csv
    expect 0 unwrap cube.obj -o out.obj --pins whole.csv --quiet
    says out.obj '^vt 0 0$'
    expect 4 unwrap cube.obj -o none.obj --pins seam.csv
    error_says 'the pin of vertex 0: it lies on a seam, which divides it into 2 vertices'
    expect 4 check cube.obj --pins seam.csv
    says out 'pin of vertex 0: it lies on a seam'

    cube apart >apart.obj
    expect 4 unwrap apart.obj -o none.obj
    error_says 'the surface is 6 charts with 6 boundary loops, not one disk'
    expect 4 check apart.obj
    says out '6 charts'
    absent none.obj

    # What is a disk already is mapped whole, unless its vt are the start.
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 0.5 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nvt 5 0\nvt 6 0.5\nvt 5 1\n' >seam.obj
    printf 'f 1/1 2/2 4/4 3/3\nf 2/5 5/6 4/7\n' >>seam.obj
    expect 0 unwrap seam.obj -o out.obj --quiet
    [ "$(lines_of vt out.obj)" = 5 ] || fail "cut without need"
    expect 4 unwrap seam.obj -o none.obj --start uv
    error_says '2 charts with 2 boundary loops'

    # Line ends, continued lines, a file without a last line end.
    printf '# a\r\nv 0 0 0 c\\\r\nv 9 9 9\r\nv 1 0 0\r\nv 0 \\\r\n1 0\r\ng all\r\nf 1// 2 \\\r\n3 # end' >lines.obj
    expect 0 unwrap lines.obj -o out.obj --quiet
    valid_map out.obj
    all_but_vt lines.obj >before
    all_but_vt out.obj >after
    cmp -s before after || fail "more than vt has changed: $(diff before after)"
    [ "$(grep -c "$(printf '\r')\$" out.obj)" = 11 ] || fail "line ends have changed"

    # OFF and PLY: colours, normals, polygons and comments.
    printf 'CNOFF\n# mine\n4 1 0\n0 0.00 0 0 0 1 255 0 0 255\n1 0 0 0 0 1 0 0 0 0\n1 1 0 0 0 1 0 0 0 0\n0 1 0 0 0 1 0 0 0 0\n4 0 1 2 3\n' >in.off
    expect 0 unwrap in.off -o out.obj --quiet
    says out.obj '^# mine$' '^v 0 0.00 0 1 0 0$' '^vn 0 0 1$' '^f 1/1/1 2/2/2 3/3/3 4/4/4$'
    valid_map out.obj
}
