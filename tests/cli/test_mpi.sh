# Processes that share a job make the film of one process, bit for bit, however many there are and whoever renders what;
# what ends one of them ends the job, and nothing that was kept is lost.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

module=$(find "$PSPLAT_BUILD" -path '*/psplat/mpi.so' | head -n 1)
[ -n "$module" ] || skip "this psplat was built without MPI"
command -v mpirun >mpirun_path || skip "no mpirun"
is_on PSPLAT_SANITIZE && skip "MPI keeps memory of its own, and ends processes by signals"
# Tests may run as root, on machines with fewer processors than ranks, and without a network.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
export OMPI_MCA_btl=self,vader OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_mpi_yield_when_idle=1

glossy=$PSPLAT_SOURCE/scenes/cornell-glossy.psd
job="--mpi -t 1 --size 60x34 -p injection=photon:count=2000 --passes 11"

# run_ranks STATUS N WORD...: as run, by N processes.
run_ranks() {
    expected=$1 ranks=$2
    shift 2
    last="mpirun -n $ranks psplat $*"
    timeout 200 mpirun -n "$ranks" "$PSPLAT" "$@" >out 2>err </dev/null
    check_status $? "$expected"
}

# --- one film, whoever made it ---

# shellcheck disable=SC2086
run 0 -q ${job#--mpi} --checkpoint one.exr -o one.png "$glossy"
for ranks in 1 2 3 4; do
    # shellcheck disable=SC2086
    run_ranks 0 $ranks -q $job --checkpoint film$ranks.exr -o film$ranks.png "$glossy"
    expect_same one.exr film$ranks.exr
    expect_same one.png film$ranks.png
    expect_no_text err "psplat:"
done
# Gathered again and again on the way.
rm -f film3.exr film3.png
# shellcheck disable=SC2086
run_ranks 0 3 $job --checkpoint film3.exr --checkpoint-every 0.001s --write-every 0.001s --progress json -o film3.png "$glossy"
expect_same one.exr film3.exr
expect_same one.png film3.png
expect_match out '"stage": "done", "fraction": 1.0000, "passes": 11,'
expect_text err "psplat: wrote film3.png"
[ "$(grep -c 'wrote film3.png' err)" -eq 1 ] || fail "several processes wrote"
# More processes than passes; and passes that are there already.
# shellcheck disable=SC2086
run_ranks 0 4 -q $job --passes 2:4 --checkpoint few.exr "$glossy"
run 0 info few.exr
expect_match out '^psplat.pass_set: 2:4$'
# shellcheck disable=SC2086
run_ranks 0 2 -q $job --checkpoint few.exr --resume -o few.png "$glossy"
expect_same one.exr few.exr
# Until the error is small enough, by the film of all.
# shellcheck disable=SC2086
run_ranks 0 2 -q $job --passes 1000 --error 4% --checkpoint error.exr -o error.png "$glossy"
run 0 info error.exr
expect_match out '^psplat.pass_set: 0:[0-9]+$'

# --- one process reads the scene ---

# The others stand in a folder without it, and without what it names.
mkdir empty
make_scene_files
cat >rest.psd <<PSD
psd: 1
parameters: {height: {default: 0}}
materials: {floor: {diffuse: {image: {file: rgb8.png}}}}
groups: {pair: [box: {corners: [[0, 0, 0], [1, 1, 1]], material: floor}]}
PSD
cat >files.psd <<PSD
psd: 1
include: rest.psd
camera: {location: [5, 3, -8], look_at: [0, 0, 0]}
lights: [sky: {file: baseline.jpg}]
objects:
  - mesh: {file: blender.glb}
  - mesh: {file: box.obj}
  - instance: {of: pair, translate: [2, "=height", 0]}
  - quad: {corners: [[-5, -1, -5], [-5, -1, 5], [5, -1, 5], [5, -1, -5]], material: floor}
PSD
# apart STATUS SCENE WORD...: by three processes.
apart() {
    expected=$1 scene=$2
    shift 2
    last="three processes, of which one can read $scene; $*"
    # shellcheck disable=SC2086
    timeout 200 mpirun -n 1 "$PSPLAT" -q $job "$@" "$scene" : -n 2 --wdir empty "$PSPLAT" -q $job "$@" "$scene" >out 2>err <rest_of_input
    check_status $? "$expected"
}
: >rest_of_input
# shellcheck disable=SC2086
run 0 -q ${job#--mpi} --param height=0.5 --checkpoint alone.exr -o alone.png files.psd
apart 0 files.psd --param height=0.5 --checkpoint apart.exr -o apart.png
expect_same alone.exr apart.exr
expect_same alone.png apart.png
# From standard input, which mpirun gives to the first alone.
cp "$glossy" rest_of_input
ln -s "$PSPLAT_SOURCE/scenes/library" library
# shellcheck disable=SC2086
"$PSPLAT" -q ${job#--mpi} -o input_alone.png - <rest_of_input
apart 0 - -o input_apart.png
expect_same input_alone.png input_apart.png
# What the first cannot read, or will not write, ends all.
apart 1 files.psd -o none/no.png
expect_match err "can't write 'none/no.png'"
rm baseline.jpg
apart 2 files.psd -o no.png
[ "$(grep -c 'baseline.jpg: cannot open' err)" -eq 1 ] || fail "it was said by more than one, or none"

# --- two hosts ---

# Two network namespaces with a wire between them, whose processes have a host name each and reach each other by TCP alone.
cat >agent <<'AGENT'
#!/bin/sh
host=$1
shift
exec ip netns exec "$host" unshare --uts sh -c "hostname $host; $*"
AGENT
chmod +x agent
cat >two_hosts.sh <<'HOSTS'
set -e
mount -t tmpfs tmpfs /run
printf '10.9.0.1 one\n10.9.0.2 two\n' >hosts
mount --bind hosts /etc/hosts
ip netns add one
ip netns add two
ip link add to_two netns one type veth peer name to_one netns two
ip -n one addr add 10.9.0.1/24 dev to_two
ip -n two addr add 10.9.0.2/24 dev to_one
for host in one two; do
    ip -n $host link set lo up
done
ip -n one link set to_two up
ip -n two link set to_one up
hostname one
export OMPI_MCA_btl=self,tcp OMPI_MCA_btl_tcp_if_include=10.9.0.0/24 OMPI_MCA_oob_tcp_if_include=10.9.0.0/24
exec ip netns exec one timeout 200 mpirun --mca plm rsh --mca plm_rsh_agent "$PWD/agent" --host one:1,two:1 -n 2 "$@"
HOSTS
if unshare -rmnu sh two_hosts.sh hostname >out 2>err && [ "$(sort out | tr '\n' ' ')" = 'one two ' ]; then
    last="psplat on two hosts"
    rm -f two.exr
    # shellcheck disable=SC2086
    unshare -rmnu sh two_hosts.sh "$PSPLAT" -q $job --checkpoint two.exr --checkpoint-every 0.01s "$glossy" >out 2>err
    check_status $? 0
    expect_same one.exr two.exr
else
    echo "two hosts can't be had here: $(tail -n 1 err)"
fi

# --- what is wrong is said once ---

# shellcheck disable=SC2086
run_ranks 2 3 $job -o no.png missing.psd
[ "$(grep -c 'missing.psd' err)" -eq 1 ] || fail "it was said by more than one, or none"
# shellcheck disable=SC2086
run_ranks 2 2 $job --checkpoint one.exr -o no.png "$glossy"
expect_text err "--checkpoint: 'one.exr' is there already"
last="two processes with different seeds"
# shellcheck disable=SC2086
timeout 200 mpirun -n 1 "$PSPLAT" $job -o no.png "$glossy" : -n 1 "$PSPLAT" $job --seed 1 -o no.png "$glossy" >out 2>err
check_status $? 2
expect_text err "--mpi: process 1 can't load the scene, or has another scene"
[ ! -e no.png ] || fail "no.png was written"

# --- what ends one ends all ---

# start FILM WORD...: a job without end, until it has a checkpoint.
start() {
    rm -f "$1"
    # shellcheck disable=SC2086
    mpirun -n 3 "$PSPLAT" $job --passes 1000000 --checkpoint "$1" --checkpoint-every 0.1s --resume -o end.png "$glossy" >out 2>err &
    process=$!
    while [ ! -e "$1" ] && kill -0 $process; do
        sleep 0.1
    done
    workers=$(pgrep -P $process -f "passes 1000000" | sort -n)
    [ "$(echo "$workers" | wc -l)" -eq 3 ] || fail "$workers are not three processes"
}

last="a signal to the second of three processes"
start stopped.exr
kill -TERM "$(echo "$workers" | sed -n 2p)"
wait $process
status=$?
[ $status -ne 0 ] || fail "exit status 0"
expect_text err "interrupted: the picture holds what was done by then"
expect_picture end.png
run 0 resolve -q stopped.exr -o stopped.png

last="a process that dies"
start dead.exr
kill -KILL "$(echo "$workers" | sed -n 3p)"
wait $process
status=$?
[ $status -ne 0 ] || fail "exit status 0"
run 0 resolve -q dead.exr -o dead.png
passes=$("$PSPLAT" info dead.exr | sed -n 's/^psplat.pass_set: //p')
case $passes in
0:*) ;;
*) fail "passes $passes" ;;
esac

finish
