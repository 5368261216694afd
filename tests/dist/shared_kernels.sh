#!/bin/sh
# SPDX-License-Identifier: MIT
# shared_kernels.sh CACHE COMMAND...: runs a command whose processes have kernel caches of their own, CACHE/process-0 and so
# on, as PoCL's is not safe between processes. Each begins with what any has compiled before (CACHE/all).
set -eu
cache=$1 status=0
shift
for process in 0 1 2 3; do
    mkdir -p "$cache/all" "$cache/process-$process"
    cp -rln "$cache/all/." "$cache/process-$process"
done
"$@" || status=$?
for process in 0 1 2 3; do
    rm -f "$cache/process-$process"/tempfile_*
    cp -rln "$cache/process-$process/." "$cache/all"
done
exit "$status"
