# SPDX-License-Identifier: MIT
# A case of run.sh.

test_paste()
{
    grid 24 >source.obj
    grid 30 off >target.off
    expect 0 paste --source source.obj --at 312 --radius 0.25 --target target.off --onto 480 -o out.obj --stats stats.json \
        --picture out.png --render seen.png
    says out '^feature +source.obj: [0-9]+ triangles, rim of [0-9]+ vertices' '^target .*rim projected$' \
        '^result .*manifold, 120 boundary edges' '^seam +angle' '^wrote +out.obj, out.png, seen.png, stats.json$'
    silent err
    for picture in out.png seen.png; do
        [ "$(od -An -tx1 -N8 $picture | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "$picture is no PNG"
    done
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
        --softness 1 --triangles 500 --map map.exr --resolution 128 --stats stats.json --quiet
    silent out
    silent err
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

    expect 0 paste --source source.obj --at 312 --radius 0.25 --target target.off --onto 480 -o out.obj --map small.exr --resolution 8 --quiet
    silent err
    expect 4 paste --source source.obj --at 312 --radius 0.25 --target target.off --onto 480 -o out.obj --scale 1e-12
    error_says 'larger scale'
    expect 4 paste --source source.obj --at 312 --radius 5 --target target.off --onto 480 -o out.obj
    error_says 'does not fit|too near|larger'
    expect 4 paste --source source.obj --at 9999 --radius 0.2 --target target.off --onto 480 -o out.obj
    error_says '--at 9999: source.obj has vertices 0 to 624'
    expect 4 paste --source source.obj --at 312 --radius 0.2 --target target.off --onto 9999 -o out.obj
    error_says '--onto 9999: target.off has vertices 0 to 960'
    expect 4 paste --source source.obj --at 312 --radius 1e-9 --target target.off --onto 480 -o out.obj
    error_says 'within the radius 1e-09'
    expect 2 paste --source source.obj --at 312 --radius 0.25 --target target.off --onto 480 -o out.obj --resolution 64
    error_says '--resolution' '--map or --triangles'
    expect 0 paste --source source.obj --at 312 --radius 0.25 --target target.off --onto 480 -o turned.obj --rotate 90
    expect 0 paste --source source.obj --at 312 --radius 0.25 --target target.off --onto 480 -o out.obj --rotate 36000000090
    cmp out.obj turned.obj || fail 'whole turns change the result'
    expect 0 paste --source source.obj --at 312 --radius 0.25 --target target.off --onto 480 -o out.obj --triangles 100000000
    says out 'note +--triangles 100000000: [0-9,]+ triangles, as the map has no more detail'
    expect 0 paste --source source.obj --at 312 --radius 0.25 --target target.off --onto 480 -o out.obj --triangles 1
    says out 'note +--triangles 1: [0-9]+ triangles, as the rim'
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
