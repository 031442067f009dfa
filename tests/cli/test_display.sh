# Bloom and tone map: what PNG files and the layer `display` show, and that nothing else changes with them.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

area=$PSPLAT_SOURCE/scenes/cornell-area.psd
job="-q --size 48x27 -p injection=photon:count=500 -p denoiser=none --set render.aa_samples=1 --exposure 0"

# pixels FILE.png: its chunk of pixels, in hexadecimal.
pixels() {
    od -An -v -tx1 "$1" | tr -d ' \n' | sed 's/.*49444154//'
}

# expect_same_shown A.png B.png
expect_same_shown() {
    pixels "$1" >a.pixels
    pixels "$2" >b.pixels
    cmp -s a.pixels b.pixels || fail "$1 and $2 differ"
}

# expect_other_shown A.png B.png
expect_other_shown() {
    pixels "$1" >a.pixels
    pixels "$2" >b.pixels
    ! cmp -s a.pixels b.pixels || fail "$1 and $2 show the same"
}

# --- layers of radiance stay, bit for bit ---

run 0 $job -o plain.exr -o plain.png "$area"
run 0 $job --exposure 1.5 -o bright.png "$area"
for choice in bloom=glare tonemap=clip tonemap=reinhard:exposure=auto tonemap=chroma:exposure=-1; do
    run 0 $job --exposure 1.5 -p $choice -o other.exr -o other.png "$area"
    expect_same_pixels plain.exr other.exr
    run 0 compare other.exr plain.exr --metric max --fail 'max>0'
    for layer in P weight; do
        run 0 compare other.exr plain.exr --layer $layer --metric max --fail 'max>0'
    done
    expect_other_shown bright.png other.png
done
run 0 info other.exr
expect_text out "psplat.tonemap: chroma:exposure=-1,shoulder=0.6"
expect_text out "psplat.bloom: none"

# --- the layer display: linear, of the PNG; only where it is asked for ---

run 0 info plain.exr
expect_no_text out "display"
run 0 $job -p bloom=glare --layers display -o shown.exr -o shown.png "$area"
run 0 info shown.exr
expect_text out "channels: B G R display.B display.G display.R"
run 0 $job -p bloom=glare --layers all,display -o all.exr "$area"
expect_same_pixels plain.exr all.exr
run 0 compare all.exr shown.exr --layer display --metric max --fail 'max>0'

# expect_view PICTURE.exr PICTURE.png OPTION...: psplat view makes the one of the other.
expect_view() {
    exr=$1 png=$2
    shift 2
    run 0 view "$exr" -o viewed.png "$@"
    expect_same_shown viewed.png "$png"
}
expect_view shown.exr shown.png --layer display
expect_view shown.exr shown.png -p bloom=glare
expect_view plain.exr plain.png

# --- exposure: --exposure and that of the tone map add up ---

run 0 $job --exposure 1.5 -o a.png "$area"
run 0 $job -p tonemap=filmic:exposure=1.5 -o b.png "$area"
run 0 $job -p tonemap=filmic:exposure=2.5 --exposure -1 -o c.png "$area"
expect_same_shown a.png b.png
expect_same_shown a.png c.png
# Also where the first is automatic.
run 0 $job -p tonemap=clip:exposure=auto -o a.png "$area"
run 0 $job -p tonemap=clip:exposure=auto --exposure -1 -o b.png "$area"
expect_other_shown a.png b.png

# --- films: no identity, another tone map without rendering ---

run 0 $job --passes 0:1 --checkpoint 0.exr -p tonemap=clip "$cornell"
run 0 $job --passes 1:2 --checkpoint 1.exr -p tonemap=chroma:exposure=1 -p bloom=glare "$cornell"
run 0 merge -q 0.exr 1.exr -o film.exr
run 0 $job --passes 2 -p tonemap=reinhard:white=2 -p bloom=glare:strength=0.2 -o whole.png -o whole.exr "$cornell"
run 0 resolve film.exr -q -p tonemap=reinhard:white=2 -p bloom=glare:strength=0.2 -o resolved.png -o resolved.exr
expect_same_shown whole.png resolved.png
expect_same_pixels whole.exr resolved.exr
run 0 resolve film.exr -q -o first.exr # as the first film's job was
run 0 info first.exr
expect_text out "psplat.tonemap: clip:exposure=0"

# Parameters that --plugin does not name are the film's.
run 0 resolve 1.exr -q -p tonemap=chroma:shoulder=0.5 --layers display -o kept.exr
run 0 info kept.exr
expect_text out "psplat.tonemap: chroma:exposure=1,shoulder=0.5"

# --- a scene chooses ---

sed '/^render:/,$d' "$cornell" >scene.psd
cat >>scene.psd <<'END'
render:
  bloom: {glare: {strength: 0.2}}
  tonemap: {chroma: {exposure: auto}}
END
run 0 $job -o scene.exr scene.psd
run 0 info scene.exr
expect_text out "psplat.bloom: glare:strength=0.2,radius=0.1,threshold=0"
expect_text out "psplat.tonemap: chroma:exposure=auto,shoulder=0.6"

# --- the default keeps bright walls from clipping ---

# whites CHOICE: how many values of the layer display are 1; and two of the header.
whites() {
    run 0 $job -p "$1" -o white.exr --layers display --compression none "$cornell"
    od -An -v -tx1 white.exr | tr -d ' \n' | grep -o 0000803f | wc -l
}
clipped=$(whites tonemap=clip)
[ "$clipped" -gt 50 ] || fail "only $clipped values clip"
[ "$(whites tonemap=filmic)" -eq 2 ] || fail "the default display clips $(whites tonemap=filmic) values"

# --- a stage that fails costs neither the picture nor its layers; what is shown is exposed and cut off ---

compile_module "$PSPLAT_SOURCE/include" "$PSPLAT_SOURCE/tests/plugins/failing_stage.c" "$PWD/failing.so"
run 0 $job -p tonemap=clip -o cut.png "$area"
for kind in bloom tonemap; do
    rm -f kept.*
    run 2 $job -p tonemap=reinhard -p bloom=glare:strength=0.5 -p $kind=./failing.so -o kept.exr -o kept.png "$area"
    expect_text err "psplat: warning: $kind failing failed; the picture is shown without bloom and tone map"
    expect_text err "psplat: error: $kind failing failed"
    expect_same_pixels kept.exr plain.exr
    expect_same_shown kept.png cut.png
    run 1 view plain.exr -p $kind=./failing.so -o no.png
    expect_text err "psplat: error: $kind failing failed"
done

# --- where nothing is shown, bloom and tone map do not run ---

run 0 $job -p tonemap=./failing.so -p bloom=./failing.so -o other.exr "$area"
expect_same_pixels plain.exr other.exr
run 0 $job --passes 1 --checkpoint named.exr -p bloom=./failing.so -o other.exr "$cornell"
run 0 resolve named.exr -q -o other.exr
run 2 resolve named.exr -q -o no.png
expect_text err "the film's job had bloom './failing.so', a plugin that it named by its path: say by --plugin bloom=..."
run 0 resolve named.exr -q -p bloom=none -o other.png
run 2 resolve named.exr -q -p bloom=./failing.so -o kept.png
expect_text err "bloom failing failed"

# --- light that no display shows ---

run 0 view plain.exr --exposure 130 -p bloom=glare:strength=1,radius=0.5 -o bright.png
expect_no_text err "no numbers"

# --- trials: a bloom that makes light, and a tone map that makes none of numbers ---

cat >doubling.c <<'END'
#include <psplat/plugin.h>

static ps_result show(const void *state, const ps_host *host, const ps_display_view *picture)
{
    (void)state;
    (void)host;
    for (size_t i = 0; i < (size_t)picture->width * picture->height; i++)
        picture->r[i] = FACTOR * picture->r[i];
    return PS_OK;
}

static const ps_bloom_vtable bloom = {.size = sizeof bloom, .spread = show};
static const ps_tonemap_vtable tonemap = {.size = sizeof tonemap, .map = show};
static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = KIND,
    .name = "doubling",
    .version = "1.0",
    .summary = "multiplies red",
    .paper = "none: a test",
    .vtable = &VTABLE,
};
PS_MODULE(test, doubling, &descriptor)
END
compile_module "$PSPLAT_SOURCE/include" doubling.c "$PWD/doubling.so" -DKIND=PS_BLOOM -DVTABLE=bloom -DFACTOR=2
run 1 plugins --test ./doubling.so
expect_text out "FAILED  makes no light: it shows more light than there was"
expect_text out "ok      makes it with three threads"
compile_module "$PSPLAT_SOURCE/include" doubling.c "$PWD/doubling.so" -DKIND=PS_TONEMAP -DVTABLE=tonemap -DFACTOR=NAN
run 1 plugins --test ./doubling.so
expect_match out "FAILED +makes numbers"
run 0 $job -p tonemap=./doubling.so -o other.png "$area"
expect_match err "tonemap doubling made [0-9]+ values of pixels that are no numbers or negative; they are 0"

# --- what is wrong ---

for wrong in "tonemap=clip:exposure=bright|exposure: expected auto | number -20..20, got 'bright'" \
    "tonemap=filmic:shoulder=1|shoulder: expected number 0..1 (1 excluded), got '1'" \
    "tonemap=reinhard:white=0|white: expected number >= 0.001, got '0'" \
    "bloom=glare:strength=2|strength: expected number 0..1, got '2'" \
    "bloom=glare:radius=0|radius: expected number 0..1 (0 excluded), got '0'" \
    "tonemap=nope|no tonemap 'nope'"; do
    for command in "$job -o no.png $cornell" "resolve film.exr -o no.png" "view plain.exr -o no.png"; do
        # shellcheck disable=SC2086
        run 2 $command -p "${wrong%%|*}"
        expect_text err "${wrong#*|}"
    done
done
run 2 $job --layers display,shown -o no.exr "$cornell"
expect_text err "--layers: expected none, or all and names among"
[ ! -e no.png ] && [ ! -e no.exr ] || fail "a picture in spite of the error"

finish
