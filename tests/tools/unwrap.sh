# SPDX-License-Identifier: MIT
# A case of run.sh.

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
