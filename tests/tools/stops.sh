# SPDX-License-Identifier: MIT
# A case of run.sh.

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
