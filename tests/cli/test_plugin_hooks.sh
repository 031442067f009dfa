# What lasts through a render and what passes leave: hooks of estimators, radiance, half buffers, ids.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

compile_module "$PSPLAT_SOURCE/include" "$PSPLAT_SOURCE/tests/plugins/witness.c" "$PWD/witness.so"

# expect_counter NAME VALUE
expect_counter() {
    expect_match a.json "\"witness $1\": $2,?\$"
}

box="--size 48x27 -p estimator=./witness.so -p injection=photon:count=1234"
# shellcheck disable=SC2086
run 0 $box --passes 3 -p denoiser=./witness.so -o a.exr --stats a.json "$cornell"
expect_no_text err warning
expect_counter begins 1
expect_counter ends 1
expect_counter passes 3
expect_counter "kept count" 3
expect_counter "passes announced" 3
expect_counter tiles 6
expect_counter pixels 1296
expect_counter paths 3702
expect_counter "image passes" 3
expect_counter halves 1

# Pixels at edges take several samples in each pass; one pass has no halves.
# shellcheck disable=SC2086
run 0 $box --passes 4 --set render.aa_samples=8 -p denoiser=./witness.so -o a.exr --stats a.json "$cornell"
expect_counter halves 1
# shellcheck disable=SC2086
run 0 $box -p denoiser=./witness.so -o a.exr --stats a.json "$cornell"
expect_counter halves 0

# Threads and batches change nothing.
# shellcheck disable=SC2086
run 0 $box --passes 3 -p denoiser=./witness.so -t 1 -o one.exr "$cornell"
# shellcheck disable=SC2086
run 0 $box --passes 3 -p denoiser=./witness.so -t 3 -o three.exr "$cornell"
expect_same one.exr three.exr

# --- what lies in front of a strategy, or behind it ---

mkdir -p front/filter back/filter
compile_module "$PSPLAT_SOURCE/include" "$PSPLAT_SOURCE/plugins/examples/filter.c" "$PWD/back/filter/cosine.so"
echo "this is text" >front/filter/cosine.so
PSPLAT_PLUGIN_PATH=$PWD/front:$PWD/back
export PSPLAT_PLUGIN_PATH
# shellcheck disable=SC2086
run 0 $small -p filter=cosine -o a.exr "$cornell"
expect_text err "psplat: warning: plugin $PWD/front/filter/cosine.so is passed over: it is no shared object"
run 0 plugins filter
expect_text out "plugin $PWD/front/filter/cosine.so is passed over: it is no shared object"
cp back/filter/cosine.so front/filter/cosine.so
# shellcheck disable=SC2086
run 0 $small -p filter=cosine -o a.exr "$cornell"
expect_text err "psplat: warning: plugin $PWD/front/filter/cosine.so hides $PWD/back/filter/cosine.so"
# shellcheck disable=SC2086
run 2 $small -p filter=cosine --layers error -o b.exr "$cornell"
expect_text err "psplat: warning: plugin $PWD/front/filter/cosine.so hides $PWD/back/filter/cosine.so"
expect_text err "psplat: error: --layers: denoiser 'none' does not estimate its error"
run 0 plugins filter
expect_text out "plugin $PWD/front/filter/cosine.so hides $PWD/back/filter/cosine.so"
rm front/filter/cosine.so
# shellcheck disable=SC2086
run 0 $small -p filter=cosine -o a.exr "$cornell"
expect_no_text err warning

finish
