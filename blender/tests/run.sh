#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh ENVIRONMENT FILE...: pytest on files of this folder, by the interpreter of an environment with Blender. Exit code
# 77 where that is not there, or has another version of Python than the package taut was built for.
set -eu
python=$1/bin/python
shift
[ -x "$python" ] || { echo "skipped: scripts/setup --with-blender installs Blender as a Python module"; exit 77; }
"$python" -c "import bpy, pytest" 2>/dev/null || { echo "skipped: $python cannot import bpy and pytest"; exit 77; }
"$python" -c "import taut; taut.__version__" || { echo "skipped: taut was built for another Python"; exit 77; }
cd "$(dirname "$0")"
# Blender and tests write settings and temporary files nowhere but here.
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap 'exit 1' HUP INT TERM
export BLENDER_USER_RESOURCES="$folder/settings" TMPDIR="$folder/temporary"
mkdir "$BLENDER_USER_RESOURCES" "$TMPDIR"
"$python" -m pytest -q -p no:cacheprovider --rootdir=. "$@"
