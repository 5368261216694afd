# SPDX-License-Identifier: MIT
# A case of run.sh.

test_devices()
{
    expect 0 devices
    says out 'OpenCL' 'TAUT_DEVICE' ' \* '
    grid 4 >in.obj
    expect 5 unwrap in.obj -o out.obj --device 'no such device'
    error_says 'no such device' 'usable'
    expect 0 unwrap in.obj -o out.obj --device 0 --quiet
    export TAUT_DEVICE=nowhere
    expect 5 unwrap in.obj -o out.obj
    expect 0 unwrap in.obj -o out.obj --device 0 --quiet # the option is louder
    unset TAUT_DEVICE
    rm out.obj

    mkdir no_drivers
    export OCL_ICD_VENDORS="$PWD/no_drivers"
    expect 5 unwrap in.obj -o out.obj
    error_says 'no OpenCL device' 'install'
    expect 5 devices
    unset OCL_ICD_VENDORS

    # PoCL cannot build a kernel if its cache is a file; other drivers do not mind.
    if "$taut" devices | grep -q 'pthread'; then
        export POCL_CACHE_DIR="$PWD/in.obj"
        expect 9 unwrap in.obj -o out.obj --device pthread
        error_says 'building kernel' 'driver' '--device'
    fi
    absent out.obj
}
