#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh CASE PROGRAM FOLDER CMAKE: the tests of the program that CASE.sh has, in an emptied FOLDER.
# shellcheck disable=SC2034
set -u
case_name=$1 taut=$2 folder=$3 cmake=$4
here=$(cd "$(dirname "$0")" && pwd)

rm -rf "$folder"
mkdir -p "$folder"
cd "$folder" || exit 1
unset TAUT_DEVICE

# shellcheck source=support.sh
. "$here/support.sh"
# shellcheck disable=SC1090
. "$here/$case_name.sh"
"test_$case_name"
echo "passed: $case_name"
