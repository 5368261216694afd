#!/bin/sh
# SPDX-License-Identifier: MIT
# kernels.sh CACHE [COMMAND...]: adds what other tests have compiled (the folder `shared` beside CACHE) to a kernel cache,
# runs a command, and adds what the cache has to the others'. Links appear whole, so that tests may run at once.
set -eu
cache=$1 shared=$(dirname "$1")/shared status=0
shift
mkdir -p "$cache" "$shared"
cp -rln "$shared/." "$cache"
[ $# -gt 0 ] || exit 0
"$@" || status=$?
rm -f "$cache"/tempfile_*
cp -rln "$cache/." "$shared"
exit "$status"
