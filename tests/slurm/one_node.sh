#!/usr/bin/env bash
# Runs a command under a real Slurm of one node, this machine: munged, slurmctld and slurmd are configured and started
# for it in a folder that goes away, and ended after it. Needs root and the Debian packages slurmctld, slurmd,
# slurm-client and munge; no other Slurm may be at work on the machine. docs/running.md shows what comes out.
#
# usage: one_node.sh [COMMAND [ARGUMENT ...]]   without a command: tests/slurm/trial.sh
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
for program in munged slurmctld slurmd sbatch; do
  command -v "$program" > /dev/null ||
    { echo "$0: no $program: apt-get install slurmctld slurmd slurm-client munge" >&2; exit 3; }
done
[[ $(id -u) == 0 ]] || { echo "$0: needs root, as slurmd does" >&2; exit 3; }

folder=$(mktemp -d)
started=()
end() {
  for ((i = ${#started[@]} - 1; i >= 0; --i)); do
    kill "${started[i]}" 2> /dev/null && wait "${started[i]}" 2> /dev/null || true
  done
  rm -rf "$folder"
}
trap end EXIT

mkdir "$folder/state" "$folder/spool"
head -c 1024 /dev/urandom > "$folder/munge.key"
chmod 600 "$folder/munge.key"
node=$(hostname -s)
cat > "$folder/slurm.conf" << END
ClusterName=trial
SlurmctldHost=$node
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CredType=cred/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldPort=16817
SlurmdPort=16818
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
KillWait=20
MpiDefault=none
NodeName=$node NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$node Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF=$folder/slurm.conf

# Munge asks for a socket in a folder that nobody else may write to.
munged --foreground --force --socket="$folder/munge.socket" --key-file="$folder/munge.key" \
  --pid-file="$folder/munge.pid" --log-file="$folder/munge.log" --seed-file="$folder/munge.seed" \
  2> "$folder/munged.log" &
started+=($!)
until [[ -S $folder/munge.socket ]]; do sleep 0.1; done
slurmctld -D > "$folder/slurmctld.log" 2>&1 &
started+=($!)
slurmd -D > "$folder/slurmd.log" 2>&1 &
started+=($!)
for ((i = 0; i < 300; ++i)); do
  [[ $(sinfo --noheader --format=%t 2> /dev/null) == idle ]] && break
  kill -0 "${started[1]}" "${started[2]}" || { cat "$folder"/slurm*.log >&2; exit 3; }
  sleep 0.1
done
sinfo || { cat "$folder"/slurm*.log >&2; exit 3; }

if (($# == 0)); then set -- "$here/trial.sh"; fi
"$@"
