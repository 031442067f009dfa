# A picture rendered tile by tile (--tile): it is that of one piece, bit for bit, but for what denoisers see beyond a tile;
# memory is that of a tile; and what wants all of the picture is refused.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

glossy=$PSPLAT_SOURCE/scenes/cornell-glossy.psd

# --- the picture ---

# The texts of PNG files tell how they were made.
cat >same_png.py <<'PYTHON'
import sys, zlib

def pixels(path):
    data, at, packed = open(path, "rb").read(), 8, b""
    while at < len(data):
        size = int.from_bytes(data[at:at + 4], "big")
        if data[at + 4:at + 8] in (b"IHDR", b"IDAT"):
            packed += data[at + 8:at + 8 + size]
        at += 12 + size
    return packed[:13], zlib.decompress(packed[13:])

sys.exit(pixels(sys.argv[1]) != pixels(sys.argv[2]))
PYTHON

# expect_same_tiles WORD...: whole and in tiles of 64, of a size that is no multiple of them.
expect_same_tiles() {
    rm -f ./*.exr ./*.png
    run 0 -q --size 110x75 -p denoiser=none "$@" -o whole.exr -o whole.png "$glossy"
    run 0 -q --size 110x75 -p denoiser=none "$@" --tile 64 --threads 2 -o tiles.exr -o tiles.png "$glossy"
    expect_same_pixels whole.exr tiles.exr
    for layer in weight P; do
        run 0 compare whole.exr tiles.exr --layer $layer --metric max --fail 'max>0'
    done
    python3 same_png.py whole.png tiles.png || fail "whole.png and tiles.png differ"
}
few="-p injection=photon:count=1500 --set render.aa_samples=2"
# shellcheck disable=SC2086
{
    expect_same_tiles $few -p estimator=gather:samples=6 --passes 5
    expect_same_tiles $few -p estimator=splat --passes 2
    expect_same_tiles $few -p estimator=radiosity:epsilon=1e-2,samples=2
    expect_same_tiles $few -p estimator=pathtrace:samples=1 --direct shadowmap
}
# The file does not depend on threads, batches and compression; it says how it was made, and that can be repeated.
# shellcheck disable=SC2086
{
    job="-q --size 110x75 $few --passes 2 --tile 64"
    run 0 $job --threads 1 -o one.exr -o one.png "$glossy"
    run 0 $job --threads 3 --batch 7 --compression zip -o three.exr -o three.png "$glossy"
    run 0 $job --compression none -o none.exr "$glossy"
}
expect_same one.exr three.exr
expect_same one.png three.png
expect_same_pixels one.exr none.exr
run 0 info one.exr
expect_text out "one.exr: 110x75"
expect_text out "psplat.crop: none"
expect_text out " --size 110x75 --tile 64 "
sed -n 's/^psplat render/run 0 -q/p' out | sed 's/$/ -o again.exr/' >again
. ./again
expect_same one.exr again.exr
# A denoiser sees 64 pixels around a tile, and little of what is farther off counts.
# shellcheck disable=SC2086
{
    run 0 -q --size 110x75 $few --passes 2 -o whole.exr "$glossy"
    run 0 compare whole.exr one.exr --layer indirect --metric rel_rmse --fail 'rel_rmse>0.01'
    run 0 -q --size 60x50 $few --tile 64 -o one.exr -o one.png "$glossy"
    run 0 -q --size 60x50 $few -o whole.exr "$glossy"
}
expect_same_pixels whole.exr one.exr
# Layers that nobody wants are not there.
# shellcheck disable=SC2086
run 0 $job --layers N,error -o some.exr "$glossy"
run 0 info some.exr
expect_text out "channels: B G N.X N.Y N.Z R error"
expect_empty err

# --- memory ---

# Sanitizers take some of their own.
# shellcheck disable=SC2086
if ! is_on PSPLAT_SANITIZE; then
    large="-q --size 400x300 $few -p estimator=pathtrace:samples=1 --memory-limit 66M"
    run 1 $large -o no.exr "$cornell"
    expect_text err "all of it in parts by --tile"
    run 0 $large --tile 128 -o large.exr "$cornell"
    run 1 $large --tile 384 -o no.exr "$cornell"
fi

# --- what does not go together ---

for words in "--crop 0,0,8,8:--crop" "--checkpoint film.exr:--checkpoint" "--time 5s:--time and --error" \
    "--write-every 1s:--write-every" "--mpi:--mpi" "--display tev:--display"; do
    # shellcheck disable=SC2086
    run 2 $small --tile 64 ${words%:*} -o no.exr "$cornell"
    expect_text err "psplat: error: --tile does not go with ${words#*:}"
done
for words in "estimator=bdpt:--tile: estimator bdpt does not say that it can render a part" \
    "bloom=glare:--tile: bloom glare goes by all of the picture" \
    "tonemap=clip;exposure=auto:--tile: tonemap clip goes by all of the picture"; do
    # shellcheck disable=SC2086
    run 2 $small --tile 64 -p "$(echo "${words%%:*}" | tr ';' ':')" -o no.exr -o no.png "$cornell"
    expect_text err "psplat: error: ${words#*:}"
done
for side in 0 63 100 65600 many; do
    # shellcheck disable=SC2086
    run 2 $small --tile $side -o no.exr "$cornell"
    expect_text err "--tile: "
done
# shellcheck disable=SC2086
run 1 $small --tile 64 -o none/no.exr "$cornell"
expect_text err "can't write 'none/no.exr'"
[ ! -e no.exr ] && [ ! -e no.png ] || fail "a picture was written"

# --- interrupted ---

last="psplat --tile and SIGINT"
mkdir new
passes=400
! is_on PSPLAT_SANITIZE || passes=40
# shellcheck disable=SC2086
"$PSPLAT" --size 128x128 --tile 64 --passes $passes $few --progress json -o new/a.exr -o new/a.png "$cornell" >out 2>err &
process=$!
# Beyond the first tile.
while ! grep -qE '"fraction": 0\.(2[6-9]|[3-9])' out && kill -0 $process; do
    sleep 0.1
done
kill -INT $process || fail "it ended before the signal"
wait $process
check_status $? 130
expect_text err "psplat: error: interrupted: the picture holds the tiles done by then"
expect_picture new/a.exr new/a.png
[ "$(ls new)" = "a.exr
a.png" ] || fail "something else was left behind: $(ls new)"
run 0 info new/a.exr
expect_text out "new/a.exr: 128x128"
expect_no_text err "is not denoised"

# What fails in a tile costs neither that tile nor those before it.
compile_module "$PSPLAT_SOURCE/include" "$PSPLAT_SOURCE/tests/plugins/failing_stage.c" "$PWD/failing.so" -DRESULT=PS_ERROR_INVALID
# shellcheck disable=SC2086
{
    run 2 --size 128x128 --tile 64 $few -p denoiser=./failing.so -o new/failed.exr "$cornell"
    expect_text err "is not denoised"
    run 0 -q --size 128x128 $few -p denoiser=none --crop 0,0,64,64 -o first.exr "$cornell"
}
run 0 compare new/failed.exr first.exr --metric max --fail 'max>0'

finish
