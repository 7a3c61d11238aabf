#!/usr/bin/env bash
# A sweep on Slurm, on one node: an array of 16 tasks, one of them killed in the middle and the others cancelled, the same command
# again, and the union compared with a run on this machine, byte for byte. Needs cargo, Python, and a root that can install
# `slurm-wlm` and `munge` where they are missing.
set -euo pipefail
cd "$(dirname "$0")/../.."

if ! command -v slurmctld > /dev/null || ! command -v munged > /dev/null; then
    apt-get update --quiet > /dev/null
    DEBIAN_FRONTEND=noninteractive apt-get install --yes --quiet --no-install-recommends slurm-wlm munge > /dev/null
fi
target="$(realpath -m "${CARGO_TARGET_DIR:-target}")"
# One that was built with the tests will do: alone, its dependencies have other features, and are built anew.
hamel="$target/debug/hamel"
if [ -z "${HAMEL_BUILT:-}" ] || [ ! -x "$hamel" ]; then
    cargo build --quiet --locked -p hamel-cli
fi
folder="$(mktemp -d)"
node="$(hostname -s)"
export SLURM_CONF="$folder/slurm.conf"
ended() {
    pkill -KILL -f "$SLURM_CONF" || true
    pkill -KILL -f "$folder/munge" || true
    rm -rf "$folder"
}
trap ended EXIT

mkdir -m 755 "$folder/munge"
chmod 755 "$folder"
head -c 1024 /dev/urandom > "$folder/munge/key"
chmod 400 "$folder/munge/key"
munged --force --key-file="$folder/munge/key" --socket="$folder/munge/socket" --pid-file="$folder/munge/pid" \
    --log-file="$folder/munge/log" --seed-file="$folder/munge/seed"
cat > "$SLURM_CONF" <<CONF
ClusterName=one
SlurmctldHost=$node(127.0.0.1)
SlurmUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
CredType=cred/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
SlurmctldPort=26817
SlurmdPort=26818
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
ReturnToService=2
KillWait=1
NodeName=$node NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
mkdir "$folder/state" "$folder/spool"
slurmctld -f "$SLURM_CONF"
slurmd -f "$SLURM_CONF"
python3 tests/sweep/on_slurm.py "$hamel" "$folder"
