#!/bin/bash
# Runs tests under tools that find errors which a test alone does not show. All must be clean. It
# takes hours; .ci/sanitize runs a part.
#
#   tests/sanitizers.sh [asan] [tsan] [valgrind] [clang] [tidy]     no name: all of them
#
# asan      the whole suite under the address, undefined-behaviour and leak sanitizers
# tsan      what uses threads under the thread sanitizer
# valgrind  a short set under memcheck, which sees what is used before it is set
# clang     lib and app without a warning of clang 14
# tidy      lib and app without a finding of clang-tidy; tidy=COMMIT: the sources changed since then
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
jobs=$(nproc)
jobs=$((jobs < 2 ? jobs : 2))

run_asan() {
  cmake --preset asan -DAYUMI_WARNINGS_AS_ERRORS=ON >/dev/null
  cmake --build build/asan --parallel "$jobs"
  # Mesa's drawing and fontconfig keep some memory until the end.
  ASAN_OPTIONS=detect_leaks=1 UBSAN_OPTIONS=print_stacktrace=1 \
    ctest --test-dir build/asan --output-on-failure --parallel "$jobs"
}

# Rooms whose functions start threads: sampling, check, studies, meshes, and the pictures of clips.
run_tsan() {
  local targets=() rooms=(base plan check study io)
  for room in "${rooms[@]}"; do targets+=("${room}_tests"); done
  cmake --preset tsan >/dev/null
  cmake --build build/tsan --parallel "$jobs" --target "${targets[@]}"
  # FailingMeshReader needs posix_spawn() to report that a program does not exist. Under this
  # sanitizer, the child ends with the exit code 127 in place of this report.
  TSAN_OPTIONS=halt_on_error=1 ctest --test-dir build/tsan --output-on-failure --timeout 3600 \
    --parallel "$jobs" -R "^($(IFS='|'; echo "${rooms[*]}"))\\." -E '^io\.FailingMeshReader$'
}

run_valgrind() {
  local rooms=(base math geometry dynamics)
  local targets=()
  for room in "${rooms[@]}"; do targets+=("${room}_tests"); done
  cmake --preset release >/dev/null
  cmake --build build/release --parallel "$jobs" --target "${targets[@]}"
  for target in "${targets[@]}"; do
    # Tests that would take minutes there, and tests that measure time, are left out.
    valgrind --quiet --error-exitcode=9 --leak-check=full --errors-for-leak-kinds=definite \
      "build/release/tests/$target" --gtest_brief=1 \
      --gtest_filter='-*Elementary*:*Quick*:*Time*:*Mujoco*:*Many*'
  done
}

# Warnings need no optimization.
run_clang() {
  cmake --preset clang -B build/clang-warnings -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 \
    -DAYUMI_BUILD_TESTS=OFF -DAYUMI_WARNINGS_AS_ERRORS=ON >/dev/null
  cmake --build build/clang-warnings --parallel "$jobs"
}

run_tidy() {
  local sources="$PWD/(lib|app)/"
  if [[ -n $1 ]]; then
    sources=$(git diff --name-only --diff-filter=d "$1" -- 'lib/*.cpp' 'app/*.cpp' | paste -sd '|')
    [[ -n $sources ]] || return 0
  fi
  # By clang, which knows all options, and each source alone, so that a finding has its own place.
  cmake --preset clang -B build/tidy -DAYUMI_UNITY=OFF -DAYUMI_PRECOMPILE=OFF \
    -DAYUMI_BUILD_TESTS=OFF >/dev/null
  run-clang-tidy-14 -quiet -j "$jobs" -p build/tidy "$sources"
}

[[ $# -gt 0 ]] || set -- asan tsan valgrind clang tidy
for tool in "$@"; do
  case $tool in
    asan | tsan | valgrind | clang) "run_$tool" ;;
    tidy | tidy=*) run_tidy "$(cut -s -d= -f2 <<<"$tool")" ;;
    *) sed -n '2,13s/^# \{0,1\}//p' "$0"; exit 2 ;;
  esac
  echo "$tool: clean"
done
