# SPDX-License-Identifier: MIT
# A case of run.sh.

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
