#!/bin/bash
# Builds everything and runs every test: tests/run.sh [ctest options]
# Works on a bare Debian 12, and installs what is missing. Uses what examples/quickstart.sh has
# built. `tests/run.sh -L quick` gives a verdict within a minute once everything is built.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

.ci/install_packages build test
jobs=$(nproc)
jobs=$((jobs < 2 ? jobs : 2))
build=${AYUMI_TEST_BUILD:-build/release}
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DAYUMI_BUILD_TESTS=ON \
  ${AYUMI_CMAKE_OPTIONS:-}
cmake --build "$build" --parallel "$jobs"
ctest --test-dir "$build" --output-on-failure --parallel "$jobs" "$@"
