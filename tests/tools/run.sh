#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh CASE PROGRAM FOLDER CMAKE: one group of tests of the program, in an emptied FOLDER.
set -u
case_name=$1 taut=$2 folder=$3 cmake=$4
here=$(cd "$(dirname "$0")" && pwd)

rm -rf "$folder"
mkdir -p "$folder"
cd "$folder" || exit 1
unset TAUT_DEVICE

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

# A closed fan of 12 triangles whose vt wind twice around vertex 0.
wound_fan()
{
    awk 'BEGIN {
        turn = 8 * atan2(1, 1); n = 12
        print "v 0 0 0\nvt 0 0"
        for (k = 0; k < n; ++k) printf "v %.17g %.17g 0.1\n", cos(turn * k / n), sin(turn * k / n)
        for (k = 0; k < n; ++k) printf "vt %.17g %.17g\n", cos(2 * turn * k / n + 0.1), sin(2 * turn * k / n + 0.1)
        for (k = 0; k < n; ++k) printf "f 1/1 %d/%d %d/%d\n", k + 2, k + 2, (k + 1) % n + 2, (k + 1) % n + 2
    }'
}

# wound_problem FIXED: the same as a problem whose first FIXED vertices are fixed.
wound_problem()
{
    awk -v fixed="$1" 'BEGIN {
        turn = 8 * atan2(1, 1); n = 12
        for (lap = 1; lap <= 2; ++lap) {
            print n + 1, 2
            print "0 0"
            for (k = 0; k < n; ++k) printf "%.17g %.17g\n", cos(lap * turn * k / n + 0.1), sin(lap * turn * k / n + 0.1)
        }
        print n, 3
        for (k = 0; k < n; ++k) print 0, k + 1, (k + 1) % n + 1
        print fixed
        for (k = 0; k < fixed; ++k) print k
    }'
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

test_usage()
{
    grid 4 >in.obj
    expect 0 --help
    says out 'unwrap' 'untangle' 'check' 'eval' 'devices' 'exit codes: 0 valid map; 2 usage'
    expect 0 unwrap --help
    says out '--energy isometric\|shape\|area' '--time-limit' '130 interrupted'
    expect 0 --version
    says out '^taut [0-9]+\.[0-9]+\.[0-9]+$'

    expect 2
    error_says 'subcommand' '--help'
    expect 2 flatten in.obj
    error_says 'no subcommand flatten' '--help'
    expect 2 unwarp in.obj
    error_says 'no subcommand unwarp' 'did you mean unwrap'
    expect 2 unwrap in.obj
    error_says '--output is required' 'taut unwrap --help'
    expect 2 unwrap -o out.obj
    error_says 'IN is required'
    expect 2 unwrap in.obj -o out.obj --colour red
    error_says '--colour'
    expect 2 unwrap in.obj -o out.obj --energy warm
    error_says '--energy' 'warm' 'isometric'
    expect 2 unwrap in.obj -o out.obj --iterations many
    error_says '--iterations' 'many is no whole number'
    expect 2 unwrap in.obj -o out.obj --device ''
    error_says '--device' 'without a name'
    expect 0 view --help
    says out 'exit codes: 0 ended'
    expect 2 unwrap in.obj -o out.obj --time-limit 20,5
    error_says '--time-limit' '20,5 is no number'
    for wrong in '--iterations -1' '--tolerance -1' '--tolerance 2' '--tolerance nan' '--time-limit 0' \
                 '--time-limit -3' '--time-limit nan' '--boundary circle --start uv' '--precision half' \
                 '--solver simplex' '--start tube' \
                 '--start conformal --boundary square' '--start coarse --solver lbfgs' '--up +z' '--front -y' \
                 '--placement here' '--placement as-solved --pins p.csv'; do
        # shellcheck disable=SC2086
        expect 2 unwrap in.obj -o out.obj $wrong
        error_says "${wrong%% *}"
        [ "$(wc -l <err)" = 1 ] || fail "more than one line for $wrong"
    done
    absent out.obj
}

test_outputs()
{
    grid 4 >in.obj
    cp in.obj copy.obj
    expect 2 unwrap in.obj -o missing/out.obj
    error_says 'no folder missing'
    expect 2 unwrap in.obj -o out.ply
    error_says 'must end in .obj'
    expect 2 unwrap in.obj -o .
    error_says 'is a folder'
    expect 2 unwrap in.obj -o out.obj --picture out.jpg
    error_says '--picture' '.png or .svg'
    expect 2 unwrap in.obj -o out.obj --stats missing/stats.json
    error_says '--stats' 'no folder'
    expect 2 unwrap in.obj -o out.obj --picture same.png --render ./same.png
    error_says 'is also the file of --picture'
    # Nothing is solved before the outputs are known to be writable: the input need not even be there.
    expect 2 unwrap nothing.obj -o missing/out.obj
    absent out.obj

    # What was there stays when a run fails, and temporary files do not.
    echo precious >out.obj
    octahedron >closed.obj
    ls -A >before
    expect 4 unwrap closed.obj -o out.obj
    [ "$(cat out.obj)" = precious ] || fail "a failed run touched its output"
    # All outputs of a run, or none: an error when the work is done changes no file.
    if [ -w /dev/full ]; then
        expect 2 unwrap in.obj -o /dev/full --quiet
        error_says 'No space left'
        expect 2 unwrap in.obj -o out.obj --stats /dev/full --picture out.png --quiet
        error_says '/dev/full'
        "$taut" unwrap in.obj -o out.obj >/dev/full 2>err
        [ $? = 2 ] || fail "no error where the report cannot be printed"
        [ "$(cat out.obj)" = precious ] || fail "an output was replaced without the others"
    fi
    ls -A | diff before - >out || fail "files are left"
    rm out.obj

    # In place, as asked.
    cp in.obj place.obj
    expect 0 unwrap place.obj -o place.obj --quiet
    silent out
    silent err
    same_vertices in.obj place.obj
    valid_map place.obj
    # The input is no place for anything else, nor are pins for any output.
    printf '0,0,0\n' >pins.obj
    cp pins.obj pins.copy
    ln -s in.obj link.json
    ln in.obj hard.json
    ln -s pins.obj pins.json
    ln pins.obj hard_pins.json
    for name in link hard; do
        expect 2 unwrap in.obj -o out.obj --stats $name.json
        error_says 'overwrite the input'
    done
    expect 2 unwrap - -o out.obj --stats hard.json <in.obj
    error_says 'overwrite the input'
    for name in pins hard_pins; do
        expect 2 unwrap in.obj -o out.obj --pins pins.obj --stats $name.json
        error_says 'overwrite the pins'
    done
    expect 2 unwrap in.obj -o pins.obj --pins pins.obj
    error_says 'overwrite the pins'
    cp in.obj out.obj.invalid
    expect 2 unwrap out.obj.invalid --format obj -o out.obj
    error_says 'overwrite the input'
    cmp -s pins.obj pins.copy || fail "the pins were changed"
    ln hard.json out.obj
    expect 2 unwrap copy.obj -o out.obj --stats hard.json
    error_says 'is also the file of'
    expect 2 unwrap in.obj -o - --stats -
    error_says 'is also the file of'
    cmp -s in.obj copy.obj || fail "the input was changed"
}

# What is no file is written through and stays what it is, for pictures, too.
test_streams()
{
    grid 4 >in.obj
    expect 0 unwrap in.obj -o out.obj --quiet
    mkfifo pipe
    for options in 'in.obj -o copy.obj --picture' 'in.obj -o copy.obj --render'; do
        timeout 60 cat pipe >from_pipe &
        # shellcheck disable=SC2086
        expect 0 unwrap $options pipe --quiet
        wait
        [ -p pipe ] || fail "the pipe was replaced"
        [ "$(od -An -tx1 -N8 from_pipe | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "no PNG came through: $options"
    done
    if mknod null c 1 3 2>/dev/null && : 2>/dev/null >null; then
        expect 0 unwrap in.obj -o null --picture ./null --render null --quiet
        [ -c null ] || fail "the device was replaced"
        absent null.invalid
    else
        echo "without a device of our own: only root makes one"
    fi
    # Whatever ends a run before all is written leaves nothing: here it waits for a reader of the pipe.
    ls -A >before
    "$taut" unwrap in.obj -o new.obj --render pipe --quiet --progress json 2>err &
    program=$!
    until grep -q '"phase":"write"' err; do
        kill -0 $program || fail "ended before it was killed"
        sleep 0.1
    done
    sleep 0.5
    kill -KILL $program
    wait $program 2>/dev/null
    case $(stat -f -c %T . 2>/dev/null) in
    ext2/ext3 | xfs | btrfs | tmpfs) ls -A | diff before - >out || fail "a killed run has left files" ;;
    *) echo "this file system may have no files without a name" ;;
    esac
    ln -s picture.png link.png
    chmod 640 out.obj
    expect 0 unwrap in.obj -o out.obj --picture link.png --quiet
    [ -L link.png ] || fail "the link was replaced"
    [ -f picture.png ] || fail "the link was not followed"
    [ "$(ls -l out.obj | cut -c 1-10)" = -rw-r----- ] || fail "the permissions are not kept"

    # Standard input and output, as - and by name, into a pipe and into a file.
    expect 0 unwrap - -o - <in.obj
    cmp -s out out.obj || fail "another map by standard streams"
    says err '^mesh +/dev/stdin: 25 vertices' '^wrote +/dev/stdout$'
    expect 0 unwrap /dev/stdin -o /dev/stdout --quiet --stats stats.json <in.obj
    cmp -s out out.obj || fail "another map by standard streams"
    keys stats.json input output
    says values '^input=/dev/stdin$' '^output=/dev/stdout$'
    cat in.obj | "$taut" unwrap - -o - --quiet | cmp -s - out.obj || fail "another map through pipes"
    { echo before; "$taut" unwrap in.obj -o - --quiet; echo after; } >all
    { echo before; cat out.obj; echo after; } | cmp -s - all || fail "standard output was not written where it stood"
    expect 0 unwrap in.obj -o copy.obj --stats -
    cp out stats.json
    keys stats.json schema
    says err '^mesh '
    for kind in off ply; do
        grid 4 $kind >in.$kind
        expect 0 unwrap - -o copy.obj --quiet <in.$kind
        cmp -s copy.obj out.obj || fail "another map of $kind by standard input"
        cp in.$kind in.dat
        expect 3 check in.dat
        expect 0 check in.dat --format $kind
        expect 0 unwrap in.dat --format $kind -o copy.obj --quiet
    done
    expect 3 check - --format ply <in.off
    expect 0 eval - <out.obj
    says out '^flipped +0 of 32'
    printf '0,0,0\n' >pins.csv
    expect 2 check - --pins - <in.obj
    expect 0 check - --pins pins.csv <in.obj
    expect 0 check in.obj --pins - <pins.csv
    says out '1 pinned vertex'
    strip 8 collapsed >in.prob
    expect 0 check - --format prob <in.prob
    says out 'problem of triangles'
    expect 0 untangle in.prob -o map.txt --quiet
    expect 0 untangle - -o - <in.prob
    cmp -s out map.txt || fail "another map by standard streams"
    says err '^outcome +injective'

    # An input without an end. The limit is a quarter of what the process may have.
    (ulimit -v 1000000 && "$taut" eval /dev/zero >out 2>err)
    [ $? = 3 ] || fail "endless input"
    error_says '/dev/zero: has more than [0-9]+ MiB'

    # What cannot be printed is no success.
    if [ -w /dev/full ]; then
        for words in 'eval out.obj' 'eval out.obj --json' 'check in.obj' 'check in.obj --json' devices --help --version; do
            # shellcheck disable=SC2086
            "$taut" $words >/dev/full 2>err
            [ $? = 2 ] || fail "taut $words succeeds on a full standard output"
            error_says '/dev/stdout: cannot write: No space left'
        done
    fi
    "$taut" check in.obj >&- 2>err && fail "succeeds without a standard output"
    "$taut" unwrap nothing.obj -o new.obj >&- 2>err
    [ $? = 2 ] || fail "a closed standard output is not found before the run"
    error_says '/dev/stdout: .*--quiet'
    # But who has stopped reading the report does not lose the map.
    { sleep 0.5; "$taut" unwrap in.obj -o new.obj 2>err; echo $? >code; } | true
    [ "$(cat code)" = 0 ] || fail "no map where nobody reads the report"
    valid_map new.obj
    rm new.obj

    # What a run without a valid map has left is gone when there is one.
    echo stale >out.obj.invalid
    echo stale >map.txt.invalid
    expect 0 unwrap in.obj -o out.obj --quiet
    expect 0 untangle in.prob -o map.txt --quiet
    absent out.obj.invalid
    absent map.txt.invalid
}

# Outputs that cannot be written, found before anything is read, which here means: before the input is missed.
test_permissions()
{
    [ "$(id -u)" != 0 ] || { echo "root may write anywhere"; exit 77; }
    mkdir sealed
    echo precious >sealed/out.obj
    echo precious >read_only.obj
    chmod a-w sealed read_only.obj
    trap 'chmod u+w sealed' EXIT
    for name in sealed/new.obj sealed/out.obj read_only.obj; do
        expect 2 unwrap nothing.obj -o $name
        error_says "$name: cannot write: Permission denied"
    done
    expect 2 unwrap nothing.obj -o out.obj --stats sealed/new.json
    error_says '--stats: sealed/new.json: cannot write: Permission denied'
    expect 2 untangle nothing.prob -o map.txt --picture sealed/new.svg
    error_says '--picture: sealed/new.svg: cannot write: Permission denied'
    [ "$(cat sealed/out.obj read_only.obj | sort -u)" = precious ] || fail "a read-only file was changed"
}

# A disk with little room.
test_full_disk()
{
    mkdir small
    mount -t tmpfs -o size=64k tmpfs small 2>/dev/null || { echo "no small disk can be mounted"; exit 77; }
    trap 'umount small' EXIT
    grid 4 >in.obj
    echo precious >small/out.obj
    expect 2 unwrap in.obj -o small/out.obj --picture small/out.png --stats small/out.json
    error_says 'out.png: cannot write: No space left'
    [ "$(ls -A small) $(cat small/out.obj)" = 'out.obj precious' ] || fail "a failed run changed files: $(ls -A small)"
    # No room at all is found before anything is read.
    head -c 100000 /dev/zero >small/filler 2>/dev/null
    expect 2 unwrap nothing.obj -o small/new.obj
    error_says 'new.obj: cannot write: No space left'
}

test_input()
{
    expect 3 unwrap nothing.obj -o out.obj
    error_says 'nothing.obj'
    expect 3 eval nothing.obj
    error_says 'nothing.obj'
    grid 4 >in.stp
    expect 3 unwrap in.stp -o out.obj
    error_says '.obj, .off, .ply and .stl'
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 zero\nf 1 2 3\n' >word.obj
    expect 3 unwrap word.obj -o out.obj
    error_says 'line 3'
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 nan\nf 1 2 3\n' >nan.obj
    expect 3 unwrap nan.obj -o out.obj
    error_says 'line 3'
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n' >range.obj
    expect 3 unwrap range.obj -o out.obj
    error_says 'line 4|4'
    printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n' >short.off
    expect 3 unwrap short.off -o out.obj
    error_says 'short.off'
    absent out.obj
}

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
        error_says 'closed.glb' 'taut atlas'
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

test_unwrap()
{
    grid 12 >in.obj
    expect 0 unwrap in.obj -o out.obj
    says out '^mesh .*169 vertices, 288 triangles' '^device ' '^start .*0 flips' '^energy .* -> ' '^stop .*converged' \
        '^flipped +0 of 288' 'stretch L2' 'angular' '^wrote +out.obj'
    silent err # no terminal: no bar
    same_vertices in.obj out.obj
    [ "$(lines_of vt out.obj)" = 169 ] || fail "not one vt a vertex"
    [ "$(lines_of f out.obj)" = 288 ] || fail "not one face a triangle"
    valid_map out.obj

    for kind in off ply; do
        grid 12 $kind >in.$kind
        expect 0 unwrap in.$kind -o from_$kind.obj --quiet
        same_vertices in.obj from_$kind.obj
        valid_map from_$kind.obj
    done
    awk 'BEGIN { print "solid sheet" }
         $1 == "v" { p[++n] = "vertex " $2 " " $3 " " $4 }
         $1 == "f" { print "facet normal 0 0 0\nouter loop"; for (k = 2; k <= 4; ++k) print p[$k + 0]; print "endloop\nendfacet" }
         END { print "endsolid" }' in.obj >in.stl
    expect 0 unwrap in.stl -o from_stl.obj
    says err '^taut: note: 864 corners of triangles were welded by position to 169 vertices'
    [ "$(lines_of v from_stl.obj)" = 169 ] || fail "not one v a vertex of the STL file"
    valid_map from_stl.obj
    grid 6 quads >quads.obj
    expect 0 unwrap quads.obj -o out.obj
    says err '^taut: note: 36 polygons were split into triangles'
    same_vertices quads.obj out.obj
    [ "$(lines_of f out.obj)" = 36 ] || fail "36 quads do not stay 36 quads"
    valid_map out.obj
    expect 0 unwrap quads.obj -o out.obj --quiet
    silent err

    # Twice the same: the same map, bit for bit.
    expect 0 unwrap in.obj -o once.obj --quiet
    expect 0 unwrap in.obj -o twice.obj --quiet
    cmp -s once.obj twice.obj || fail "two runs differ"

    grid 8 >small.obj
    for options in '--energy shape' '--energy area' '--weights uniform' '--boundary circle' '--boundary square' \
                   '--start mean-value --spacing uniform' '--spacing centripetal' '--solver newton' \
                   '--solver mg-lbfgs' '--solver lbfgs' '--solver cg' '--solver gd --iterations 20' '--start auto' \
                   '--start coarse' '--start stretch' '--start tutte' '--start conformal' \
                   '--precision auto' '--precision fp64' '--precision fp32' '--precision mixed' '--iterations 0'; do
        # shellcheck disable=SC2086
        expect 0 unwrap small.obj -o out.obj --quiet $options
        same_vertices small.obj out.obj
        valid_map out.obj
    done

    # A free map lies with its lower left corner at the origin; in the unit square it fills one side.
    expect 0 unwrap small.obj -o out.obj --quiet
    awk '$1 == "vt" { if ($2 < 0 || $3 < 0) bad = 1; if ($2 == 0) ++left; if ($3 == 0) ++low } END { exit bad || !left || !low }' out.obj ||
        fail "the corner of a free map is not at the origin"
    expect 0 unwrap small.obj -o out.obj --quiet --placement unit-square --stats stats.json
    awk '$1 == "vt" { m = $2 > m ? $2 : m; m = $3 > m ? $3 : m; if ($2 < 0 || $3 < 0) bad = 1 } END { exit bad || m != 1 }' out.obj ||
        fail "a map does not fill the unit square"
    keys stats.json scale flipped
    says values '^flipped=0$'

    # All solvers that converge find the same minimum.
    least=
    for solver in newton mg-lbfgs lbfgs cg; do
        expect 0 unwrap small.obj -o out.obj --quiet --solver $solver --stats stats.json
        keys stats.json method.solver stop energy
        says values "^method.solver=$solver\$" '^stop=gradient$'
        energy=$(sed -n 's/^energy=//p' values)
        [ -n "$least" ] || least=$energy
        awk -v a="$energy" -v b="$least" 'BEGIN { d = (a - b) / b; exit !(d < 1e-6 && d > -1e-6) }' ||
            fail "$solver ends at $energy, newton at $least"
    done

    # A fixed boundary stays where the start has it, bit for bit; a free one moves.
    for boundary in square circle free; do
        expect 0 unwrap small.obj -o start.obj --quiet --boundary $boundary --iterations 0
        expect 0 unwrap small.obj -o out.obj --quiet --boundary $boundary
        for map in start out; do awk '$1 == "vt" && ++n <= 9' $map.obj >first_row_$map; done
        if cmp -s first_row_start first_row_out; then moved=no; else moved=yes; fi
        [ "$boundary$moved" = squareno ] || [ "$boundary$moved" = circleno ] || [ "$boundary$moved" = freeyes ] ||
            fail "boundary $boundary: moved: $moved"
    done
}
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
    keys same.json overlap.crossings_before overlap.rounds
    says values '^overlap.crossings_before=0' '^overlap.rounds=0'

    # The two ends of the strip, pinned across each other.
    printf '0,1,0\n1,0.9,0\n280,0.95,0.05\n281,0.95,-0.05\n' >cross.csv
    expect 0 unwrap ramp.obj -o crossed.obj --pins cross.csv --quiet
    rm crossed.obj
    expect 7 unwrap ramp.obj -o crossed.obj --no-overlap --pins cross.csv
    error_says '0-1' '28[01]-28[01]' 'across'
    absent crossed.obj
}

test_reports()
{
    grid 10 >in.obj
    expect 0 unwrap in.obj -o out.obj --stats stats.json --picture layout.png --render render.png --quiet
    silent out
    silent err
    keys stats.json schema vertices faces device precision method.solver method.start stop iterations evaluations \
        gradients hessian_products energy_start energy flipped min_det max_det seconds.read seconds.device \
        seconds.setup seconds.hierarchy seconds.start seconds.untangle seconds.solve seconds.draw seconds.write seconds.total \
        launches waits peak_memory_bytes quality.isometric.by_area quality.isometric.mean \
        quality.shape.by_area quality.area.by_area quality.stretch_l2.rms quality.stretch_linf.max \
        quality.area_ratio.rms quality.angular quality.boundary_crossings
    says values '^vertices=121$' '^faces=200$' '^precision=mixed$' '^stop=gradient$' '^flipped=0$' \
        '^method.solver=newton$' '^method.start=coarse$' '^hessian_products=[1-9]' '^launches=[1-9]' '^waits=[1-9]' \
        '^seconds.hierarchy=[0-9.e-]+$' '^seconds.total=[0-9.e-]+$' '^peak_memory_bytes=[1-9][0-9]+$' '^energy=4\.[0-9]+$'
    for picture in layout.png render.png; do
        [ "$(od -An -tx1 -N8 "$picture" | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "$picture is no PNG"
    done
    expect 0 unwrap in.obj -o out.obj --picture layout.svg --stats stats.json --precision fp32 --solver lbfgs \
        --iterations 3 --quiet
    says layout.svg '<svg ' '</svg>'
    keys stats.json precision stop iterations
    says values '^precision=fp32$' '^stop=iterations$' '^iterations=3$'

    # A mesh with levels above the one of the start.
    grid 40 >large.obj
    expect 0 unwrap large.obj -o out.obj --stats stats.json
    says out '^time .*hierarchy'
    keys stats.json levels.0.level levels.0.vertices levels.0.iterations levels.0.energy_start levels.0.energy \
        levels.0.seconds
    says values '^levels.0.level=[1-9]$' '^levels.0.vertices=[1-9][0-9]*$'
    for key in stage level vertices iterations energy_before energy_after seconds stop steps_cut cut_by step_median; do
        keys stats.json stages.0.$key
    done
    says values '^stages.0.step_median=$'
    cp stats.json levels.json
    expect 0 unwrap large.obj -o out.obj --stats stats.json --quiet --solver lbfgs --iterations 5
    keys stats.json precision method.solver method.start hessian_products levels
    if command -v python3 >plotter; then
        python3 "$here/../../scripts/plot-bench" levels.json stats.json --out stages >out || fail "no plot"
        says out '^hierarchy ' '^reinsert +0 ' '^minimise +0 ' '^wrote stages-stages.svg$'
        says stages-stages.svg '>levels</text>' '>stats</text>' '</svg>'
    fi
    says values '^precision=fp64$' '^method.solver=lbfgs$' '^method.start=evened stretch on a circle$' \
        '^hessian_products=0$' '^levels=\[\]$'

    expect 0 unwrap in.obj -o out.obj --progress json
    "$cmake" -DFILE=err -DLINES=ON "-DKEYS=phase;iteration;energy;gradient;step;seconds" -P "$here/json.cmake" \
        >values 2>failure || fail "--progress json: $(cat failure)"
    says err '"phase":"read"' '"phase":"optimize","iteration":[1-9][0-9]*,"energy":4\.' '"phase":"write"'
    expect 0 unwrap in.obj -o out.obj --quiet --progress json
    [ -s err ] || fail "--quiet swallows --progress json"
    expect 0 unwrap in.obj -o out.obj --progress none
    silent err
    says out '^stop '
}

test_eval()
{
    grid 6 flat >flat.obj
    expect 0 eval flat.obj
    says out '49 vertices, 72 triangles' '^flipped +0 of 72' '0 crossings' '^isometric +[0-9.]+ +[0-9.]+ +4$' \
        'stretch L2' 'stretch Linf' '^area ' '^angular '
    silent err
    grid 6 mirrored >mirrored.obj
    expect 0 eval mirrored.obj
    says out '^flipped +72 of 72'
    says err 'mirrored as a whole'
    grid 6 folded >folded.obj
    expect 0 eval folded.obj --json
    cp out folded.json
    keys folded.json schema vertices faces flipped min_det quality.isometric.by_area quality.boundary_crossings
    says values '^flipped=12$' '^quality.boundary_crossings=[1-9]'
    says folded.json '"by_area": null' # an energy beyond its barrier is infinite; JSON has no word for that

    # The plane as its own map is an isometry.
    printf 'v 0 0 0\nv 2 0 0\nv 0 3 0\nv 2 3 0\nvt 0 0\nvt 2 0\nvt 0 3\nvt 2 3\nf 1/1 2/2 3/3\nf 2/2 4/4 3/3\n' >same.obj
    expect 0 eval same.obj --json
    cp out same.json
    keys same.json quality.isometric.by_area quality.shape.mean quality.area.mean quality.stretch_l2.rms quality.angular
    says values '^quality.isometric.by_area=4(\.0+)?$' '^quality.shape.mean=1(\.0+)?$' '^quality.area.mean=2(\.0+)?$'

    # A branch point: no triangle is flipped, but the map winds twice around vertex 0.
    wound_fan >wound.obj
    expect 0 eval wound.obj
    says out '^flipped +0 of 12' '^winding +more than once around 1 vertex: 0'
    expect 0 eval wound.obj --json
    cp out wound.json
    keys wound.json flipped branch_points
    says values '^flipped=0$' '^branch_points=1$'
    # It is no start, and no map to keep.
    expect 0 unwrap wound.obj -o unwound.obj --start uv --stats unwound.json
    says out '^winding +once around every inner vertex'
    says err 'the start had 1 vertex \(0\) that the map winds around more than once; it was untangled'
    keys unwound.json branch_points
    says values '^branch_points=0$'
    expect 0 eval unwound.obj
    says out '^winding +once'
    # As a problem it is one; freed it is solved, pinned it is refused.
    wound_problem 0 >wound.prob
    expect 0 check wound.prob
    says out '0 of 12 inverted at the start, 1 branch point'
    expect 0 untangle wound.prob -o map.txt --stats freed.json
    keys freed.json branch_points_start branch_points inverted
    says values '^branch_points_start=1$' '^branch_points=0$' '^inverted=0$'
    wound_problem 13 >held.prob
    expect 7 check held.prob
    says out 'run around it more than once'
    expect 7 untangle held.prob -o held.txt --picture held.svg
    absent held.txt
    says held.svg '1 branch point' 'winds twice'

    # A seam: vertices 2 and 3 have two texture coordinates each. And one vt a corner is no seam.
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 5 0\nvt 6 1\nvt 5 1\n' >seam.obj
    printf 'f 1/1 2/2 3/3\nf 2/4 4/5 3/6\n' >>seam.obj
    expect 0 eval seam.obj
    says out '4 vertices, 2 triangles, 2 vertices on seams' '2 loops, 0 crossings'
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 0\nvt 1 1\nvt 0 1\n' >corners.obj
    printf 'f 1/1 2/2 3/3\nf 2/4 4/5 3/6\n' >>corners.obj
    expect 0 eval corners.obj
    says out '4 vertices, 2 triangles$' '1 loop, 0 crossings'

    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 2 0\nf 1/1 2/2 3/3\nf 1/1 4/4 2/2\n' >sliver.obj
    expect 0 eval sliver.obj
    says err 'note: 1 triangle without area'

    grid 4 >bare.obj
    expect 4 eval bare.obj
    error_says 'no texture coordinates'
    expect 2 eval
}

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

test_devices()
{
    expect 0 devices
    says out 'OpenCL' 'TAUT_DEVICE' ' \* '
    grid 4 >in.obj
    expect 5 unwrap in.obj -o out.obj --device 'no such device'
    error_says 'no such device' 'usable'
    expect 0 unwrap in.obj -o out.obj --device 0 --quiet
    export TAUT_DEVICE=nowhere
    expect 5 unwrap in.obj -o out.obj
    expect 0 unwrap in.obj -o out.obj --device 0 --quiet # the option is louder
    unset TAUT_DEVICE
    rm out.obj

    mkdir no_drivers
    export OCL_ICD_VENDORS="$PWD/no_drivers"
    expect 5 unwrap in.obj -o out.obj
    error_says 'no OpenCL device' 'install'
    expect 5 devices
    unset OCL_ICD_VENDORS

    # PoCL cannot build a kernel if its cache is a file; other drivers do not mind.
    if "$taut" devices | grep -q 'pthread'; then
        export POCL_CACHE_DIR="$PWD/in.obj"
        expect 9 unwrap in.obj -o out.obj --device pthread
        error_says 'building kernel' 'driver' '--device'
    fi
    absent out.obj
}

# builders: the processes that build kernels for this test.
builders()
{
    for process in /proc/[0-9]*; do
        tr '\0' '\n' <"$process/environ" | grep -qx "POCL_CACHE_DIR=$PWD/cold" || continue
        tr '\0' '\n' <"$process/cmdline" | grep -qx build-kernels && echo "${process#/proc/}"
    done 2>/dev/null # most are of others, or over
}

# A first run with an empty cache has a process beside it that builds kernels.
test_cold()
{
    grid 20 >in.obj
    expect 0 unwrap in.obj -o warm.obj --quiet
    expect 0 unwrap in.obj -o shape.obj --energy shape --quiet
    "$taut" devices | grep -q 'pthread' && [ -r /proc/self/environ ] && [ "$(nproc)" -gt 1 ] || exit 77
    same=$POCL_CACHE_DIR
    export POCL_CACHE_DIR="$PWD/cold"
    for fate in ended 'was killed' 'was thought to have ended'; do
        mkdir -p cold
        find cold -mindepth 1 -maxdepth 1 -type d -exec rm -r {} +
        case $fate in
        *killed)
            rm cold/taut-*
            "$taut" unwrap in.obj -o out.obj --quiet >out 2>err &
            program=$!
            while kill -0 "$program" 2>/dev/null && [ -z "$(builders)" ]; do sleep 0.05; done
            kill -9 $(builders) 2>/dev/null
            wait "$program" || fail "the program failed without the process beside it"
            silent err
            ;;
        *) expect 0 unwrap in.obj -o out.obj --quiet ;;
        esac
        cmp -s warm.obj out.obj || fail "another map where the process beside $fate"
        [ -z "$(builders)" ] || fail "a process is left where it $fate"
        ls cold/taut-* >/dev/null 2>&1 || fail "nothing tells that kernels are built where it $fate"
    done

    # So has the next energy, for some of its kernels, once.
    marks=$(ls cold/taut-* | wc -l)
    for time in first second; do
        expect 0 unwrap in.obj -o out.obj --energy shape --quiet
        cmp -s shape.obj out.obj || fail "another map of the next energy, the $time time"
        now=$(ls cold/taut-* | wc -l)
        [ "$time" = second ] || [ "$now" -gt "$marks" ] || fail 'nothing tells of the kernels of the next energy'
        [ "$time" = first ] || [ "$now" -eq "$marks" ] || fail 'kernels are built twice'
        marks=$now
    done

    # Who ends the program ends both.
    rm -rf cold
    mkdir cold
    "$taut" unwrap in.obj -o out.obj --quiet >out 2>err &
    program=$!
    while kill -0 "$program" 2>/dev/null && [ -z "$(builders)" ]; do sleep 0.05; done
    kill -9 "$program"
    wait "$program"
    sleep 0.2
    [ -z "$(builders)" ] || fail "a process is left where the program was killed"
    export POCL_CACHE_DIR="$same"
}

# stopped REASON: the map is valid, and the statistics say why the run ended.
stopped()
{
    keys stats.json stop flipped
    says values "^stop=$1\$" '^flipped=0$'
    same_vertices in.obj out.obj
    valid_map out.obj
}

# run_until PATTERN SIGNAL ARGUMENTS...: runs the program with --progress json, and sends it INT or TERM once its
# progress says PATTERN.
run_until()
{
    pattern=$1
    signal=$2
    shift 2
    "$taut" "$@" --progress json >out 2>err &
    program=$!
    waited=0
    until grep -Eq "$pattern" err; do
        sleep 0.1
        waited=$((waited + 1))
        [ "$waited" -lt 3000 ] || { kill -9 "$program"; fail "no iteration in 5 minutes"; }
        kill -0 "$program" 2>/dev/null || fail "ended before the signal"
    done
    kill -"$signal" "$program"
    wait "$program"
    code=$?
    [ "$signal" = INT ] && wanted=130 || wanted=143
    [ "$code" = "$wanted" ] || fail "exit code $code instead of $wanted after SIG$signal"
}

# A file is a picture.
png() { [ "$(od -An -tx1 -N8 "$1" | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "$1 is no PNG"; }

test_stops()
{
    grid 150 >in.obj
    # A run that would last for hours.
    endless='--tolerance 0 --iterations 1000000000 --solver gd'
    # Before there is a map, the end of the time leaves things as they were.
    echo precious >out.obj
    expect 6 unwrap in.obj -o out.obj --stats stats.json --time-limit 0.001
    error_says 'time limit came before there was a map' 'nothing was written'
    [ "$(cat out.obj)" = precious ] || fail "the old output is gone"
    absent stats.json
    # With a map it is written, however long this machine takes to come to one.
    code=6
    for limit in 1 4 16 64 256; do
        [ "$code" = 6 ] || break
        # shellcheck disable=SC2086
        "$taut" unwrap in.obj -o out.obj --stats stats.json --time-limit $limit $endless >out 2>err
        code=$?
    done
    [ "$code" = 8 ] || fail "exit code $code instead of 8 at the time limit"
    says out '^stop .*time limit'
    stopped time

    for signal in INT TERM; do
        rm -f out.obj stats.json
        # shellcheck disable=SC2086
        run_until '"phase":"optimize","iteration":[1-9]' $signal unwrap in.obj -o out.obj --stats stats.json \
            --picture out.png $endless
        says out '^stop .*interrupted'
        says err 'out.png was not drawn'
        absent out.png
        stopped user
    done

    # A volume comes as far as its handles have.
    volume 20 >bar.mesh
    run_until '"phase":"deform","iteration":[1-9]' INT deform bar.mesh -o bent.mesh --stats stats.json --fix triangles:1 \
        --move triangles:2:rotate:0,0,1,170
    expect 0 check bent.mesh
    says out '^inverted +0 of'
    keys stats.json inverted pins_held
    says values '^inverted=0'

    # Of a problem that is interrupted, what is left has the name only if it is valid.
    star 200 >large.prob
    run_until '"phase":"untangle","iteration":[1-9]' INT untangle large.prob -o map.txt --stats stats.json
    if [ -e map.txt ]; then written=map.txt inverted=0; else written=map.txt.invalid inverted='[1-9].*'; fi
    [ -e map.txt ] || error_says 'interrupted' 'the best map is in map.txt.invalid'
    keys stats.json inverted
    says values "^inverted=$inverted\$"
    keeps_pins large.prob $written
}

test_check()
{
    grid 4 >in.obj
    expect 0 check in.obj
    says out '^input .*surface, 25 vertices, 32 triangles' '^result +nothing wrong'
    silent err
    expect 0 check in.obj --json
    cp out check.json
    keys check.json schema kind vertices cells exit_code findings
    says values '^exit_code=0$' '^findings=\[\]$'

    # All that is wrong, not only the first.
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 7 0 0\nv 9 9 9\nf 1 2 3\nf 4 5 6\n' >many.obj
    expect 4 check many.obj
    says out '^error +1 triangle \(1\) flat' '^error +2 components' '^warning +1 vertex \(6\) without' '^result +2 errors'
    expect 4 check many.obj --json
    cp out check.json
    keys check.json findings.1.fault findings.1.ids findings.1.message findings.2.severity findings.2.about
    says values '^findings.1.fault=degenerate_cell$' '^findings.2.severity=error$' '^findings.2.about=mesh$'
    ring >ring.obj
    expect 4 check ring.obj
    says out 'boundary loops' '--holes'

    # Also of a file that is no mesh, and what --repair would do.
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 nan\nv 1 1 0\nv 0 1 inf\nv 0 2 0\nf 1 2 3\nf 1 2 4\nf 2 2 4\nf 1 9 2\nf 4 2 1\nf 1 2 6\n' >raw.obj
    expect 3 check raw.obj
    says out '^input .*surface, 6 vertices, 6 triangles' \
        '^error +raw.obj, line 3: vertex 2 .*; in all 2 vertices \(2, 4\).*; taut atlas --repair: left out' \
        '^error +1 triangle \(2\) naming a vertex twice; taut atlas --repair: left out' '^error +1 triangle \(3\) naming' \
        '^error +1 pair \(1-4\) of triangles' '^error +1 triangle \(1\) oriented' \
        '^warning +1 vertex \(4\) without' '^result +5 errors'
    expect 3 check raw.obj --json
    cp out check.json
    keys check.json findings.0.fault findings.0.ids findings.0.repair findings.1.about findings.1.repair
    says values '^findings.0.fault=non_finite$' '^findings.1.about=mesh$' '^findings.1.repair=left out$'
    # Of one that is a mesh, what is worth knowing besides.
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 4 6 5\n' >crack.obj
    expect 4 check crack.obj
    says out '^error +2 components' '^warning +2 pairs \(1-3, 2-4\) of vertices .*; taut atlas --repair: welded'

    expect 3 check nothing.obj
    says out '^error +nothing.obj: No such file'
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 zero\nf 1 2 3\n' >word.obj
    expect 3 check word.obj --json
    cp out check.json
    keys check.json findings.0.message
    says values 'line 3'
    expect 2 check

    # Pins of a surface.
    printf 'vertex,u,v,weight\n0,0,0\n4,1,0,\n12,0.4,0.6,10\n' >pins.csv
    expect 0 check in.obj --pins pins.csv
    says out '^pins +2 pinned vertices, 1 spring$'
    printf '0,0,0\n24,1,zero\n' >word.csv
    expect 3 check in.obj --pins word.csv
    says out 'word.csv, line 2: expected a coordinate'
    printf '0,0,0\n25,1,1\n' >range.csv
    expect 3 check in.obj --pins range.csv
    says out 'range.csv, line 2: vertex 25 of 25'
    printf '0,0,0\n1,1,0\n6,1,-1\n' >flip.csv # a triangle of the grid
    expect 7 check in.obj --pins flip.csv
    says out 'all vertices pinned, flipped or flat' '^result +1 error: no valid map exists'

    # Problems, with all proofs.
    for kind in valid collapsed free; do
        strip 8 $kind >$kind.prob
        expect 0 check $kind.prob
        says out 'problem of triangles, 27 vertices, 32 triangles' '^result +nothing wrong'
    done
    for kind in mirrored twisted pinched; do
        strip 8 $kind >$kind.prob
        expect 7 check $kind.prob
        says out '^error ' '^result .*no valid map exists'
    done
    strip 8 pinched >pinched.prob
    expect 7 check pinched.prob --json
    cp out check.json
    keys check.json findings.0.about findings.0.fault findings.0.ids inverted
    says values '^findings.0.about=feasibility$'
    printf '10,4,1\n' >pins.csv
    expect 0 check valid.prob --pins pins.csv
    says out '21 pinned vertices'
    printf '0,4,1\n' >pins.csv
    expect 4 check valid.prob --pins pins.csv
    says out 'vertex 0' 'two different positions'
    sed '$d' valid.prob >short.prob
    expect 3 check short.prob
    says out 'short.prob, line .*ends before fixed vertex'
}

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
}

test_shells()
{
    grid 10 >sheet.obj
    head -c -1 sheet.obj | sed '1i# kept\nvn 0 0 1' >in.obj
    printf '0,0,0,0.5\n10,1,0,0.25\n110,0,1,0\n120,1,1,0.5\n60,,,0.125\n' >pins.csv
    expect 0 deform in.obj -o out.obj --pins pins.csv --stats stats.json
    says out '121 vertices, 200 triangles, 5 vertices held' 'converged' 'thickness' 'wrote *out.obj, stats.json'
    keys stats.json schema element outcome converged pins_held collapsed thickness edge_change.rms area_ratio.min seconds.total stages.0.stage
    says values '^schema=taut.deform/1' '^element=shell' '^outcome=valid' '^collapsed=0'
    # All but coordinates is as it was, and pins are where they were put.
    grep -v '^v ' in.obj >before
    grep -v '^v ' out.obj >after
    cmp before after || fail "more than coordinates has changed"
    grep '^v ' out.obj | sed -n 11p | grep -qx 'v 1 0 0.25' || fail "a pin has moved"
    expect 0 check out.obj

    grid 10 off >sheet.off
    printf '0,0,0,0.5\n' >pins.csv
    expect 0 deform sheet.off -o moved.obj --pins pins.csv --thickness 0.5 --quiet
    silent out
    [ "$(grep -c '^f' moved.obj)" = 200 ] || fail "triangles are missing"

    # Without pins it goes back to its shape at rest.
    expect 0 deform moved.obj -o flat.obj --rest sheet.off --picture both.png --stats stats.json --quiet
    [ "$(od -An -tx1 -N8 both.png | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "both.png is no PNG"
    keys stats.json edge_change.max
    awk -F= '/^edge_change.max=/ { flat = $2 < 1e-3 && $2 > -1e-3 } END { exit !flat }' values || fail "not as at rest"
    grid 9 off >other.off
    expect 4 deform moved.obj -o late.obj --rest other.off
    error_says 'other triangles'
    expect 2 deform moved.obj -o late.obj --picture both.svg
    error_says '.png'

    # To standard output, and what is held by nothing is told.
    expect 0 deform in.obj -o -
    says out '^# kept$' '^v '
    says err 'nothing is held or moved'

    # Wrong use.
    expect 2 deform in.obj -o late.obj --thickness 0
    expect 2 deform in.obj -o late.off --pins pins.csv
    error_says '.obj'
    expect 2 deform in.obj -o late.obj --fix 1
    error_says '--fix'
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >one.obj
    expect 4 deform one.obj -o late.obj
    error_says 'without a neighbour'
    volume 3 >bar.mesh
    expect 2 deform bar.mesh -o -
    error_says 'goes to a file'
    expect 2 deform bar.mesh -o late.vtk
    error_says 'late.vtk.*format of its input'
    absent late.vtk
    expect 4 deform bar.mesh -o late.mesh --fix triangles:1 --move triangles:1:translate:0,0,1
    error_says 'group triangles:1 is to be at two places'
    expect 2 deform bar.mesh -o late.mesh --thickness 1
    error_says '--thickness'
    absent late.obj
}

test_deform()
{
    volume 3 >bar.mesh
    expect 0 deform bar.mesh -o out.mesh --fix triangles:1 --move triangles:2:rotate:0,0,1,90 --stats stats.json
    says out '640|160' 'inverted *0 -> 0' 'converged' 'wrote *out.mesh, stats.json'
    keys stats.json schema outcome converged pins_held inverted branch_edges quality.mean_ratio.worst seconds.total stages.0.stage \
        stages.1.energy_after
    says values 'schema=taut.deform/1' 'outcome=valid' '^inverted=0' '^branch_edges=0'
    # All but coordinates is as it was, and vertices that are held keep their very text.
    grep -v '^[-0-9.e]* [-0-9.e]* [-0-9.e]* 0$' bar.mesh >before
    grep -v '^[-0-9.e]* [-0-9.e]* [-0-9.e]* 0$' out.mesh >after
    cmp before after || fail "more than coordinates has changed"
    [ "$(sed -n 7,22p bar.mesh)" = "$(sed -n 7,22p out.mesh)" ] || fail "fixed vertices have moved"

    # The moved group stands where it was told to, and the mesh goes back to its rest.
    expect 0 deform out.mesh -o back.mesh --rest bar.mesh --fix triangles:1 --quiet --stats stats.json
    keys stats.json energy inverted
    says values '^energy=(2\.00000|2$|1\.99999)' '^inverted=0'

    # Springs of a file, energies by name, a group by its number.
    for energy in isometric shape volume neo-hookean; do
        printf '150,0.5,0.5,3.4,10\n' >spring.csv
        expect 0 deform bar.mesh -o out.mesh --fix 1 --pins spring.csv --energy $energy --quiet
        silent out
    done
    # It ends where it is told to.
    expect 0 deform bar.mesh -o out.mesh --fix triangles:1 --move triangles:2:rotate:0,0,1,90 --tolerance 0.5 --stats stats.json
    keys stats.json gradient
    expect 2 deform bar.mesh -o out.mesh --tolerance 1
    error_says '--tolerance'
    printf '150,0.4,0.6,3.1\n' >end.csv
    expect 4 deform bar.mesh -o late.mesh --move triangles:1=end.csv
    error_says 'vertex 150 is not in group triangles:1'
    absent late.mesh

    # Wrong use.
    expect 4 deform bar.mesh -o late.mesh --fix nothing
    error_says 'nothing' 'triangles:1'
    expect 2 deform bar.mesh -o late.mesh --move triangles:1
    error_says 'GROUP:translate'
    expect 2 deform bar.mesh -o late.mesh --move triangles:1:rotate:0,0,0,90
    error_says 'axis'
    expect 2 deform bar.mesh -o late.mesh --move triangles:1:translate:1,2
    error_says 'give 3 numbers'
    expect 2 deform bar.mesh -o bar.mesh
    expect 3 deform nothing.mesh -o late.mesh
    expect 4 deform bar.mesh -o late.mesh --fix tetrahedra:7 --move triangles:2:translate:0,0,1
    error_says 'different ways'
    absent late.mesh
}

test_smooth()
{
    volume 3 | awk '/^Triangles/ { inside = 0 } inside && $1 > 0 && $1 < 1 && $2 > 0 && $2 < 1 && $3 > 0 && $3 < 3 {
        $1 += 0.12; $2 -= 0.1 } /^Vertices/ { inside = 1 } { print }' >bar.mesh
    expect 0 smooth bar.mesh -o out.mesh --stats stats.json
    keys stats.json schema outcome inverted quality_start.mean_ratio.worst quality.mean_ratio.worst
    says values 'schema=taut.smooth/1' '^inverted=0'
    awk -F= '/^quality_start/ { before = $2 } /^quality\./ { after = $2 } END { exit !(after > before) }' values ||
        fail "the worst element is no better"
    for boundary in fixed free; do
        expect 0 smooth bar.mesh -o out.mesh --boundary $boundary --worst 3 --fix triangles:1 --quiet
        expect 0 check out.mesh
        says out '^inverted +0 of'
    done
    expect 2 smooth bar.mesh -o out.mesh --worst 9
    expect 2 smooth bar.mesh -o out.mesh --boundary round
}

test_volumes()
{
    # Tangled inside: the boundary stays, all but coordinates too.
    volume 3 | tangled >in.mesh
    expect 4 check in.mesh
    says out '^input +in.mesh: MEDIT, volume, 160 vertices, 486 tetrahedra' '^groups .*triangles:1 \(16\)' \
        '^orientation +as MEDIT files have it' '^inverted +[1-9][0-9]* of 486' '^error .*inverted, in a mesh that is oriented as MEDIT files are'
    expect 0 untangle in.mesh -o out.mesh --stats stats.json --picture out.png --cut x:0.6
    says out 'inverted +[1-9][0-9]* -> 0 of 486' '^outcome +injective' 'wrote +out.mesh, out.png, stats.json'
    keys stats.json schema format outcome inverted_start inverted branch_edges quality.mean_ratio.worst seconds.total
    says values 'schema=taut.untangle/1' '^inverted=0$' '^branch_edges=0$'
    png out.png
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
    error_says '--fix is of volume files'

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
    expect 0 deform rest.mesh -o bent.mesh --fix 1 --move triangles:2:rotate:0,0,1,60 --quiet --picture bent.png --cut 0,1,0,0.4
    png bent.png
    expect 0 eval rest.mesh bent.mesh --picture eval.png
    says out '^inverted +0 of 486; det 0\.' '^winding +once around every inner edge' '^stretch +singular values' 'by volume'
    png eval.png
    expect 0 eval rest.mesh bent.mesh --json
    cp out eval.json
    keys eval.json schema inverted branch_edges quality.isometric.by_volume singular_values.least distortion.worst_ids.0
    says values 'schema=taut.eval/1' '^quality.isometric.by_volume=2\.'
    expect 0 eval bent.mesh
    says err 'no shape at rest'
    expect 2 eval rest.mesh --cut x
    error_says '--cut is of --picture'
    expect 2 eval rest.mesh bent.mesh --picture eval.png --cut w
    error_says 'nx,ny,nz,d'
    expect 2 eval rest.mesh bent.mesh --picture eval.svg
    error_says 'pictures of volumes are PNG'

    # Hexahedra and a wedge: corners positive, insides judged.
    hexahedra >hex.vtk
    expect 0 check hex.vtk
    says out '1 wedge, 16 hexahedra' '^insides +all valid, by Bezier bounds'
    expect 0 deform hex.vtk -o out.vtk --fix part:1 --move part:2:rotate:0,0,1,60 --stats stats.json --picture hex.png --cut y
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

    # Turned as another format has it: told, and read turned over.
    awk '$1 == 8 { print 8, $6, $7, $8, $9, $2, $3, $4, $5; next } 1' hex.vtk >turned.vtk
    expect 0 check turned.vtk
    says out 'warning +16 cells \(0, 1, 2, 3, 4, ...\) have their corners in the other order than VTK files or neighbours'
}

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
    expect 0 untangle volume.prob -o volume.txt --picture volume.png --cut x:0.9 --quiet
    png volume.png
    expect 2 untangle volume.prob -o volume.txt --picture volume.svg
    error_says 'volume.svg' '.png'
    expect 2 untangle in.prob -o out.txt --picture out.png --cut x
    error_says '--cut' 'planar'

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

test_paste()
{
    grid 24 >source.obj
    grid 30 off >target.off
    expect 0 paste --source source.obj --at 312 --radius 0.25 --target target.off --onto 480 -o out.obj --stats stats.json \
        --picture out.png
    says out '^feature +source.obj: [0-9]+ triangles, rim of [0-9]+ vertices' '^target .*rim projected$' \
        '^result .*manifold, 120 boundary edges' '^seam +angle' '^wrote +out.obj, out.png, stats.json$'
    silent err
    [ "$(od -An -tx1 -N8 out.png | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "out.png is no PNG"
    keys stats.json schema manifold boundary_edges degenerate_triangles folded_edges self_intersections correspondence triangles seconds.map seconds.transform
    says values '^schema=taut.paste/1$' '^boundary_edges=120$' '^degenerate_triangles=0$' '^folded_edges=0$' '^self_intersections=0$'
    expect 0 check out.obj

    # Far from the feature all is as it was, in its order: the first row of the target.
    sed -n '3,33p' target.off | awk '{ printf "%.15g %.15g %.15g\n", $1, $2, $3 }' >first
    sed -n '1,31p' out.obj | awk '{ printf "%.15g %.15g %.15g\n", $2, $3, $4 }' >pasted
    cmp -s first pasted || fail "vertices of the target have changed"

    # Turned, scaled, soft, made anew from its map, by triangles of a file; the result is a target as any other.
    printf '# a square\n' >faces
    for j in 10 11 12 13; do for i in 10 11 12 13; do echo "$((2 * (j * 24 + i))), $((2 * (j * 24 + i) + 1))" >>faces; done; done
    expect 0 paste --source source.obj --region faces --target out.obj --onto 160 -o again.obj --rotate 30 --scale 0.5 \
        --softness 1 --triangles 500 --map map.exr --texels 128 --stats stats.json -q
    silent out
    keys stats.json feature_triangles map.footprint map.round_trip map.distance rim_vertices
    says values '^rim_vertices=16$'
    expect 0 check again.obj
    [ "$(od -An -tx1 -N4 map.exr | tr -d ' \n')" = 762f3101 ] || fail "map.exr is no EXR"

    # Texture coordinates stay with their triangles.
    grid 24 flat >flat.obj
    expect 0 paste --source flat.obj --at 312 --radius 0.2 --target target.off --onto 480 -o - --map map.png
    cp out piped.obj
    [ "$(od -An -tx1 -N8 map.png | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "map.png is no PNG"
    says piped.obj '^f [0-9]+ [0-9]+ [0-9]+$' '^f [0-9]+/[0-9]+ '
    says err '^result '

    expect 4 paste --source source.obj --at 312 --radius 5 --target target.off --onto 480 -o out.obj
    error_says 'does not fit|too near|larger'
    expect 4 paste --source source.obj --at 9999 --radius 0.2 --target target.off --onto 480 -o out.obj
    error_says '--at 9999: source.obj has vertices 0 to 624'
    expect 4 paste --source source.obj --at 312 --radius 0.2 --target target.off --onto 9999 -o out.obj
    error_says '--onto 9999: target.off has vertices 0 to 960'
    octahedron >closed.obj
    expect 4 paste --source source.obj --at 312 --radius 0.25 --target closed.obj --onto 0 --scale 1000 -o out.obj
    error_says 'no room for the feature' 'smaller scale'
    echo 0 1 2 3 9000 >faces
    expect 4 paste --source source.obj --region faces --target target.off --onto 480 -o out.obj
    error_says '9000'
    echo 0 one >faces
    expect 3 paste --source source.obj --region faces --target target.off --onto 480 -o out.obj
    error_says 'faces.*line 1'
    expect 2 paste --source source.obj --target target.off --onto 480 -o out.obj
    error_says '--region'
    expect 2 paste --source source.obj --at 3 --radius 1 --region faces --target target.off --onto 480 -o out.obj
    error_says 'not both'
    expect 2 paste --source source.obj --at 312 --radius 0.2 --target target.off --onto 480 -o target.off
    error_says '.obj'
    expect 2 paste --source source.obj --at 312 --radius 0.2 --target target.off --onto 480 -o source.obj
    error_says 'overwrite'
    expect 2 paste --source source.obj --at 312 --radius -1 --target target.off --onto 480 -o out.obj
    error_says '--radius'
}

"test_$case_name"
echo "passed: $case_name"
