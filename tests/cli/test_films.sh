# Films: what was rendered apart adds up to the film of one run, bit for bit; a film makes the picture that the render
# made; what does not belong together is refused, and says why.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

area=$PSPLAT_SOURCE/scenes/cornell-area.psd
glossy=$PSPLAT_SOURCE/scenes/cornell-glossy.psd
few="-q --size 60x34 -p injection=photon:count=2000"

# --- passes of each strategy do not depend on each other ---

"$PSPLAT" plugins | awk '/^[a-z]/ { kind = $1 } /^  [a-z]/ { print kind "=" $1 }' |
    grep -v -e normalization= -e denoiser= -e bloom= -e tonemap= >strategies
while read -r strategy; do
    choice="-p estimator=splat -p $(small_choice "$strategy")"
    rm -f ./*.exr
    # shellcheck disable=SC2086
    run 0 $few $choice --passes 3 --checkpoint all.exr -o all.png "$area"
    run 0 $few $choice --passes 1:3 --checkpoint late.exr --threads 3 --batch 100 "$area"
    run 0 $few $choice --passes 0:1 --checkpoint early.exr "$area"
    run 0 merge -q late.exr early.exr -o sum.exr
    last=$strategy
    expect_same all.exr sum.exr
done <strategies

# --- with gloss, edges, area lights, and a denoiser that asks for all there is ---

rm -f ./*.exr
run 0 $few --passes 8 --checkpoint all.exr -o whole.exr "$glossy"
run 0 $few --passes 8 -o plain.exr "$glossy"
for run in 0:4 4:5 5:8; do
    run 0 $few --passes $run --checkpoint ${run%:*}.exr "$glossy"
done
run 0 merge 4.exr 0.exr 5.exr -o sum.exr
expect_text err "psplat: wrote sum.exr: 8 passes"
expect_same all.exr sum.exr
run 0 resolve sum.exr -o resolved.exr -o resolved.png
expect_same_pixels whole.exr plain.exr
expect_same_pixels whole.exr resolved.exr
run 0 compare resolved.exr whole.exr --metric max --fail 'max>0'
run 0 compare resolved.exr whole.exr --layer error --metric max --fail 'max>0'
expect_picture resolved.exr resolved.png
run 0 info resolved.exr
expect_text out "psplat.passes: 8"
expect_match out "^psplat.denoiser: regression"
expect_match out '^estimated error of the indirect light: [0-9.]+ %$'
run 0 info sum.exr
expect_match out '^estimated error of the indirect light, not denoised: [0-9.]+ %$'
run 0 info 4.exr # of a single pass nothing is known
expect_no_text out 'estimated error'

# Of a single pass the noise is guessed, by what the film tells of its edges.
for samples in 1 8; do
    rm -f one.exr
    run 0 $few --passes 1 --set render.aa_samples=$samples --checkpoint one.exr -o alone.exr "$glossy"
    run 0 resolve -q one.exr -o again.exr
    expect_same_pixels alone.exr again.exr
    run 0 $few --passes 1 --set render.aa_samples=$samples -o plain.exr "$glossy"
    expect_same_pixels alone.exr plain.exr
done

# Another denoiser, normalization and exposure, without rendering.
run 0 $few --passes 8 -p denoiser=gaussian:size=7x7 -p normalization=intensity --exposure 2 -o other.png -o other.exr "$glossy"
run 0 resolve sum.exr -q -p denoiser=gaussian:size=7x7 -p normalization=intensity --exposure 2 -o same.png -o same.exr --threads 1
run 0 compare same.exr other.exr --metric max --fail 'max>0'
run 0 info same.exr
expect_match out "^psplat.denoiser: gaussian:"
run 0 resolve sum.exr -q --layers none --compression rle -o same.exr
run 0 info same.exr
expect_text out "channels: B G R"

# A film that holds part of a job is a picture as well.
run 0 resolve 4.exr -q -o part.exr
run 0 $few --passes 4:5 -o part4.exr "$glossy"
expect_same_pixels part.exr part4.exr
run 0 info 0.exr
expect_text out "psplat.pass_set: 0:4"

# --- each denoiser makes of a film what it makes of the render, whose pixels the film does not change ---

cat >sunny.psd <<'END'
psd: 1
camera: {location: [0, 2, 6], look_at: [0, 0.5, 0], angle: 40}
image: {width: 64, height: 48}
materials: {grey: {diffuse: 0.5}}
lights: [{sun: {direction: [-1, -1, -0.5], irradiance: 3}}, {sky: {radiance: 0.3}}]
objects:
  - box: {corners: [[-4, -0.1, -4], [4, 0, 4]], material: grey}
  - sphere: {center: [0, 0.6, 0], radius: 0.6, material: grey}
END
for denoiser in none gaussian bilateral regression; do
    run 0 $few -p denoiser=$denoiser --passes 2 -o plain.exr sunny.psd
    run 0 $few -p denoiser=$denoiser --passes 2 --checkpoint sunny.exr -o kept.exr sunny.psd
    run 0 resolve -q sunny.exr -p denoiser=$denoiser -o resolved.exr
    expect_same_pixels plain.exr kept.exr
    expect_same_pixels plain.exr resolved.exr
    rm -f sunny.exr
done

# --- what does not belong together ---

run 2 merge 0.exr 0.exr -o no.exr
expect_text err "can't add '0.exr': the films before it hold pass 0 already"
run 0 $few --passes 8:9 --seed 1 --checkpoint seed.exr "$glossy"
run 2 merge 0.exr seed.exr -o no.exr
expect_text err "can't add 'seed.exr' to '0.exr': they differ in the seed, '0' and '1'"
run 0 $few --passes 8:9 --checkpoint area.exr "$area"
run 2 merge 0.exr area.exr -o no.exr
expect_text err "can't add 'area.exr' to '0.exr': they differ in the scene's "
run 0 -q --size 61x34 -p injection=photon:count=2000 --passes 8:9 --checkpoint size.exr "$glossy"
run 2 merge 0.exr size.exr -o no.exr
expect_text err "they differ in the size, '60x34' and '61x34'"
run 0 $few -p injection=photon:count=2001 --passes 8:9 --checkpoint count.exr "$glossy"
run 2 merge 0.exr count.exr -o no.exr
expect_text err "they differ in the injection, 'photon:count=2000,"
run 2 merge 0.exr whole.exr -o no.exr
expect_text err "'whole.exr' is no film"
run 2 resolve whole.exr -o no.exr
expect_text err "'whole.exr' is no film"
head -c 5000 0.exr >cut.exr
run 1 merge cut.exr 4.exr -o no.exr
expect_text err "cannot read 'cut.exr'"
run 1 merge missing.exr -o no.exr
expect_text err "cannot read 'missing.exr'"
run 2 merge 0.exr
expect_text err "--output: a film needs a name that ends in .exr"
run 2 merge 0.exr -o no.png
expect_text err "--output: a film needs a name that ends in .exr"
run 2 merge -o no.exr
expect_text err "which films?"
run 2 resolve 0.exr
expect_text err "where to?"
cp 0.exr kept.exr
ln -s 0.exr link.exr
run 2 resolve 0.exr -o ./link.exr
expect_text err "'./link.exr' is the film itself"
expect_same 0.exr kept.exr
run 2 resolve 0.exr -o no.exr -p estimator=splat
expect_text err "--plugin: expected normalization=NAME, denoiser=NAME, bloom=NAME or tonemap=NAME, got 'estimator=splat'"
run 2 resolve 0.exr -o no.exr -p denoiser=gaussian:size=8x8
expect_text err "size"
run 2 resolve 0.exr -o no.exr -p denoiser=gaussian --layers error
expect_text err "--layers: denoiser 'gaussian' does not estimate its error"
run 2 $few --passes 0:2 "$area"
expect_text err "--passes A:B: where to?"
for wrong in 2:2 3:1 1: :2 a:b -1:2; do
    run 2 $few --passes=$wrong -o no.exr "$area"
    expect_text err "--passes: expected a whole number"
done
[ ! -e no.exr ] || fail "no.exr was written"

finish
