# SPDX-License-Identifier: MIT
# A case of run.sh.

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
    says err 'nothing is fixed or moved'

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
