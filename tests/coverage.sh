#!/bin/bash
# Measures how many lines and branches of lib the tests reach, by tests without ../shared.
#
#   tests/coverage.sh               every room, by the whole suite
#   tests/coverage.sh ROOM…         these rooms by their own tests, for example: base math motion
#
# The sources are copied to build/coverage/ayumi, where no folder ../shared is, and are built there:
# libraries and program with counters (AYUMI_COVERAGE), the tests without. Prints a table of the
# rooms, and writes build/coverage/uncovered.txt and branches.txt: each source with the lines and
# branches that no test reaches. docs/measurements/proof.md says how long this takes, and which
# branches count. It needs gcovr (Debian package gcovr).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
[[ ${1-} != -* ]] || { sed -n '2,11s/^# \{0,1\}//p' "$0"; exit 2; }
command -v gcovr >/dev/null || { echo "gcovr is not installed: sudo apt-get install gcovr" >&2; exit 2; }

jobs=$(nproc)
jobs=$((jobs < 2 ? jobs : 2))
place=$PWD/build/coverage
source=$place/ayumi build=$place/build
mkdir -p "$source"
# The copies keep the times of the files, so that the next run only compiles what has changed.
git ls-files -z --cached --others --exclude-standard | tar --null -T - -c | tar -x -C "$source"
cmake -S "$source" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DAYUMI_COVERAGE=ON \
  -DAYUMI_WITH_PYTHON=OFF "-DCMAKE_CXX_FLAGS_DEBUG=-O1 -g0 -DNDEBUG" >/dev/null
find "$build" -name '*.gcda' -delete

filters=()
if [[ $# -eq 0 ]]; then
  cmake --build "$build" --parallel "$jobs"
  # A failed test is reported, but the lines that the other tests reach are counted nevertheless.
  ctest --test-dir "$build" --parallel "$jobs" --output-on-failure || echo "some tests failed" >&2
  filters=(--filter "$source/lib/ayumi/")
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
# For the compiler, every call that may throw is a branch, and so is every copy of an object.
no_decision='^(?!.*(\bif\b|\bfor\b|\bwhile\b|\bcase\b|&&|\|\||\?)).*$'
gcovr --root "$source" --object-directory "$build" "${filters[@]}" -j "$jobs" \
  --exclude-throw-branches --exclude-unreachable-branches \
  --exclude-branches-by-pattern "$no_decision" --json "$place/counts.json" "$build"
combine() { gcovr --root "$source" --add-tracefile "$place/counts.json" "$@"; }
combine --txt "$place/uncovered.txt"
combine --branches --txt "$place/branches.txt"
combine --json-summary "$place/summary.json"
python3 - "$place/summary.json" <<'PYTHON'
import collections, json, sys
rooms = collections.defaultdict(lambda: [0, 0, 0, 0])
for file in json.load(open(sys.argv[1]))["files"]:
    for room in (file["filename"].split("/")[2], "total"):
        for i, key in enumerate(("line_covered", "line_total", "branch_covered", "branch_total")):
            rooms[room][i] += file[key]
share = lambda part, all: f"{part} of {all}, {100 * part // all if all else 100} %"
print("| room | lines | branches |\n| --- | --- | --- |")
for room, n in sorted(rooms.items(), key=lambda item: (item[0] == "total", item[0])):
    print(f"| {room} | {share(*n[:2])} | {share(*n[2:])} |")
PYTHON
echo "lines that no test reaches: build/coverage/uncovered.txt; branches: build/coverage/branches.txt"
