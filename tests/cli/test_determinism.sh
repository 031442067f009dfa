# The same picture to the last bit: whatever the number of threads, the batches and the statistics.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

scene="--size 160x90 --plugin injection=photon:count=5000,bounces=3 --passes 2 $cornell"
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
same default
same stats --threads 2 --stats stats.json
same batch1000 --threads 2 --batch 1000
same batch17 --threads 3 --batch 17
same batch_large --threads 2 --batch 1048576
same quiet --quiet

# Through every strategy that works on many pixels or sources at once.
other="--size 80x45 --plugin injection=photon:count=2000,bounces=0 --plugin denoiser=gaussian:size=9x9
    --plugin visibility=none --plugin normalization=weight $cornell"
run 0 $other --threads 1 -o other1.exr
run 0 $other --threads 3 --batch 100 -o other3.exr
expect_same other1.exr other3.exr
expect_different other1.exr one.exr

finish
