#!/bin/sh
# SPDX-License-Identifier: MIT
# released_names.sh PYTHON ROOT FOLDER: released_names.py sees names that vanish, in a copy of what it reads.
set -eu
python=$1 root=$2 folder=$3
here=$(cd "$(dirname "$0")" && pwd)
rm -rf "$folder"
mkdir -p "$folder/tests/house" "$folder/docs/reference" "$folder/include/taut"
cp "$root/include/taut/version.hpp" "$folder/include/taut"
printf '# Names\n\n## `taut/mesh.hpp`\n\n| `mesh` | a mesh |\n| `io::gone` | a name |\n' >"$folder/docs/reference/names.md"
version=$(sed -n 's/.*VERSION_STRING "\(.*\)"/\1/p' "$folder/include/taut/version.hpp")
changes() { printf '# Changelog\n\n## [9.0.0]\n\n### %s\n- `%s` is no more.\n\n## [%s]\n' "$1" "$2" "$version" >"$folder/CHANGELOG.md"; }
check() { "$python" "$here/released_names.py" "$folder" "$@"; }
fail() { echo "FAILED: $1"; exit 1; }

changes Fixed mesh
check --write
check >/dev/null || fail "the same names are refused"
sed -i '/gone/d' "$folder/docs/reference/names.md"
check >"$folder/out" && fail "a name that has vanished is not seen"
grep -q '^io::gone: was in taut/mesh.hpp' "$folder/out" || fail "the name is not said"
changes Removed io::gone
check >/dev/null || fail "a name that is said to be removed is refused"
changes Changed io::gone
check >/dev/null && fail "only what stands under Removed counts"
printf '## `taut/other.hpp`\n\n| `io::gone` | a name |\n' >>"$folder/docs/reference/names.md"
check | grep -q 'now in taut/other.hpp' || fail "a name that has moved is not seen"
echo "passed"
