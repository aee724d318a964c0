#!/bin/bash
# Faults of the machine, in the long form: calls that fail, disks that are full, and kill -9, Ctrl-C
# and SIGTERM at random moments of run, repair, simulate, check, export, push, certify, sweep and
# author. CTest runs the same with few moments (faults.calls, faults.disk, faults.signals).
#
#   tests/faults/run.sh [--kind calls|disk|signals|all] [--count N] [--seed S] [--only NAMES] [BUILD]
#
# BUILD is a folder with the built program and tests (default: build/release). Without options: 500
# random moments, seed 1. That takes some hours on one processor (estimated). --only run,push stops
# only these commands. A failure is printed so that it can be repeated. It needs python3.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

build=build/release options=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --kind | --count | --seed | --only) options+=("$1" "$2"); shift 2 ;;
    -*) sed -n '2,11s/^# \{0,1\}//p' "$0"; exit 2 ;;
    *) build=$1; shift ;;
  esac
done
cmake --build "$build" --parallel 1 --target ayumi ayumi_failing_calls
library=$(find "$build/tests/faults" -name 'libayumi_failing_calls*' -print -quit)
# The last of two options counts.
exec python3 tests/faults/faults.py "$build/app/ayumi" "$library" --kind signals --count 500 "${options[@]}"
