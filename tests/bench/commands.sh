#!/bin/bash
# Processor time of whole commands, all threads and child processes, as the median of several runs:
#   tests/bench/commands.sh AYUMI [BEFORE]
# With a second program, the two run in turn, and the ratio of their times stands beside them.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
programs=("$@")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap 'cat "$folder/errors" >&2' ERR  # what a command says that fails
touch "$folder/errors"
TIMEFORMAT='%U %S'

"${programs[0]}" new walk --steps 13 -o "$folder/walk.json" >/dev/null 2>&1  # 9.84 s
median() { sort -n "$1" | awk '{ a[NR] = $1 } END { print (a[int((NR + 1) / 2)] + a[int(NR / 2) + 1]) / 2 }'; }

compare() {  # TITLE RUNS ARGUMENTS...
  local title=$1 runs=$2
  shift 2
  rm -f "$folder"/times*
  for ((i = 0; i < runs; ++i)); do
    for p in "${!programs[@]}"; do
      rm -rf "$folder/out"
      { time "${programs[p]}" "$@" >/dev/null 2>"$folder/errors"; } 2>&1 |
        awk '{ print $1 + $2 }' >>"$folder/times$p"
    done
  done
  local now before=
  now=$(median "$folder/times0")
  [[ -e $folder/times1 ]] && before=$(median "$folder/times1")
  awk -v title="$title" -v now="$now" -v before="$before" 'BEGIN {
    printf "%-44s %8.3f s", title, now
    if (before != "") printf " %8.3f s %6.2f", before, now / before
    print "" }'
}

compare "--version" 15 --version
compare "inspect hoap1" 15 inspect hoap1
compare "check, walk of 7.09 s" 15 check "$here/patterns/hoap1_walk.json"
compare "check, walk of 9.84 s" 15 check "$folder/walk.json"
compare "run, with clip, pictures and report" 3 run "$here/patterns/hoap1_walk.json" -o "$folder/out"
compare "certify, 100 runs without pushes" 3 certify "$here/patterns/hoap1_walk.json" --scenario none --runs 100 \
  --all --failure 0.05
compare "push, 40 cases" 1 push "$here/patterns/hoap1_walk.json" -o "$folder/out"
