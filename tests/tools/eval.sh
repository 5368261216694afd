# SPDX-License-Identifier: MIT
# A case of run.sh.

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

# two_squares X0 Y0 X1 Y1: the unit square as its own map, and another one with this map.
two_squares()
{
    printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 6 1 0\nv 5 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n'
    printf 'vt %s %s\nvt %s %s\nvt %s %s\nvt %s %s\n' "$1" "$2" "$3" "$2" "$3" "$4" "$1" "$4"
    printf 'f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 5/5 6/6 7/7\nf 5/5 7/7 8/8\n'
}

# whole_squares N: N squares side by side, each of which has the whole texture.
whole_squares()
{
    awk -v n="$1" 'BEGIN {
        for (k = 0; k < n; ++k) printf "v %d 0 0\nv %d 0 0\nv %d 1 0\nv %d 1 0\n", 2 * k, 2 * k + 1, 2 * k + 1, 2 * k
        print "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1"
        for (k = 0; k < n; ++k) printf "f %d/1 %d/2 %d/3 %d/4\n", 4 * k + 1, 4 * k + 2, 4 * k + 3, 4 * k + 4
    }'
}

# A flat ring of eight quads that is cut open, as its own map.
slit_ring()
{
    awk 'BEGIN {
        turn = 8 * atan2(1, 1); n = 8
        for (k = 0; k <= n; ++k) for (r = 1; r <= 2; ++r) {
            a = turn * (k % n) / n
            printf "v %.17g %.17g 0\nvt %.17g %.17g\n", r * cos(a), r * sin(a), r * cos(a), r * sin(a)
        }
        for (k = 0; k < n; ++k) {
            a = 2 * k + 1
            printf "f %d/%d %d/%d %d/%d\n", a, a, a + 1, a + 1, a + 3, a + 3
            printf "f %d/%d %d/%d %d/%d\n", a, a, a + 3, a + 3, a + 2, a + 2
        }
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

    # As an atlas: one chart, nothing is distorted; folded over, half of it lies on the other half.
    keys same.json atlas.charts atlas.large_charts atlas.relative_seam atlas.stretch_l2 atlas.area_distortion \
        atlas.area_difference atlas.density_spread atlas.overlap_area
    says values '^atlas.charts=1$' '^atlas.large_charts=0$' '^atlas.stretch_l2=1(\.0+)?$' '^atlas.overlap_area=0(\.0+)?$'
    printf 'v 0 0 0\nv 2 0 0\nv 0 2 0\nv 2 2 0\nvt 0 0\nvt 2 0\nvt 0 2\nvt 0 0\nf 1/1 2/2 3/3\nf 2/2 4/4 3/3\n' >half.obj
    expect 0 eval half.obj --json
    cp out half.json
    keys half.json atlas.overlap_area
    says values '^atlas.overlap_area=0\.5'

    # What overlaps has an area in common: charts that touch have none, those that coincide, or lie within others, have.
    two_squares 1 0 2 1 >touching.obj
    expect 0 eval touching.obj
    says out '^boundary +2 loops, [1-9].* overlap or touch' '^overlapping +no two triangles'
    two_squares 1 1 2 2 >corners.obj
    expect 0 eval corners.obj
    says out '^overlapping +no two triangles'
    two_squares 0 0 1 1 >stacked.obj
    expect 0 eval stacked.obj
    says out '^overlapping +2 pairs of triangles: 0-2, 1-3$'
    two_squares 0.25 0.5 0.5 0.75 >within.obj
    expect 0 eval within.obj
    says out '^boundary +2 loops, 0 crossings$' '^overlapping +[1-9].* pairs? of triangles'
    two_squares 0.9999999999999999 0 2 1 >by_an_ulp.obj # which no sample sees
    expect 0 eval by_an_ulp.obj --json
    cp out by_an_ulp.json
    keys by_an_ulp.json overlapping_pairs all_overlaps_counted overlapping_ids.0.0 atlas.overlap_area
    says values '^overlapping_pairs=[1-9]' '^overlapping_ids.0.0=0$' '^atlas.overlap_area=0(\.0+)?$'
    slit_ring >ring.obj # both sides of the slit lie on each other
    expect 0 eval ring.obj
    says out '^boundary +1 loop, [1-9]' '^overlapping +no two triangles'

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

    # Samples that lie in many triangles are looked at once: in a second or so.
    whole_squares 3000 >whole.obj
    expect 0 eval whole.obj
    says out 'overlap *99.9[67][0-9]* % of the area' 'at least 100,000 pairs of triangles'
    whole_squares 1 >whole.obj
    expect 0 eval whole.obj
    says out 'overlap *0 % of the area'

    grid 4 >bare.obj
    expect 4 eval bare.obj
    error_says 'no texture coordinates'
    expect 2 eval
}
