#!/bin/sh
# SPDX-License-Identifier: MIT
# scripts.sh ROOT: every script says what it is for when it is asked with --help, and does nothing else.
set -eu
cd "$1"
for script in scripts/*; do
    [ -f "$script" ] || continue
    words=$(timeout 20 "$script" --help </dev/null) || { echo "$script --help fails" >&2; exit 1; }
    [ "${#words}" -ge 40 ] || { echo "$script --help says too little" >&2; exit 1; }
done
