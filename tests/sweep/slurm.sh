#!/usr/bin/env bash
# Runs a sweep on Slurm, on one node: an array of 16 tasks, one of which is killed in the middle and the others
# cancelled; then the same command is repeated, and the union compared with a run on this machine, byte by byte. Needs
# cargo and Python. Slurm and munge come from Debian's packages, which are unpacked below the target; if they are not
# available, the script prints a message and succeeds.
set -euo pipefail
cd "$(dirname "$0")/../.."

source xtask/debian.sh
plugins="$debian/usr/lib/x86_64-linux-gnu/slurm-wlm"
if [ ! -x "$debian/usr/sbin/slurmctld-wlm" ] && ! unpack slurm-wlm munge; then
    echo "not run on Slurm: there are no packages of Debian to take it from"
    exit 0
fi
export PATH="$debian/usr/bin:$PATH" LD_LIBRARY_PATH="$debian_libraries:$plugins"
target="$(realpath -m "${CARGO_TARGET_DIR:-target}")"
# Reuses the program built with the tests: built alone, its dependencies have other features and are compiled again.
hamel="$target/debug/hamel"
if [ -z "${HAMEL_BUILT:-}" ] || [ ! -x "$hamel" ]; then
    cargo build --quiet --locked -p hamel-cli --all-features
fi
folder="$(mktemp -d)"
node="$(hostname -s)"
export SLURM_CONF="$folder/slurm.conf"
ended() {
    for pid in "$folder"/*.pid "$folder/munge/pid"; do
        [ ! -f "$pid" ] || kill -KILL "$(cat "$pid")" || true
    done
    rm -rf "$folder"
}
trap ended EXIT

mkdir -m 755 "$folder/munge"
chmod 755 "$folder"
head -c 1024 /dev/urandom > "$folder/munge/key"
chmod 400 "$folder/munge/key"
"$debian/usr/sbin/munged" --force --key-file="$folder/munge/key" --socket="$folder/munge/socket" --pid-file="$folder/munge/pid" \
    --log-file="$folder/munge/log" --seed-file="$folder/munge/seed"
cat > "$SLURM_CONF" <<CONF
ClusterName=one
PluginDir=$plugins
SlurmctldHost=$node(127.0.0.1)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
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
SchedulerParameters=sched_min_interval=0,batch_sched_delay=0,sched_interval=1
MpiDefault=none
ReturnToService=2
KillWait=1
NodeName=$node NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
mkdir "$folder/state" "$folder/spool"
"$debian/usr/sbin/slurmctld-wlm" -f "$SLURM_CONF"
"$debian/usr/sbin/slurmd-wlm" -f "$SLURM_CONF" -d "$debian/usr/sbin/slurmstepd-wlm"
python3 tests/sweep/on_slurm.py "$hamel" "$folder"
