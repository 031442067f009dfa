# The job files of docs/cluster, as they are: a Slurm array on a real slurmctld and slurmd, on the loopback device, and
# GNU parallel. What they render apart is the film of one render.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

cluster=$PSPLAT_SOURCE/docs/cluster
job="--size 60x34 -p injection=photon:count=2000"
# shellcheck disable=SC2086
run 0 -q $job --passes 6 --checkpoint whole.exr "$cornell" -o whole.png
tested=

# --- GNU parallel ---

if parallel --version 2>parallel_err | grep -q 'GNU parallel'; then
    tested="$tested parallel"
    mkdir parallel
    last="parallel.sh"
    # shellcheck disable=SC2086
    HOME=$PWD sh "$cluster/parallel.sh" 3 2 "$cornell" parallel -t 1 $job >out 2>err
    check_status $? 0
    expect_same whole.exr parallel/film.exr
fi

# --- Slurm ---

# Daemons of this test alone: a key, sockets, ports and folders of its own.
start_slurm() {
    mkdir -p munge state spool
    chmod 700 munge
    head -c 1024 /dev/urandom >munge/key
    chmod 400 munge/key
    munged --force --key-file="$PWD/munge/key" --socket="$PWD/munge/socket" --pid-file="$PWD/munge/pid" \
        --log-file="$PWD/munge/log" --seed-file="$PWD/munge/seed" 2>munge/err || return 1
    port=$((20000 + $$ % 20000))
    cat >slurm.conf <<END
ClusterName=psplat
SlurmctldHost=localhost(127.0.0.1)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$PWD/munge/socket
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmctldPidFile=$PWD/state/slurmctld.pid
SlurmdPidFile=$PWD/spool/slurmd.pid
SlurmctldLogFile=$PWD/state/log
SlurmdLogFile=$PWD/spool/log
StateSaveLocation=$PWD/state
SlurmdSpoolDir=$PWD/spool
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
NodeName=localhost NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=localhost Default=YES State=UP
END
    SLURM_CONF=$PWD/slurm.conf
    export SLURM_CONF
    slurmctld -D >state/out 2>&1 &
    slurmctld_process=$!
    slurmd -D -N localhost >spool/out 2>&1 &
    slurmd_process=$!
    for i in $(seq 300); do
        sinfo -h -o %T 2>sinfo_err | grep -q idle && return 0
        kill -0 $slurmctld_process 2>sinfo_err && kill -0 $slurmd_process 2>sinfo_err || return 1
        sleep 0.2
    done
    return 1
}

stop_slurm() {
    for process in $slurmd_process $slurmctld_process $(cat munge/pid); do
        kill "$process" 2>kill_err
    done
    wait
}

if command -v slurmctld slurmd munged sbatch >commands && [ "$(id -u)" -eq 0 ]; then
    tested="$tested slurm"
    mkdir films
    if start_slurm; then
        last="sbatch slurm-array.sh"
        PSPLAT=$PSPLAT sbatch --wait --array=0-2 --output=films/log-%a "$cluster/slurm-array.sh" "$cornell" 2 "$PWD/films" $job >out 2>err
        check_status $? 0
        run 0 merge -q films/film-*.exr -o films/film.exr
        expect_same whole.exr films/film.exr
        expect_text films/log-1 "psplat: "
    else
        fail "Slurm does not start"
        tail -n 5 munge/err munge/log state/log state/out spool/log spool/out
    fi
    stop_slurm
fi

[ -n "$tested" ] || skip "neither GNU parallel nor Slurm, for root, is there"
echo "tested:$tested"
finish
