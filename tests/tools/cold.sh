# SPDX-License-Identifier: MIT
# A case of run.sh.

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
    "$taut" devices | grep -q 'pthread' && [ -r /proc/self/environ ] && [ "$(nproc)" -gt 1 ] || exit 77
    export TAUT_DEVICE=pthread
    expect 0 unwrap in.obj -o warm.obj --quiet
    expect 0 unwrap in.obj -o shape.obj --energy shape --quiet
    same=${POCL_CACHE_DIR:-$PWD/kernels}
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
    unset TAUT_DEVICE
}
