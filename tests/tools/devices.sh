# SPDX-License-Identifier: MIT
# A case of run.sh.

test_devices()
{
    expect 0 devices
    says out 'OpenCL' 'TAUT_DEVICE' ' \* ' 'host, '
    grid 4 >in.obj
    expect 5 unwrap in.obj -o out.obj --device 'no such device'
    error_says 'no such device' 'usable'
    expect 0 unwrap in.obj -o out.obj --device 0 --quiet
    expect 0 unwrap in.obj -o out.obj --device host
    says out 'host, '
    grid 40 >large.obj
    for threads in 1 2 3; do
        export TAUT_THREADS=$threads
        expect 0 unwrap large.obj -o "flat$threads.obj" --device host --quiet
        cmp -s flat1.obj "flat$threads.obj" || fail "another map by $threads threads"
    done
    unset TAUT_THREADS
    export TAUT_DEVICE=nowhere
    expect 5 unwrap in.obj -o out.obj
    expect 0 unwrap in.obj -o out.obj --device 0 --quiet # the option is louder
    unset TAUT_DEVICE
    rm out.obj

    mkdir no_drivers
    export OCL_ICD_VENDORS="$PWD/no_drivers"
    expect 0 unwrap in.obj -o out.obj --quiet
    expect 0 devices
    says out 'host, .* \* '
    rm out.obj
    expect 5 unwrap in.obj -o out.obj --device pthread
    error_says 'no OpenCL platform' 'install'
    unset OCL_ICD_VENDORS

    # PoCL cannot build a kernel if its cache is a file; other drivers do not mind.
    if "$taut" devices | grep -q 'pthread'; then
        export POCL_CACHE_DIR="$PWD/in.obj"
        expect 9 unwrap in.obj -o out.obj --device pthread
        error_says 'building kernel' 'driver' '--device'
    fi
    absent out.obj
}
