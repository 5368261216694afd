#!/bin/sh
# SPDX-License-Identifier: MIT
# kernels.sh SHARED CACHE [COMMAND...]: adds what other tests have compiled, the folder SHARED, to a kernel cache, runs a
# command, and adds what the cache has to the others'. Links appear whole, so that tests may run at once.
set -eu
shared=$1 cache=$2 status=0
shift 2
(umask 077 && mkdir -p "$cache" "$shared") # batches refuse caches that others may write to
cp -rln "$shared/." "$cache"
[ $# -gt 0 ] || exit 0
"$@" || status=$?
rm -f "$cache"/tempfile_*
cp -rln "$cache/." "$shared"
exit "$status"
