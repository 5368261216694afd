#!/bin/sh
# SPDX-License-Identifier: MIT
# other_user.sh PROGRAM TAUT_TEST_IO CMAKE: the tests of files as a user without rights, if root runs the tests.
set -eu
taut=$1 tests=$2 cmake=$3
here=$(cd "$(dirname "$0")" && pwd)
[ "$(id -u)" = 0 ] || { echo "not root: all tests are those of an ordinary user"; exit 77; }
command -v setpriv >/dev/null || { echo "no setpriv, with which root becomes somebody else"; exit 77; }

# That user may not be able to look into the build folder.
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
chmod 755 "$folder"
cp "$taut" "$tests" "$here/run.sh" "$here/support.sh" "$here/permissions.sh" "$here/json.cmake" "$folder"
mkdir "$folder/own"
chown 65534:65534 "$folder/own"
cd "$folder/own"
other() { TMPDIR=$folder/own HOME=$folder/own setpriv --reuid=65534 --regid=65534 --clear-groups "$@"; }

other "$folder/$(basename "$tests")" --test-case='written files*,require_writable*,write_files*'
other sh "$folder/run.sh" permissions "$folder/$(basename "$taut")" "$folder/own/permissions" "$cmake"
