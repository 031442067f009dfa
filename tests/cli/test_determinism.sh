# The same picture to the last bit: whatever the number of threads, the batches and the statistics.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

scene="--size 160x90 --plugin injection=photon:count=5000 --bounces 3 --passes 2 $cornell"
run 0 $scene --threads 1 -o one.exr -o one.png
expect_picture one.exr one.png

# same NAME WORD...: this render is the first one again.
same() {
    name=$1
    shift
    run 0 $scene "$@" -o "$name.exr" -o "$name.png"
    expect_same "$name.exr" one.exr
    expect_same "$name.png" one.png
}

same twice --threads 1
same threads2 --threads 2
same threads3 -t 3
same threads16 -t 16
same default
same stats --threads 2 --stats stats.json
same batch1000 --threads 2 --batch 1000
same batch17 --threads 3 --batch 17
same batch_large --threads 2 --batch 4096
same quiet --quiet

# With light from neighbours, and more samples at edges, which read what other threads' tiles hold.
lamp="$PSPLAT_SOURCE/scenes/cornell-area.psd --size 70x40 -q -p injection=photon:count=500"
run 0 $lamp --set render.discontinuity_buffer=yes --threads 1 -o join.exr
run 0 $lamp --set render.discontinuity_buffer=yes --threads 3 -o join3.exr
expect_same join3.exr join.exr
run 0 $lamp --threads 3 -o alone.exr
expect_different join.exr alone.exr
run 0 $scene --set render.aa_samples=5 --threads 1 -o edges.exr
run 0 $scene --set render.aa_samples=5 --threads 3 -o edges3.exr
expect_same edges3.exr edges.exr
run 1 compare edges.exr one.exr --fail 'rel_rmse>0.001'

# Of one instruction set, that is: others round otherwise, and that little.
run 0 $scene --isa baseline --threads 1 -o baseline.exr
run 0 $scene --isa=baseline --threads 3 --batch 100 -o baseline3.exr
expect_same baseline.exr baseline3.exr
best=baseline
for isa in avx2 avx512; do
    last="--isa $isa"
    "$PSPLAT" $scene --isa $isa --threads 1 -q -o $isa.exr >out 2>err
    status=$?
    if [ $status -eq 2 ] && grep -qF "this processor has no instruction set '$isa'" err; then
        echo "this processor has no $isa"
        continue
    fi
    check_status $status 0
    run 0 $scene --isa $isa --threads 2 -o again.exr
    expect_same again.exr $isa.exr
    run 0 compare baseline.exr $isa.exr --fail 'rel_rmse>0.01'
    best=$isa
done
expect_same_pixels default.exr $best.exr
run 2 $scene --isa sse9 -o no.exr
expect_text err "psplat: error: "
expect_text err "sse9"
[ ! -e no.exr ] || fail "a picture in spite of the error"

run 0 $scene --direct shadowmap --direct-resolution 99 --threads 1 -o maps1.exr
run 0 $scene --direct shadowmap --direct-resolution 99 --threads 3 -o maps3.exr
expect_same maps1.exr maps3.exr
expect_different maps1.exr one.exr

# Every strategy that works on many pixels or photons at once.
other="--size 80x45 --plugin injection=photon:count=2000 --bounces all --plugin denoiser=gaussian:size=9x9
    --plugin visibility=none --plugin normalization=weight $cornell"
run 0 $other --threads 1 -o other1.exr
run 0 $other --threads 3 --batch 100 -o other3.exr
expect_same other1.exr other3.exr
expect_different other1.exr one.exr
other="$other --plugin denoiser=bilateral:size=9 --plugin normalization=intensity:exposure=2"
run 0 $other --threads 1 -o smooth1.exr
run 0 $other --threads 3 --batch 100 -o smooth3.exr
expect_same smooth1.exr smooth3.exr
expect_different smooth1.exr other1.exr
other="--size 80x45 --plugin estimator=pathtrace:samples=2 --passes 3 --plugin denoiser=regression $PSPLAT_SOURCE/scenes/cornell-area.psd"
run 0 $other --threads 1 -o regression1.exr
run 0 $other --threads 3 -o regression3.exr
expect_same regression1.exr regression3.exr
for stratification in grid:centre=camera,threshold=3,levels=4 cascade octree; do
    few="--size 80x45 --passes 2 -p injection=photon:count=3000 --bounces 3 -p stratification=$stratification $cornell"
    run 0 $few --threads 1 -o merged1.exr
    run 0 $few --threads 3 --batch 100 -o merged3.exr
    expect_same merged1.exr merged3.exr
done
for estimator in splat:interleave=4 pathtrace:samples=4 bdpt:samples=5 photonmap photonmap:gather=2 sppm final_gather:samples=6 vpl:lights=50 vpl:lights=50,visibility=rays lightcuts:lights=500 irradiance_cache:samples=16 radiosity:epsilon=1e-3,samples=4 radiosity:epsilon=1e-3,reconstruction=elements voxel_cone:resolution=32 lpv:cascades=3 ambient ssao hbao gather:samples=6; do
    few="--size 80x45 --passes 2 -p injection=photon:count=1000 -p estimator=$estimator $cornell"
    run 0 $few --threads 1 -o estimator1.exr
    run 0 $few --threads 3 --batch 100 -o estimator3.exr
    expect_same estimator1.exr estimator3.exr
done

finish
