#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh READER FOLDER SECONDS [SEED]: runs the fuzzer of a reader that was built into FOLDER, from the committed corpus
# and what it learnt before; seed 1 unless told, so that a test says the same each time; 0: another each time. An input that breaks a promise, crashes, hangs or takes 2 GB ends the run and is kept in FOLDER.
set -eu
reader=$1 folder=$2 seconds=$3 seed=${4:-1}
here=$(cd "$(dirname "$0")" && pwd)

mkdir -p "$folder/learnt/$reader"
log=$folder/$reader.log
if ! "$folder/fuzz-$reader" -seed="$seed" -max_total_time="$seconds" -max_len=4096 -timeout=30 -rss_limit_mb=2048 \
    -print_final_stats=1 -artifact_prefix="$folder/$reader-" "$folder/learnt/$reader" "$here/corpus/$reader" \
    >"$log" 2>&1; then
    tail -n 80 "$log"
    exit 1
fi
echo "$reader: no failure in $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs, $seconds s"
