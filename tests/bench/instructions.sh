#!/bin/sh
# Counts the instructions per state of every kernel: two runs under callgrind only differ in their
# number of calls, so that starting and reading cancel. Usage: instructions.sh BENCH VALGRIND
set -eu
bench=$1 valgrind=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
count() {
  "$valgrind" --tool=callgrind --callgrind-out-file="$folder/out" "$bench" --count "$1" "$2" "$3" \
    >/dev/null 2>&1
  sed -n 's/^\(summary\|totals\): *//p' "$folder/out" | tail -n 1
}
printf '%-28s %-18s %12s\n' job library 'Ir per state'
"$bench" --list | while IFS="$(printf '\t')" read -r job who states; do
  [ -n "$states" ] || continue  # a line that a library itself prints
  few=$(count "$job" "$who" 128)
  many=$(count "$job" "$who" 384)
  printf '%-28s %-18s %12d\n' "$job" "$who" $(((many - few) / 256 / states))
done
