# Memory ends at any of psplat's allocations: a message that says so, no crash, no leak (with sanitizers), and files are
# whole or as they were.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

compile_preload failing_allocation || skip "no library to preload can be made here: $(head -n 1 compiler)"
LD_PRELOAD=./failing_allocation.so FAIL_COUNT=count "$PSPLAT" --version >out 2>err
[ -s count ] || skip "psplat can't be run with a library preloaded"

# Every allocation of a command takes minutes: every so many of them, and in the whole run more.
stride=29
[ -n "${PSPLAT_QUICK:-}" ] || stride=10
! is_on PSPLAT_SANITIZE || stride=$((stride * 5))

# fill_new: files of an earlier run, that no failure may touch.
fill_new() {
    rm -rf new
    mkdir new
    echo old >new/a.exr
    echo old >new/a.png
}

# old_or_whole FILE
old_or_whole() {
    [ ! -e "$1" ] || [ "$(head -c 3 "$1")" = old ] || expect_picture "$1"
}

# try N WORD...: the command, whose Nth allocation fails.
try() {
    number=$1
    shift
    last="psplat $* (allocation $number fails${FAIL_ON:+, and all that follow})"
    fill_new
    LD_PRELOAD=./failing_allocation.so FAIL_AT=$number "$PSPLAT" "$@" >out 2>err </dev/null
    status=$?
    [ $status -eq 1 ] || [ $status -eq 2 ] || check_status $status 1
    expect_match err 'out of memory|Cannot allocate memory'
    check_status $status $status # sanitizers
    for file in new/*; do
        case $file in
        *.exr | *.png) old_or_whole "$file" ;;
        *) fail "$file was left behind" ;;
        esac
    done
    [ -z "$(find new -name '.*' -type f)" ] || fail "a hidden file was left behind"
}

# every WORD...: the command, with each allocation failing in its turn.
every() {
    fill_new
    rm -f count
    last="psplat $*"
    LD_PRELOAD=./failing_allocation.so FAIL_COUNT=count "$PSPLAT" "$@" >out 2>err </dev/null
    check_status $? 0
    most=$(cat count)
    [ "$most" -gt 10 ] || fail "only $most allocations"
    at=$((offset % stride + 1))
    offset=$((offset + 11))
    while [ "$at" -le "$most" ] && [ $failures -lt 10 ]; do
        try "$at" "$@"
        FAIL_ON=1
        export FAIL_ON
        [ $((at % 4)) -ne 0 ] || try "$at" "$@"
        unset FAIL_ON
        at=$((at + stride))
    done
}
offset=0

few="-t 1 -q --size 32x18 -p injection=photon:count=500"
every $few -o new/a.exr -o new/a.png --passes 2 --checkpoint new/film.exr "$cornell"
for estimator in splat pathtrace bdpt photonmap sppm final_gather vpl lightcuts irradiance_cache radiosity voxel_cone lpv ssao hbao; do
    every $few -p "$(small_choice estimator=$estimator)" -o new/a.exr "$cornell"
done
every $few -p estimator=splat -p injection=rsm:count=500,resolution=16 -p stratification=octree -o new/a.exr "$cornell"
every $few -p estimator=splat -p injection=voxel:resolution=8 -p stratification=grid -p visibility=imperfect:points=500 \
    -o new/a.exr "$cornell"

every $few --size 80x20 --tile 64 -o new/a.exr -o new/a.png "$cornell"

# Readers of meshes and pictures.
make_scene_files
cat >files.psd <<PSD
psd: 1
camera: {location: [5, 3, -8], look_at: [0, 0, 0]}
lights: [sky: {file: baseline.jpg}]
materials: {floor: {diffuse: {image: {file: rgb8.png}}}}
objects:
  - mesh: {file: blender.glb}
  - mesh: {file: box.obj}
  - quad: {corners: [[-5, -1, -5], [-5, -1, 5], [5, -1, 5], [5, -1, -5]], material: floor}
PSD
every $few -o new/a.exr files.psd

run 0 $few -o a.exr --passes 0:1 --checkpoint a-film.exr "$cornell"
run 0 $few -o b.exr --passes 1:2 --checkpoint b-film.exr "$cornell"
every merge -q a-film.exr b-film.exr -o new/a.exr
every resolve -q a-film.exr -o new/a.exr -o new/a.png
every view a.exr -o new/a.png -p bloom=glare:threshold=0.5 -p tonemap=chroma:exposure=auto
every compare a.exr b.exr
every info a.exr

finish
