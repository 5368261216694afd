#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh READER FOLDER runs|seconds N [SEED]: runs the fuzzer of a reader that was built into FOLDER, from the committed
# corpus. runs: N inputs, the same each time for the same seed (1). seconds: others each time, from what it learnt before,
# too. Inputs have up to 256 kB. One that breaks a promise, crashes, hangs, takes 2 GB, or more memory or processor time
# than its bytes are worth (budget.hpp) ends the run and is kept in FOLDER.
set -eu
reader=$1 folder=$2 limit=$3 n=$4
corpus=$(cd "$(dirname "$0")" && pwd)/corpus/$reader

if [ "$limit" = runs ]; then
    # The order of a folder's files is another on each disk.
    set -- -seed="${5:-1}" -runs="$n" -seed_inputs="$(printf '%s\n' "$corpus"/* | LC_ALL=C sort | paste -sd, -)"
else
    mkdir -p "$folder/learnt/$reader"
    set -- -max_total_time="$n" "$folder/learnt/$reader" "$corpus"
fi
log=$folder/$reader.log
if ! "$folder/fuzz-$reader" -max_len=262144 -timeout=30 -rss_limit_mb=2048 -malloc_limit_mb=512 -print_final_stats=1 \
    -artifact_prefix="$folder/$reader-" "$@" >"$log" 2>&1; then
    tail -n 80 "$log"
    exit 1
fi
echo "$reader: no failure in $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs"
