#!/bin/bash
# Measures how many lines and branches of lib the tests reach, by tests without ../shared.
#
#   tests/coverage.sh               every room, by the whole suite; hours on one processor (estimated)
#   tests/coverage.sh ROOM…         these rooms by their own tests, for example: base math motion.
#                                   The first time builds the libraries; for core alone, this took 10
#                                   minutes of processor time (docs/measurements/proof.md)
#
# The sources are copied to build/coverage/ayumi, where no folder ../shared is, and are built there
# without optimization that joins lines. Prints a table, and writes build/coverage/uncovered.txt:
# each source with the lines that no test reaches. Branches count on lines with a decision (if, for,
# while, case, ?, && and ||): the compiler sees one more at each call that may throw. It needs gcovr
# (Debian package gcovr).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
[[ ${1-} != -* ]] || { sed -n '2,15s/^# \{0,1\}//p' "$0"; exit 2; }
command -v gcovr >/dev/null || { echo "gcovr is not installed: sudo apt-get install gcovr" >&2; exit 2; }

jobs=$(nproc)
jobs=$((jobs < 2 ? jobs : 2))
place=$PWD/build/coverage
source=$place/ayumi build=$place/build
mkdir -p "$source"
# The copies keep the times of the files, so that the next run only compiles what has changed.
git ls-files -z --cached --others --exclude-standard | tar --null -T - -c | tar -x -C "$source"
# The build has no optimization, and threads count separately, so that counts are exact.
cmake -S "$source" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DAYUMI_WITH_PYTHON=OFF \
  "-DCMAKE_CXX_FLAGS_DEBUG=-Og -g0 --coverage -fprofile-update=atomic" >/dev/null
find "$build" -name '*.gcda' -delete

filters=()
if [[ $# -eq 0 ]]; then
  cmake --build "$build" --parallel "$jobs"
  # A failed test is reported, but the lines that the other tests reach are counted nevertheless.
  ctest --test-dir "$build" --parallel "$jobs" --output-on-failure || echo "some tests failed" >&2
  filters=(--filter "$source/lib/")
else
  targets=()
  for room in "$@"; do
    targets+=("${room}_tests")
    filters+=(--filter "$source/lib/ayumi/$room/")
  done
  cmake --build "$build" --parallel "$jobs" --target "${targets[@]}"
  for target in "${targets[@]}"; do
    "$build/tests/$target" --gtest_brief=1 || echo "$target: some tests failed" >&2
  done
fi
cd "$source"
# For the compiler, every call that may throw is a branch.
no_decision='^(?!.*(\bif\b|\bfor\b|\bwhile\b|\bcase\b|&&|\|\||\?)).*$'
report() { gcovr --root "$source" --object-directory "$build" "${filters[@]}" -j "$jobs" \
  --exclude-throw-branches --exclude-branches-by-pattern "$no_decision" "$@" "$build"; }
report --json "$place/counts.json"
combine() { gcovr --root "$source" --add-tracefile "$place/counts.json" "$@"; }
combine --txt "$place/uncovered.txt"
combine --branches --txt "$place/branches.txt"
combine --print-summary --txt /dev/null
echo "lines that no test reaches: build/coverage/uncovered.txt; branches: build/coverage/branches.txt"
