# SPDX-License-Identifier: MIT
# What several cases of run.sh use.

fail()
{
    echo "FAILED: $*"
    echo "--- standard output"; cat out 2>/dev/null
    echo "--- standard error"; cat err 2>/dev/null
    exit 1
}

# expect CODE ARGUMENTS...: runs the program; its streams go to the files out and err.
expect()
{
    wanted=$1
    shift
    "$taut" "$@" >out 2>err
    code=$?
    [ "$code" = "$wanted" ] || fail "exit code $code instead of $wanted: taut $*"
}

# says FILE PATTERN...: every extended regular expression is found in the file.
says()
{
    file=$1
    shift
    for pattern in "$@"; do
        grep -Eq -e "$pattern" "$file" || fail "$file does not say: $pattern"
    done
}

silent() { [ ! -s "$1" ] || fail "$1 is not empty"; }

absent() { [ ! -e "$1" ] || fail "$1 exists"; }

# error_says PATTERN...: standard error is an error message with these words.
error_says()
{
    says err "^taut: error: " "$@"
}

# keys FILE KEY...: FILE is JSON with these keys; their values, key=value, go to the file values.
keys()
{
    json=$1
    shift
    list=$(IFS=';'; echo "$*")
    "$cmake" "-DFILE=$json" "-DKEYS=$list" -P "$here/json.cmake" >values 2>>err || fail "$json is not as promised"
}

# grid N [KIND]: a wavy sheet of 2 N^2 triangles on standard output as obj, off, ply, quads (obj), or with vt that
# are a plane projection: flat, mirrored, or folded.
grid()
{
    awk -v n="$1" -v kind="${2:-obj}" '
        function p(i, j) { x = i / n; y = j / n; return sprintf("%.17g %.17g %.17g", x, y, 0.3 * sin(7 * x) * cos(5 * y)) }
        function vertex(i, j) { return j * (n + 1) + i + one }
        function face(a, b, c)
        {
            if (kind == "off" || kind == "ply") print 3, a, b, c
            else if (vt) print "f", a "/" a, b "/" b, c "/" c
            else print "f", a, b, c
        }
        BEGIN {
            nv = (n + 1) * (n + 1); nf = 2 * n * n
            one = kind != "off" && kind != "ply"
            vt = kind == "flat" || kind == "mirrored" || kind == "folded"
            if (kind == "off") print "OFF\n" nv, nf, 0
            if (kind == "ply")
                print "ply\nformat ascii 1.0\nelement vertex " nv "\nproperty double x\nproperty double y\n" \
                      "property double z\nelement face " nf "\nproperty list uchar int vertex_indices\nend_header"
            for (j = 0; j <= n; ++j)
                for (i = 0; i <= n; ++i) print (one ? "v " : "") p(i, j)
            if (vt)
                for (j = 0; j <= n; ++j)
                    for (i = 0; i <= n; ++i)
                        print "vt", (kind == "mirrored" ? -i : kind == "folded" && i == n ? n - 2 : i) / n, j / n
            for (j = 0; j < n; ++j)
                for (i = 0; i < n; ++i)
                    if (kind == "quads") print "f", vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)
                    else
                    {
                        face(vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1))
                        face(vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1))
                    }
        }'
}

octahedron()
{
    printf 'v %s\n' '1 0 0' '-1 0 0' '0 1 0' '0 -1 0' '0 0 1' '0 0 -1'
    printf 'f %s\n' '1 3 5' '3 2 5' '2 4 5' '4 1 5' '3 1 6' '2 3 6' '4 2 6' '1 4 6'
}

# volume N: a bar of 6 * 3 N^3 tetrahedra as a MEDIT file; the triangles at its ends have references 1 and 2.
volume()
{
    awk -v n="$1" '
        function vertex(i, j, k) { return (k * (n + 1) + j) * (n + 1) + i + 1 }
        BEGIN {
            print "MeshVersionFormatted 2\n# a bar\nDimension 3\n\nVertices"
            print (n + 1) * (n + 1) * (3 * n + 1)
            for (k = 0; k <= 3 * n; ++k) for (j = 0; j <= n; ++j) for (i = 0; i <= n; ++i)
                printf "%.17g %.17g %.17g 0\n", i / n, j / n, k / n
            print "\nTriangles\n" 4 * n * n
            for (e = 0; e < 2; ++e) for (j = 0; j < n; ++j) for (i = 0; i < n; ++i) {
                k = 3 * n * e
                print vertex(i, j, k), vertex(i + 1, j, k), vertex(i + 1, j + 1, k), e + 1
                print vertex(i, j, k), vertex(i + 1, j + 1, k), vertex(i, j + 1, k), e + 1
            }
            print "\nTetrahedra\n" 18 * n * n * n
            for (k = 0; k < 3 * n; ++k) for (j = 0; j < n; ++j) for (i = 0; i < n; ++i) {
                a = vertex(i, j, k); b = vertex(i + 1, j + 1, k + 1)
                r[0] = vertex(i + 1, j, k); r[1] = vertex(i + 1, j + 1, k); r[2] = vertex(i, j + 1, k)
                r[3] = vertex(i, j + 1, k + 1); r[4] = vertex(i, j, k + 1); r[5] = vertex(i + 1, j, k + 1)
                for (s = 0; s < 6; ++s) print a, r[s], r[(s + 1) % 6], b, 7
            }
            print "\nEnd"
        }'
}

# A square ring of 8 quads around a hole, split.
ring()
{
    awk 'BEGIN {
        for (j = 0; j < 4; ++j) for (i = 0; i < 4; ++i) print "v", i, j, i * j / 9
        for (j = 0; j < 3; ++j) for (i = 0; i < 3; ++i) if (i != 1 || j != 1)
        {
            a = 4 * j + i + 1
            print "f", a, a + 1, a + 5
            print "f", a, a + 5, a + 4
        }
    }'
}

# same_vertices IN OUT: the v lines have the same numbers in the same order, compared as numbers.
same_vertices()
{
    awk '$1 == "v" { print $2 + 0, $3 + 0, $4 + 0 }' OFMT=%.17g CONVFMT=%.17g "$1" >vertices_in
    awk '$1 == "v" { print $2 + 0, $3 + 0, $4 + 0 }' OFMT=%.17g CONVFMT=%.17g "$2" >vertices_out
    cmp -s vertices_in vertices_out || fail "$2 does not keep the vertices of $1"
}

lines_of() { grep -c "^$1 " "$2"; }

# valid_map FILE: `taut eval` finds no flipped triangle.
valid_map()
{
    expect 0 eval "$1" --json
    cp out eval.json
    keys eval.json flipped
    says values '^flipped=0$'
}

# strip N [KIND]: a problem of 4 N triangles, a strip of height 2 whose boundary is pinned. KIND: valid, collapsed (the
# free vertices in one point), mirrored (so is the boundary), twisted (pinned like an eight), pinched (a pinned triangle
# that is flipped), free (nothing pinned)
strip()
{
    awk -v n="$1" -v kind="${2:-valid}" '
        function vertex(i, j) { return j * (n + 1) + i }
        BEGIN {
            nv = 3 * (n + 1)
            print nv, 2
            for (j = 0; j < 3; ++j) for (i = 0; i <= n; ++i) print i, j
            print nv, 2
            for (j = 0; j < 3; ++j)
                for (i = 0; i <= n; ++i)
                {
                    x = i; y = j
                    if (kind == "collapsed" && j == 1 && i > 0 && i < n) { x = n / 2; y = 1.9 }
                    if (kind == "mirrored") x = -x
                    if (kind == "twisted" && i >= n / 2) y = 2 - j
                    if (kind == "pinched" && i == 0 && j == 0) { x = 2; y = 3 }
                    printf "%.17g %.17g\n", x, y
                }
            print 4 * n, 3
            for (j = 0; j < 2; ++j)
                for (i = 0; i < n; ++i)
                {
                    print vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)
                    print vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)
                }
            list = ""; k = 0
            if (kind != "free")
                for (j = 0; j < 3; ++j)
                    for (i = 0; i <= n; ++i)
                        if (j != 1 || i == 0 || i == n) { list = list vertex(i, j) "\n"; ++k }
            printf "%d\n%s", k, list
        }'
}

# star N: a problem of a square of 2 N^2 triangles whose boundary is pinned to a star with four deep notches.
star()
{
    awk -v n="$1" '
        function vertex(i, j) { return j * (n + 1) + i }
        # The place along the boundary, counter-clockwise from the lower left corner; -1 inside.
        function along(i, j) { return j == 0 ? i : i == n ? n + j : j == n ? 3 * n - i : i == 0 ? 4 * n - j : -1 }
        BEGIN {
            nv = (n + 1) * (n + 1)
            print nv, 2
            for (j = 0; j <= n; ++j) for (i = 0; i <= n; ++i) print i, j
            print nv, 2
            for (j = 0; j <= n; ++j)
                for (i = 0; i <= n; ++i)
                {
                    k = along(i, j)
                    a = 8 * atan2(1, 1) * k / (4 * n)
                    r = k < 0 ? 0 : 1 + 0.8 * cos(4 * a)
                    printf "%.17g %.17g\n", r * cos(a), r * sin(a)
                }
            print 2 * n * n, 3
            for (j = 0; j < n; ++j)
                for (i = 0; i < n; ++i)
                {
                    print vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)
                    print vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)
                }
            print 4 * n
            for (j = 0; j <= n; ++j) for (i = 0; i <= n; ++i) if (along(i, j) >= 0) print vertex(i, j)
        }'
}

# keeps_pins PROBLEM MAP: the map has the fixed vertices where the problem has them.
keeps_pins()
{
    awk 'NR == FNR { x[FNR - 1] = $1 + 0; y[FNR - 1] = $2 + 0; next }
         FNR == 1 { n = $1 }
         FNR > n + 2 && FNR <= 2 * n + 2 { u[FNR - n - 3] = $1 + 0; v[FNR - n - 3] = $2 + 0 }
         FNR == 2 * n + 3 { cells = $1 }
         FNR > 2 * n + 4 + cells && (x[$1] != u[$1] || y[$1] != v[$1]) { bad = 1 }
         END { exit bad }' "$2" "$1" || fail "$2 moves a pin of $1"
}

# A closed cube of quads as a modelling program writes it, its vt a cross of six squares, or `apart`: six charts.
cube()
{
    printf '%s\n' '# by hand' 'mtllib cube.mtl' 'o cube' 'v 0 0 0 1 0 0' 'v 1 0 0 1 0 0' 'v 1 1.000 0 1 0 0' \
        'v 0 1 0 1 0 0' 'v 0 0 1 0 0 1' 'v 1 0 1 0 0 1' 'v 1 1 1 0 0 1' 'v 0 1 1 0 0 1' 'vn 0 0 -1'
    if [ "${1:-cross}" = apart ]; then
        printf 'vt %s\n' '0 0' '1 0' '1 1' '0 1' '2 0' '3 0' '3 1' '2 1'
        printf '%s\n' 'f 4/1 3/2 2/3 1/4' 'f 1/5 2/6 6/7 5/8' 'f 5/1 6/2 7/3 8/4' 'f 8/5 7/6 3/7 4/8' 'f 2/1 3/2 7/3 6/4' \
            'f 4/5 1/6 5/7 8/8'
        return
    fi
    printf 'vt %s\n' '1 0' '2 0' '1 1' '2 1' '1 2' '2 2' '1 3' '2 3' '1 4' '2 4' '0 2' '0 3' '3 2' '3 3'
    printf '%s\n' 'usemtl bottom' 's off' 'f 4/1/1 3/2/1 2/4/1 1/3/1' 'usemtl front' 'f -8/3 -7/4 -3/6 -4/5' 'g top' \
        'f 5/5 6/6 7/8 8/7' 'f 8/7 7/8 3/10 4/9' 'f 2/13 3/14 7/8 6/6' 'f 4/12 1/11 5/5 8/7 # left'
}

# stopped REASON: the map is valid, and the statistics say why the run ended.
stopped()
{
    keys stats.json stop flipped
    says values "^stop=$1\$" '^flipped=0$'
    same_vertices in.obj out.obj
    valid_map out.obj
}

# A file is a picture.
png() { [ "$(od -An -tx1 -N8 "$1" | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "$1 is no PNG"; }
