#!/bin/sh
# SPDX-License-Identifier: MIT
# packages.sh ROOT FOLDER: recipes are as the sources, and scripts/packages sees where one is not, in a copy.
set -eu
root=$1 folder=$2
fail() { echo "FAILED: $1"; cat "$folder/out"; exit 1; }

rm -rf "$folder"
mkdir -p "$folder/tests"
cd "$root"
scripts/packages --work "$folder/work" >"$folder/out" 2>&1 || fail "a recipe has drifted"
cp -r CMakeLists.txt LICENSE README.md THIRD_PARTY.md cmake docs examples include packaging scripts src tools "$folder"
cp -r tests/consumer "$folder/tests"
cd "$folder"
sed -i 's/TAUT_BENCH/TAUT_BENCHES/' packaging/vcpkg/portfile.cmake
sed -i 's/TAUT_EXAMPLES=OFF/TAUT_EXAMPLES=ON/' packaging/docker/Dockerfile
sed -i 's/1\.0\.0-rc\.1/0.9.0/' packaging/homebrew/taut.rb
echo 'usr/include/taught' >>packaging/debian/libtaut-dev.install
echo 'examples/nothing.cpp' >>packaging/debian/libtaut-dev.examples
echo 'def (' >>packaging/spack/package.py
if scripts/packages >out 2>&1; then fail "drift is not seen"; fi
for line in 'vcpkg/portfile.cmake: CMake has no option TAUT_BENCHES' 'Dockerfile: TAUT_EXAMPLES=ON is not what' \
            'taut.rb: version 0.9.0 instead' 'include/taught is not installed' 'examples/nothing.cpp: no such file' \
            'spack/package.py: .*'; do
    grep -q "$line" out || fail "not seen: $line"
done
echo "passed"
