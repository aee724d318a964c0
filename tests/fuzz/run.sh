#!/bin/bash
# Feeds the readers with broken and hostile files.
#
#   tests/fuzz/run.sh [--time S] [TARGET…]    long runs by clang and libFuzzer (preset fuzz)
#   tests/fuzz/run.sh --afl [--time S] TARGET one target by AFL++ (Debian package afl++)
#   tests/fuzz/run.sh --short BUILD           seeds and a few hundred mutants, built in BUILD by any
#                                             compiler with -DAYUMI_BUILD_FUZZ=ON
#
# An input may take 2 s and 512 MB. What was found stays in build/fuzz/found: `TARGET FILE` runs such
# an input again. A corpus grows in build/fuzz/corpus from run to run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

# The tests assume the limits of memory and time that they get here.
export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=0 UBSAN_OPTIONS=print_stacktrace=1

short() {
  local build count
  build=$(realpath "$1")
  folder=$(mktemp -d)
  trap 'rm -rf "$folder"' EXIT
  "$build/tests/fuzz/ayumi_fuzz_seeds" "$folder"
  cd "$folder"
  for program in "$build"/tests/fuzz/*_fuzz; do
    count=300
    [[ $program == */mesh_file_fuzz ]] && count=10  # each starts a process
    "$program" "$folder/$(basename "${program%_fuzz}")" "$count" || {
      echo "$program: failed; the input is kept as $build/last_input" >&2
      cp last_input "$build/last_input"
      exit 1
    }
  done
}

time=600 afl='' targets=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --short) short "$2"; exit ;;
    --time) time=$2; shift 2 ;;
    --afl) afl=1; shift ;;
    -*) sed -n '2,11s/^# \{0,1\}//p' "$0"; exit 2 ;;
    *) targets+=("$1"); shift ;;
  esac
done

jobs=$(nproc)
jobs=$((jobs < 2 ? jobs : 2))
if [[ -n $afl ]]; then
  build=build/afl
  AFL_QUIET=1 cmake --preset fuzz -B "$build" -DCMAKE_CXX_COMPILER=afl-clang-fast++ \
    "-DCMAKE_CXX_FLAGS_DEBUG=-O1 -g1 -fsanitize=address,undefined -fno-sanitize-recover=undefined" >/dev/null
else
  build=build/fuzz
  cmake --preset fuzz >/dev/null
fi
cmake --build "$build" --parallel "$jobs" --target ayumi_fuzz
"$build/tests/fuzz/ayumi_fuzz_seeds" "$build/seeds"
if [[ ${#targets[@]} -eq 0 ]]; then
  for program in "$build"/tests/fuzz/*_fuzz; do targets+=("$(basename "${program%_fuzz}")"); done
fi
for target in "${targets[@]}"; do
  mkdir -p "$build/corpus/$target" "$build/found"
  if [[ -n $afl ]]; then
    AFL_SKIP_CPUFREQ=1 AFL_I_DONT_CARE_ABOUT_MISSING_CRASHES=1 timeout "$time" afl-fuzz -m none \
      -t 2000 -x "$build/seeds/$target.dict" -i "$build/seeds/$target" -o "$build/found/$target" \
      -- "$build/tests/fuzz/${target}_fuzz" || [[ $? -eq 124 ]]
    continue
  fi
  "$build/tests/fuzz/${target}_fuzz" -max_total_time="$time" -timeout=2 -rss_limit_mb=512 \
    -malloc_limit_mb=512 -max_len=65536 -print_final_stats=1 -dict="$build/seeds/$target.dict" \
    -artifact_prefix="$build/found/$target-" "$build/corpus/$target" "$build/seeds/$target"
done
