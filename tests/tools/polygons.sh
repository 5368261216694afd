# SPDX-License-Identifier: MIT
# A case of run.sh.

# rough_quads N: hills of N x N quads, rough enough that a map of their triangles makes some concave.
rough_quads()
{
    awk -v n="$1" '
        function vertex(i, j) { return j * (n + 1) + i + 1 }
        BEGIN {
            for (j = 0; j <= n; ++j)
                for (i = 0; i <= n; ++i)
                    printf "v %d %d %.17g\n", i, j, 4 * sin(0.9 * i + 0.3 * j) * cos(1.1 * j) + 0.9 * ((i * 7 + j * 5) % 3)
            for (j = 0; j < n; ++j)
                for (i = 0; i < n; ++i)
                    print "f", vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)
        }'
}

# concave FILE: how many faces of an OBJ file are convex in space, and how many of these have a corner in the map that
# turns clockwise. Convex in space: every corner turns by more than rounding about the sum of all corners' normals.
concave()
{
    awk '
        $1 == "v" { ++v; for (k = 1; k <= 3; ++k) x[v, k] = $(k + 1) }
        $1 == "vt" { ++t; u[t, 1] = $2; u[t, 2] = $3 }
        $1 == "f" {
            n = NF - 1
            for (i = 0; i < n; ++i) { split($(i + 2), id, "/"); p[i] = id[1]; q[i] = id[2] }
            for (k = 1; k <= 3; ++k) sum[k] = 0
            turned = 0
            for (i = 0; i < n; ++i) {
                a = (i + n - 1) % n; b = (i + 1) % n
                for (k = 1; k <= 3; ++k) { d[k] = x[p[i], k] - x[p[a], k]; e[k] = x[p[b], k] - x[p[i], k] }
                for (k = 1; k <= 3; ++k) {
                    r = k % 3 + 1; s = r % 3 + 1
                    c[i, k] = d[r] * e[s] - d[s] * e[r]
                    sum[k] += c[i, k]
                }
                turn = (u[q[i], 1] - u[q[a], 1]) * (u[q[b], 2] - u[q[i], 2]) - (u[q[i], 2] - u[q[a], 2]) * (u[q[b], 1] - u[q[i], 1])
                turned = turned || !(turn > 0)
            }
            size = sum[1] ^ 2 + sum[2] ^ 2 + sum[3] ^ 2; least = size
            for (i = 0; i < n; ++i) {
                dot = c[i, 1] * sum[1] + c[i, 2] * sum[2] + c[i, 3] * sum[3]
                if (dot < least) least = dot
            }
            if (least > 1e-6 * size) { ++convex; bad += turned }
        }
        END { print convex + 0, bad + 0 }' "$1"
}

# quad_torus N: of N x N quads, twisted, so that short ways around it run across quads.
quad_torus()
{
    awk -v n="$1" '
        function vertex(i, j) { return j % n * n + i % n + 1 }
        BEGIN {
            for (j = 0; j < n; ++j)
                for (i = 0; i < n; ++i) {
                    b = 6.283185307179586 * j / n; a = 6.283185307179586 * (i + 0.7 * j) / n; r = 3 + cos(b)
                    printf "v %.17g %.17g %.17g\n", r * cos(a), r * sin(a), sin(b)
                }
            for (j = 0; j < n; ++j)
                for (i = 0; i < n; ++i)
                    print "f", vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)
        }'
}

test_polygons()
{
    # Seams of --cut follow edges of polygons alone.
    quad_torus 10 >torus.obj
    expect 0 unwrap torus.obj -o out.obj --cut --quiet
    same_vertices torus.obj out.obj
    [ "$(lines_of f out.obj)" = 100 ] || fail "100 quads do not stay 100 quads"
    valid_map out.obj

    # Of the triangles alone the map makes some quads concave: else there would be nothing to see.
    rough_quads 12 >quads.obj
    awk '$1 == "f" { print "f", $2, $3, $4; print "f", $2, $4, $5; next } { print }' quads.obj >triangles.obj
    expect 0 unwrap triangles.obj -o out.obj --quiet
    awk '$1 == "f" && ++k % 2 { first = $2 " " $3 " " $4; next } $1 == "f" { print "f", first, $4; next } { print }' \
        out.obj >joined.obj
    set -- $(concave joined.obj)
    [ "$1" -gt 100 ] || fail "only $1 quads are convex in space"
    [ "$2" -gt 0 ] || fail "no quad is concave in the map of the triangles"

    for options in '' '--no-overlap'; do
        # shellcheck disable=SC2086
        expect 0 unwrap quads.obj -o out.obj --quiet $options
        same_vertices quads.obj out.obj
        [ "$(lines_of f out.obj)" = 144 ] || fail "144 quads do not stay 144 quads"
        valid_map out.obj
        set -- $(concave out.obj)
        [ "$1" -gt 100 ] && [ "$2" = 0 ] || fail "$2 of $1 quads that are convex in space are not so in the map ($options)"
    done

    # So do polygons of six corners.
    awk 'BEGIN {
             for (j = 0; j < 8; ++j)
                 for (i = 0; i < 8; ++i) {
                     face = "f"
                     for (k = 0; k < 6; ++k) {
                         x = 1.7320508 * (i + j % 2 / 2) + cos(0.5235988 * (2 * k + 1)); y = 1.5 * j + sin(0.5235988 * (2 * k + 1))
                         id = sprintf("%d %d", 100 * x + 200.5, 100 * y + 200.5)
                         if (!(id in number)) {
                             number[id] = ++n
                             printf "v %.9g %.9g %.9g\n", x, y, 2 * sin(0.9 * x + 0.3 * y) * cos(1.1 * y) + 0.2 * (n % 3)
                         }
                         face = face " " number[id]
                     }
                     print face
                 }
         }' >six.obj
    expect 0 unwrap six.obj -o out.obj --quiet
    valid_map out.obj
    [ "$(lines_of f out.obj)" = 64 ] || fail "64 polygons do not stay 64 polygons"
    set -- $(concave out.obj)
    [ "$1" -gt 40 ] && [ "$2" = 0 ] || fail "$2 of $1 polygons of six corners are not convex in the map"
}
