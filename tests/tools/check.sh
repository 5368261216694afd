# SPDX-License-Identifier: MIT
# A case of run.sh.

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

    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >one.obj
    expect 0 check one.obj
    says out '3 vertices, 1 triangle$'

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

    expect 2 check in.obj --zone 1
    volume 1 >in.mesh
    expect 2 check in.mesh --format obj --zone 1
    error_says '--zone is for SU2 files'
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
