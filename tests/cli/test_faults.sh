# What goes wrong around a long job: a full disk, a clock that jumps, files of the job that vanish; and that its memory
# does not grow. Each ends with the right message, and loses nothing that is on disk.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

job="-q -t 2 --size 96x54 -p injection=photon:count=500"

# --- a disk that is full ---

# On a file system of so many KiB at ./disk, which nobody else sees: runs psplat as `run` does.
run_on_disk() {
    status=$1 size=$2
    shift 2
    last="psplat $*, on a disk of $size KiB"
    unshare -rm sh -c 'mount -t tmpfs -o size="$0"k tmpfs disk || exit 99
        cp keep/* disk
        "$PSPLAT" "$@" >out 2>err
        status=$?
        ls -A disk >left
        cp disk/* keep
        exit $status' "$size" "$@" </dev/null
    check_status $? "$status"
}
mkdir disk keep
if unshare -rm mount -t tmpfs -o size=64k tmpfs disk 2>/dev/null; then
    echo old >keep/a.exr
    run_on_disk 1 100 $job --size 160x90 -o disk/a.exr -o here.png "$cornell"
    expect_text err "'disk/a.exr': No space left on device"
    [ "$(cat keep/a.exr)" = old ] || fail "the old picture is gone"
    [ "$(cat left)" = a.exr ] || fail "on the disk are $(cat left)"
    expect_picture here.png

    # A film that was written before stays as it was, and the job goes on from it.
    rm keep/*
    run 0 $job --passes 6 --checkpoint whole.exr -o whole.png "$cornell"
    run 0 $job --passes 2 --checkpoint keep/film.exr "$cornell"
    cp keep/film.exr before.exr
    run_on_disk 1 $((($(wc -c <before.exr) + 1023) / 1024 + 60)) \
        $job --passes 6 --checkpoint disk/film.exr --checkpoint-every 0.01s --resume -o part.png "$cornell"
    expect_text err "psplat: error: cannot write 'disk/film.exr': No space left on device"
    expect_same keep/film.exr before.exr
    [ "$(cat left)" = film.exr ] || fail "on the disk are $(cat left)"
    expect_same part.png whole.png # the picture went elsewhere
    run 0 $job --passes 6 --checkpoint keep/film.exr --resume "$cornell"
    expect_same keep/film.exr whole.exr
else
    echo "no disk of its own can be had here: full ones are not tried"
fi

# --- files of the job that vanish ---

mkdir mine
compile_module "$PSPLAT_SOURCE/include" "$PSPLAT_SOURCE/plugins/examples/filter.c" mine/soft.so
sed -n '/^objects:/,$!p' "$cornell" >room.psd
echo 'psd: 1' >walls.psd
sed -n '/^objects:/,$p' "$cornell" >>walls.psd
echo 'include: [walls.psd]' >>room.psd
mine="$job -p estimator=splat -p filter=mine/soft.so --checkpoint film.exr -o film.png"
run 0 $mine --passes 2 room.psd
cp film.exr before.exr
mv walls.psd gone
run 2 $mine --passes 4 --resume room.psd
expect_match err '^room.psd:[0-9]+:[0-9]+: error: .*walls.psd'
expect_same film.exr before.exr
mv gone walls.psd
mv mine/soft.so gone
run 2 $mine --passes 4 --resume room.psd
expect_text err "psplat: error: filter plugin mine/soft.so: no such file"
expect_same film.exr before.exr
mv gone mine/soft.so
run 0 $mine --passes 4 --resume room.psd

# --- a clock that jumps ---

compile_preload jumping_clock || fail "no clock that jumps: $(head -n 1 compiler)"
last="a job of a second, whose clock jumps"
LD_PRELOAD=./jumping_clock.so "$PSPLAT" $job --time 1s --checkpoint film-jumped.exr --checkpoint-every 0.2s --write-every 0.2s \
    --progress json -o jumped.exr -o jumped.png "$cornell" >out 2>err
check_status $? 0
seconds=$(sed -n '/"stage": "done"/s/.*"seconds": \([0-9.]*\).*/\1/p' out)
awk "BEGIN { exit !($seconds >= 0.5 && $seconds < 60) }" || fail "it took $seconds seconds"
run 0 resolve -q film-jumped.exr -o again.exr
expect_same_pixels jumped.exr again.exr

# --- many passes ---

# The least memory of the second, third and last quarter, without what a sanitizer keeps back: what leaks grows from each
# to the next. An allocator may take more once, at any time; and while a checkpoint is written its copy is there.
passes=60 most=0.02
[ -n "${PSPLAT_QUICK:-}" ] || passes=400
! is_on PSPLAT_SANITIZE || passes=$((passes * 2 / 5)) most=0.15 # its allocator scatters what it gives
export ASAN_OPTIONS="quarantine_size_mb=1:thread_local_quarantine_size_kb=64:$ASAN_OPTIONS"
for estimator in gather splat; do
    run 0 -t 2 --size 160x90 -p injection=photon:count=2000 -p estimator=$estimator --set render.aa_samples=2 \
        --passes $passes --progress json --checkpoint soak.exr --checkpoint-every 0.5s -o soak.png \
        "$PSPLAT_SOURCE/scenes/cornell-glossy.psd"
    awk -v passes=$passes -v most=$most -v estimator=$estimator '
        { n = $0; sub(/.*"passes": /, "", n); bytes = $0; sub(/.*"bytes": /, "", bytes); quarter = int(4 * n / passes) }
        n + 0 < passes && (!(quarter in least) || bytes + 0 < least[quarter]) { least[quarter] = bytes + 0 }
        END { print estimator ": " least[1] ", " least[2] ", " least[3] " bytes in the last three quarters of the passes"
              bound = least[1] * most + 5e5
              exit !(least[1] > 0 && least[3] > 0 && (least[2] < least[1] + bound || least[3] < least[2] + bound)) }' \
        out >memory || fail "memory grows: $(cat memory)"
    cat memory
    rm -f soak.exr
done

finish
