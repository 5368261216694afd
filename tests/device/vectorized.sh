#!/bin/sh
# SPDX-License-Identifier: MIT
# vectorized.sh PROGRAM FOLDER: PROGRAM launches the kernels with FOLDER, emptied before, as PoCL's kernel cache; then
# the machine code in it must work on several elements at once. Exit status 77: nothing to be seen here.
set -eu
program=$1
cache=$2

command -v objdump >/dev/null || { echo "skipped: no objdump"; exit 77; }
grep -qw avx2 /proc/cpuinfo 2>/dev/null || { echo "skipped: no AVX2"; exit 77; }

rm -rf "$cache"
mkdir -p "$cache"
POCL_CACHE_DIR=$cache "$program"
[ -n "$(ls "$cache")" ] || { echo "skipped: not PoCL"; exit 77; }

# With AVX-512 compilers gather the vertices of neighbouring cells; on older processors they may load them one by one,
# and the arithmetic shows whether the kernel was vectorised.
if grep -qw avx512f /proc/cpuinfo; then
    wanted='vgather[dq]p[sd]'
else
    wanted='vgather[dq]p[sd]|v(mul|div|add)p[sd] .*%ymm'
fi

failed=0
for kernel in element_value element_gradient element_along element_first_flip 'gather_*_2'; do
    objects=$(find "$cache" -name "$kernel.so")
    [ -n "$objects" ] || { echo "$kernel: not in the cache"; failed=1; }
    for object in $objects; do
        found=$(objdump -d --no-show-raw-insn "$object" | grep -Ec "$wanted" || true)
        echo "$kernel: $found vector instructions of the kind wanted"
        [ "$found" -gt 0 ] || failed=1
    done
done
exit $failed
