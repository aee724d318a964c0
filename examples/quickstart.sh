#!/bin/bash
# On a bare Debian 12: installs the missing packages, builds the program, and makes the results of a walk.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

.ci/install_packages build
jobs=$(nproc)
cmake -S . -B build/release -G Ninja -DCMAKE_BUILD_TYPE=Release -DAYUMI_BUILD_TESTS=OFF
cmake --build build/release --parallel $((jobs < 2 ? jobs : 2)) --target ayumi

out=out/hoap1_walk
status=0
build/release/app/ayumi run patterns/hoap1_walk.json -o "$out" --force || status=$?

echo
echo "Results in $PWD/$out:"
find "$out" -type f -printf '  %P\n' | LC_ALL=C sort
exit "$status"
