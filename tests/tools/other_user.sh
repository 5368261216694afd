#!/bin/sh
# SPDX-License-Identifier: MIT
# other_user.sh PROGRAM TAUT_TEST_IO CMAKE [TAUT_MPI MPIEXEC]: the tests of files as a user without rights, if root runs the
# tests; and that root runs no kernels which that user may have made.
set -eu
taut=$1 tests=$2 cmake=$3 taut_mpi=${4:-} mpiexec=${5:-}
here=$(cd "$(dirname "$0")" && pwd)
[ "$(id -u)" = 0 ] || { echo "not root: all tests are those of an ordinary user"; exit 77; }
command -v setpriv >/dev/null || { echo "no setpriv, with which root becomes somebody else"; exit 77; }

# That user may not be able to look into the build folder, where temporary files of tests are.
folder=$(TMPDIR='' mktemp -d)
trap 'rm -rf "$folder"' EXIT
chmod 755 "$folder"
cp "$taut" "$tests" "$here/run.sh" "$here/support.sh" "$here/permissions.sh" "$here/json.cmake" "$folder"
mkdir "$folder/own"
chown 65534:65534 "$folder/own"
cd "$folder/own"
other() { TMPDIR=$folder/own HOME=$folder/own setpriv --reuid=65534 --regid=65534 --clear-groups "$@"; }

other "$folder/$(basename "$tests")" --test-case='written files*,require_writable*,write_files*'
other sh "$folder/run.sh" permissions "$folder/$(basename "$taut")" "$folder/own/permissions" "$cmake"

# Compiled kernels are code.
mkdir "$folder/root"
cd "$folder/root"
. "$here/support.sh"
"$taut" devices | grep -q pthread || exit 0 # not PoCL
grid 2 >in.obj
volume 1 >in.mesh
other mkdir -p "$folder/own/full/process-0" "$folder/own/open"
other chmod 777 "$folder/own/open"
mkdir -p -m 777 loose

export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

# refused SAYS ENVIRONMENT...: by both programs.
refused()
{
    says=$1
    shift
    code=0
    env "$@" TAUT_DEVICE=pthread "$taut" unwrap in.obj -o out.obj >out 2>err || code=$?
    [ $code = 2 ] || fail "exit code $code instead of 2: $*"
    says err "$says"
    [ -n "$taut_mpi" ] || return 0
    code=0
    env "$@" TAUT_DEVICE=pthread "$mpiexec" -n 1 "$taut_mpi" deform in.mesh --fix triangles:1 -o out.mesh >out 2>err || code=$?
    [ $code = 2 ] || fail "exit code $code instead of 2 of taut-mpi: $*"
    says err "$says"
    absent out.obj
    absent out.mesh
}
refused 'belongs to another user' POCL_CACHE_DIR="$folder/own/full"
refused '(belongs to|a folder of) another user' POCL_CACHE_DIR="$folder/own/open"
mkdir -p "$folder/own/open/mine/deeper"
refused 'a folder of another user' POCL_CACHE_DIR="$folder/own/open/mine/deeper"
code=0
echo '{"id": "a", "args": ["unwrap", "in.obj", "-o", "out.obj"]}' >jobs
POCL_CACHE_DIR="$folder/own/open" TAUT_DEVICE=pthread "$taut" batch --manifest jobs --jobs 1 >out 2>err || code=$?
[ $code = 2 ] || fail "exit code $code instead of 2 of a batch"
says err 'a folder of another user'
refused '(others may write in it|everybody may rename it)' POCL_CACHE_DIR="$PWD/loose"
refused 'there is no HOME' -u HOME -u XDG_CACHE_HOME -u POCL_CACHE_DIR
