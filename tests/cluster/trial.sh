#!/bin/bash
# A sweep on a real Slurm of four virtual nodes on this machine, with faults: tasks are cancelled, a
# node dies, the controller is restarted, and the sweep itself is killed and started again. At the
# end every case must be there, and the CSV must have the bytes of a sweep without Slurm.
#   trial.sh PROGRAM CASES DIR [CHUNK]
# Exit code 77: there is no Slurm here, or it cannot be started.
set -u
program=$1 cases=$2 dir=$3 chunk=${4:-}
here=$(dirname "$(readlink -f "$0")")
cluster=$here/cluster.sh
"$cluster" check || exit $?
rm -rf "$dir"
mkdir -p "$dir" || exit 1
cd "$dir" || exit 1
sweep_pid=
finish() {
  [ -n "$sweep_pid" ] && kill -KILL "$sweep_pid" 2> /dev/null
  "$cluster" stop "$dir/cluster"
}
trap finish EXIT
complain() { echo "trial.sh: $*" >&2; exit 1; }
if ! "$cluster" start "$dir/cluster" > start.log 2>&1; then
  echo "skipped: Slurm does not start here: $(tail -n 1 start.log)"
  exit 77
fi
export SLURM_CONF=$dir/cluster/slurm.conf

"$program" new stand --duration 0.3 -o stand.json --quiet > /dev/null || complain "no pattern"
cat > study.json << JSON
{ "format": "ayumi.study/1", "name": "trial", "sweep": {
  "settings": { "pattern": "stand.json", "disturbances": "push", "noise": true },
  "cases": { "latin_hypercube": { "samples": $cases, "seed": 1,
    "ranges": { "value.impulse": [0.1, 6] } } },
  "disturbances": { "push": [{ "type": "impulse", "at": 0.1, "duration": 0.02,
    "impulse": "\${impulse}", "direction": [0, 1, 0] }] } } }
JSON
SECONDS=0
"$program" sweep study.json -o local.db --csv local.csv --quiet &
sweep_pid=$!
wait "$sweep_pid" || complain "the local sweep failed"
sweep_pid=
echo "local: $SECONDS s"

# Starts the sweep on Slurm in the background.
start_sweep() {
  "$program" sweep study.json -o slurm.db --engine slurm ${chunk:+--chunk "$chunk"} --csv slurm.csv \
    > "sweep.$1.out" 2> "sweep.$1.log" &
  sweep_pid=$!
}
status() { "$program" sweep status slurm.db --json 2> /dev/null | grep -o "\"$1\": [0-9]*" | grep -o '[0-9]*'; }
# Waits until a number of the status is at least this.
wait_for() {
  for _ in $(seq 1200); do
    value=$(status "$1")
    [ "${value:-0}" -ge "$2" ] && return
    kill -0 "$sweep_pid" 2> /dev/null || return
    sleep 0.1
  done
  complain "$1 did not become $2"
}
SECONDS=0
start_sweep 1
wait_for running 2
for task in $(squeue -h --array -t running -o %i | head -n 2); do scancel "$task" && echo "cancelled $task"; done
wait_for 'done' $((cases / 10))
"$cluster" kill-node "$dir/cluster" n2
echo "node n2 was killed at $(status 'done') cases"
wait_for 'done' $((cases / 5))
"$cluster" stop-controller "$dir/cluster"
sleep 1
"$cluster" start-controller "$dir/cluster" || complain "the controller did not start again"
echo "the controller was restarted at $(status 'done') cases"
wait_for 'done' $((cases / 3))
{ kill -KILL "$sweep_pid"; wait "$sweep_pid"; } 2> /dev/null
echo "the sweep was killed at $(status 'done') cases"
rm -f slurm.csv
"$cluster" start-node "$dir/cluster" n2
start_sweep 2
wait "$sweep_pid"
code=$?
sweep_pid=
[ $code = 0 ] || complain "the sweep ended with $code: $(tail -n 1 sweep.2.log)"
echo "with Slurm: $SECONDS s"
grep -h 'submitted again\|pilot\|one thread' sweep.?.out
[ "$(status 'done')" = "$cases" ] || complain "cases are missing"
[ ! -e slurm.db.slurm ] || complain "the folder of the engine was left"
cmp local.csv slurm.csv || complain "the CSV is another one"
[ "$(wc -l < slurm.csv)" = $((cases + 1)) ] || complain "the CSV has another number of lines"
echo "every case is there once, and the CSV is the same"
