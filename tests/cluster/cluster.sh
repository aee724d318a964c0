#!/bin/bash
# A Slurm cluster of four virtual nodes on this machine, for tests. Everything is in one folder and
# on the loopback interface; no service of the system is touched.
#   cluster.sh check              says why a cluster cannot be started here (exit code 77), or nothing
#   cluster.sh start DIR          starts munged, slurmctld and slurmd n1 to n4; DIR/slurm.conf is then
#                                 the value of SLURM_CONF for every command of Slurm
#   cluster.sh kill-node DIR N    kills slurmd of a node and the tasks on it, as a power cut does
#   cluster.sh start-node DIR N   starts it again
#   cluster.sh stop-controller DIR, cluster.sh start-controller DIR
#   cluster.sh stop DIR           ends everything that start has started
set -u
action=${1:-}
dir=${2:-}
node=${3:-}
host=$(hostname -s)

complain() { echo "cluster.sh: $*" >&2; exit 1; }

# A process that has ended may remain as a zombie if no process waits for it.
lives() { grep -q '^State:[[:space:]]*[^ZX]' "/proc/$1/status" 2> /dev/null; }

# Ends the process whose number is in a file, and waits for it.
end() {
  local file=$1 signal=${2:-TERM} pid
  [ -s "$file" ] || return 0
  pid=$(cat "$file")
  kill "-$signal" "$pid" 2> /dev/null
  for _ in $(seq 100); do lives "$pid" || break; sleep 0.1; done
  lives "$pid" && kill -KILL "$pid" 2> /dev/null
  rm -f "$file"
}

# The processes of the steps on nodes ("n2", or "n." for all). Each has the name of its node and the
# path of this folder in its environment.
steps_of() {
  local file
  for file in /proc/[0-9]*/environ; do
    grep -qszx "SLURMD_NODENAME=$1" "$file" && grep -qszx "SLURM_CONF=$dir/slurm.conf" "$file" &&
      basename "$(dirname "$file")"
  done
}

start_node() {
  SLURM_CONF=$dir/slurm.conf slurmd -N "$1" -f "$dir/slurm.conf" || complain "slurmd $1 did not start"
}

start_controller() {
  SLURM_CONF=$dir/slurm.conf slurmctld -f "$dir/slurm.conf" || complain "slurmctld did not start"
}

case $action in
check)
  for program in munged slurmctld slurmd sbatch squeue; do
    command -v "$program" > /dev/null || { echo "skipped: $program is not installed"; exit 77; }
  done
  [ "$(id -u)" = 0 ] || { echo "skipped: only root can start slurmd"; exit 77; }
  id munge > /dev/null 2>&1 || { echo "skipped: there is no user munge"; exit 77; }
  ;;
start)
  [ -n "$dir" ] || complain "start needs a folder"
  mkdir -p "$dir/state" "$dir/spool" "$dir/munge" || complain "the folder $dir cannot be made"
  chmod 755 "$dir"
  # Two clusters on one machine need ports of their own.
  base=${AYUMI_CLUSTER_PORT:-$((20000 + $$ % 20000))}
  head -c 1024 /dev/urandom > "$dir/munge/key"
  chown -R munge "$dir/munge"
  chmod 400 "$dir/munge/key"
  chmod 755 "$dir/munge"
  runuser -u munge -- munged --key-file "$dir/munge/key" --socket "$dir/munge/socket" \
    --pid-file "$dir/munge/pid" --log-file "$dir/munge/log" --seed-file "$dir/munge/seed" ||
    complain "munged did not start"
  cat > "$dir/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$base
AuthType=auth/munge
AuthInfo=socket=$dir/munge/socket
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool/%n
SlurmctldPidFile=$dir/ctld.pid
SlurmdPidFile=$dir/slurmd.%n.pid
SlurmctldLogFile=$dir/ctld.log
SlurmdLogFile=$dir/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
ReturnToService=2
MpiDefault=none
# The daemons listen on the address of their node, which is the loopback interface.
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmctldTimeout=10
SlurmdTimeout=10
MinJobAge=10
NodeName=n[1-4] NodeHostname=$host NodeAddr=127.0.0.1 Port=[$((base + 1))-$((base + 4))] CPUs=1 State=UNKNOWN
PartitionName=p Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
  start_controller
  for n in 1 2 3 4; do start_node n$n; done
  export SLURM_CONF=$dir/slurm.conf
  for _ in $(seq 300); do
    [ "$(sinfo -h -N -t idle -o %N 2>/dev/null | wc -l)" = 4 ] && exit 0
    sleep 0.2
  done
  complain "the four nodes are not idle after a minute"
  ;;
kill-node)
  end "$dir/slurmd.$node.pid" KILL
  for pid in $(steps_of "$node"); do kill -KILL "$pid" 2>/dev/null; done
  ;;
start-node) start_node "$node" ;;
stop-controller) end "$dir/ctld.pid" ;;
start-controller) start_controller ;;
stop)
  [ -n "$dir" ] || complain "stop needs a folder"
  if [ -s "$dir/ctld.pid" ]; then
    SLURM_CONF=$dir/slurm.conf scancel --me 2> /dev/null
    sleep 1
  fi
  for file in "$dir"/ctld.pid "$dir"/slurmd.*.pid; do
    [ -s "$file" ] && kill "$(cat "$file")" 2> /dev/null
  done
  for file in "$dir"/ctld.pid "$dir"/slurmd.*.pid; do end "$file"; done
  for pid in $(steps_of 'n.'); do kill -KILL "$pid" 2> /dev/null; done
  end "$dir/munge/pid"
  ;;
*) complain "unknown action '$action'" ;;
esac
