# A part of the picture (--crop): rendered alone it is that part of the whole, bit for bit; the file says where it lies;
# memory is that of the part; and what cannot be had of a part is refused.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

glossy=$PSPLAT_SOURCE/scenes/cornell-glossy.psd
area=$PSPLAT_SOURCE/scenes/cornell-area.psd

# expect_part WHOLE PART LAYER...: the part's layers are the whole's. R: the picture itself.
expect_part() {
    whole=$1 part=$2
    shift 2
    for layer; do
        option="--layer $layer"
        [ "$layer" != R ] || option=
        # shellcheck disable=SC2086
        "$PSPLAT" compare "$whole" "$part" $option --metric max --fail 'max>0' >compared 2>&1 ||
            fail "$part is not its part of $whole in $layer: $(cat compared)"
    done
}

# --- every strategy ---

# Parts whose windows lack many of the picture's tiles; one begins in the middle of tiles.
every_part() {
    rm -f ./*.exr
    run 0 "$@" -o whole.exr "$glossy"
    for crop in 0,0,23,41 61,50,51,62; do
        run 0 "$@" --crop $crop --threads 2 -o part.exr "$glossy"
        expect_part whole.exr part.exr R indirect weight
    done
}

job="-q --size 112x112 --set render.aa_samples=2 -p injection=photon:count=1000 -p denoiser=none"
"$PSPLAT" plugins | awk '/^[a-z]/ { kind = $1 } /^  [a-z]/ { print kind "=" $1 }' >strategies
grep '^estimator=' strategies >estimators
[ -z "$PSPLAT_QUICK" ] || grep -E '^estimator=(bdpt|gather|photonmap)$' strategies >estimators
while read -r strategy; do
    case $strategy in
    estimator=bdpt | estimator=hbao | estimator=irradiance_cache | estimator=lpv | estimator=ssao)
        # shellcheck disable=SC2086
        run 2 $job -p "$strategy" --crop 0,0,8,8 -o part.exr "$glossy"
        expect_text err "psplat: error: --crop: estimator ${strategy#*=} does not say that it can render a part"
        continue
        ;;
    estimator=radiosity) choice=estimator=radiosity:epsilon=1e-2,samples=2 ;;
    estimator=lightcuts) choice=estimator=lightcuts:lights=100 ;;
    *) choice=$(small_choice "$strategy") ;;
    esac
    # shellcheck disable=SC2086
    every_part $job -p "$choice"
done <estimators

# What splats are made by, all of each kind in as few jobs as there are of the largest.
grep -E '^(injection|stratification|visibility|filter)=' strategies | awk -F= '
    { if (!($1 in count)) kinds[++kind_count] = $1; name[$1, count[$1]++] = $0; if (count[$1] > most) most = count[$1] }
    END { for (i = 0; i < most; i++) { for (k = 1; k <= kind_count; k++) printf "%s ", name[kinds[k], i % count[kinds[k]]]; print "" } }
' >sets
[ -z "$PSPLAT_QUICK" ] || : >sets
while read -r set; do
    choices=
    for strategy in $set; do
        choices="$choices -p $(small_choice "$strategy")"
    done
    # shellcheck disable=SC2086
    every_part $job -p estimator=splat:interleave=3 $choices
done <sets

# --- four uneven parts, with smooth edges and noise of all kinds ---

parts="0,0,51,67 51,0,99,67 0,67,51,45 51,67,99,45"
[ -z "$PSPLAT_QUICK" ] || parts=51,67,99,45
# reassemble SCENE OPTION...
reassemble() {
    scene=$1
    shift
    rm -f ./*.exr
    run 0 -q --size 150x112 -p denoiser=none "$@" -o whole.exr "$scene"
    for crop in $parts; do
        run 0 -q --size 150x112 -p denoiser=none "$@" --crop $crop --threads $((${crop%%,*} % 2 + 1)) -o part.exr "$scene"
        expect_part whole.exr part.exr R direct indirect albedo N P weight
    done
}

few="-p injection=photon:count=1500"
# shellcheck disable=SC2086
{
    reassemble "$glossy" $few -p estimator=splat:interleave=8 --passes 2
    reassemble "$area" $few -p estimator=splat:interleave=7 --set render.discontinuity_buffer=yes --set render.aa_samples=2
    reassemble "$area" $few -p estimator=splat:interleave=4,gather_rays=400 --direct shadowmap --set render.aa_samples=2
    reassemble "$area" $few -p estimator=gather:samples=8 --set render.aa_samples=2 --passes 1:2
}
# The size of the whole picture chooses the interleaving.
# shellcheck disable=SC2086
{
    run 0 -q --size 320x304 $few --set render.aa_samples=1 -p estimator=splat -p denoiser=none -o whole.exr "$cornell"
    run 0 -q --size 320x304 $few --set render.aa_samples=1 -p estimator=splat -p denoiser=none --crop 201,103,14,25 -o part.exr "$cornell"
}
expect_part whole.exr part.exr R indirect weight
# A single tile, whose pixels all ask its neighbours; those theirs.
# shellcheck disable=SC2086
{
    run 0 -q --size 144x144 $few -p estimator=splat:interleave=8 -p denoiser=none -o whole.exr "$area"
    run 0 -q --size 144x144 $few -p estimator=splat:interleave=8 -p denoiser=none --crop 32,64,16,16 -o part.exr "$area"
}
expect_part whole.exr part.exr R indirect weight
# Of a picture so large that some of its tiles stand for it.
large="-q --size 1504x1504 $few -p estimator=gather:samples=8,paths=0 -p denoiser=none"
# shellcheck disable=SC2086
{
    run 0 $large --crop 901,900,47,48 -o whole.exr "$area"
    run 0 $large --crop 917,905,16,16 -o part.exr "$area"
}
expect_part whole.exr part.exr R indirect
run 0 -q --size 64x64 -p estimator=ambient -o whole.exr "$cornell" # nothing is infinitely far away
run 0 -q --size 64x64 -p estimator=ambient --crop 3,50,7,14 -o part.exr "$cornell"
expect_part whole.exr part.exr Z

# --- where it lies ---

run 0 -q $small --crop 5,9,17,3 -o part.exr -o part.png "$cornell"
run 0 info part.exr
expect_text out "part.exr: 17x3 at 5,9 of 48x27"
expect_text out "psplat.crop: 5,9,17,3"
expect_text out " --size 48x27 --crop 5,9,17,3 "
mv part.exr first.exr
sed -n 's/^psplat render/run 0 -q/p' out | sed 's/$/ -o part.exr/' >again
. ./again
expect_part first.exr part.exr R direct indirect weight
[ "$(od -An -tu1 -j16 -N8 part.png | tr -s ' ')" = " 0 0 0 17 0 0 0 3" ] || fail "the PNG is not 17x3"
# A part that is all of the picture is none: any estimator makes it, and films add up.
run 0 -q $small -p estimator=ssao --crop 0,0,48,27 -o all.exr "$cornell"
run 0 -q $small --crop 0,0,48,27 --passes 1:2 --checkpoint late.exr -o all.png "$cornell"
run 0 -q $small --passes 1 --checkpoint none.exr -o none.png "$cornell"
run 0 merge -q none.exr late.exr -o merged.exr
LC_ALL=C sed 's/psplat\.crop/psplat.else/' none.exr >untold.exr
run 0 merge -q untold.exr late.exr -o merged.exr
run 0 -q $small -o whole.exr "$cornell"
run 0 info whole.exr
expect_text out "whole.exr: 48x27"
expect_no_text out " at 0,0"

# Parts of one size are compared where they are of one place.
run 0 -q $small --crop 6,9,17,3 -o aside.exr "$cornell"
run 0 -q --size 17x3 -p injection=photon:count=500 -p estimator=splat -o tiny.exr "$cornell"
run 1 compare first.exr aside.exr
expect_text err "the parts lie at different places: 'first.exr' is at 5,9 of 48x27, 'aside.exr' at 6,9 of 48x27"
run 1 diff tiny.exr first.exr -o no.exr
expect_text err "'tiny.exr' is at 0,0 of 17x3, 'first.exr' at 5,9 of 48x27"
run 0 diff whole.exr first.exr -o difference.exr
run 0 info difference.exr
expect_text out "difference.exr: 17x3 at 5,9 of 48x27"

# --- films ---

job="-q --size 112x112 $few -p estimator=splat --crop 70,60,30,50"
rm -f ./*.exr
# shellcheck disable=SC2086
{
    run 0 -q --size 112x112 $few -p estimator=splat --passes 3 --checkpoint whole.exr -o whole.png "$glossy"
    run 0 $job --passes 3 --checkpoint all.exr -o all.png -p denoiser=none "$glossy"
    run 0 $job --passes 0:2 --checkpoint sum.exr "$glossy"
    run 0 $job --passes 2:3 --checkpoint late.exr "$glossy"
    run 0 -q --size 112x112 $few -p estimator=splat --crop 69,60,30,50 --passes 2:3 --checkpoint aside.exr "$glossy"
}
expect_part whole.exr all.exr sum.direct sum.indirect sum.weight sum.P sum.odd.indirect sum.reflected sum.half.reflected \
    sum.squares sum.gloss object.low material.low
run 0 merge -q late.exr sum.exr -o merged.exr
run 0 compare merged.exr all.exr --layer sum.indirect --metric max --fail 'max>0'
run 2 merge -q aside.exr sum.exr -o no.exr
expect_text err "can't put 'sum.exr' beside 'aside.exr': they have pixels in common"
# shellcheck disable=SC2086
run 0 $job --passes 3 --checkpoint sum.exr --resume -o resumed.exr -p denoiser=none "$glossy"
run 0 resolve -q merged.exr -p denoiser=none -o resolved.exr
expect_part resumed.exr resolved.exr R direct indirect
run 0 info resolved.exr
expect_text out "resolved.exr: 30x50 at 70,60 of 112x112"
# shellcheck disable=SC2086
run 2 -q --size 112x112 $few -p estimator=splat --crop 70,60,30,51 --passes 3 --checkpoint sum.exr --resume -o no.png "$glossy"
expect_text err "differs in the crop"

# --- parts side by side ---

# Films of parts make that of the whole, in whatever order, with passes apart as well; so does what is made of it.
# shellcheck disable=SC2086
for crop in 0,0,112,30 0,30,50,82 50,30,62,82; do
    run 0 -q --size 112x112 $few -p estimator=splat --crop $crop --passes 0:2 --checkpoint part-$crop-a.exr "$glossy"
    run 0 -q --size 112x112 $few -p estimator=splat --crop $crop --passes 2:3 --checkpoint part-$crop-b.exr "$glossy"
done
run 0 merge part-50,30,62,82-b.exr part-*-a.exr part-0,*-b.exr -o joined.exr
expect_text err "psplat: wrote joined.exr: 3 passes"
expect_part whole.exr joined.exr sum.direct sum.indirect sum.weight sum.P sum.odd.indirect sum.reflected sum.half.reflected \
    sum.squares sum.gloss object.low material.low
run 0 resolve -q whole.exr -o whole-picture.exr
run 0 resolve -q joined.exr -o joined-picture.exr
expect_same_pixels whole-picture.exr joined-picture.exr
expect_empty err
run 0 info joined.exr
expect_text out "psplat.crop: none"

# Parts that make a larger one; and what makes none.
run 0 merge -q part-0,30,50,82-?.exr part-50,30,62,82-?.exr -o below.exr
run 0 info below.exr
expect_text out "psplat.crop: 0,30,112,82"
expect_part whole.exr below.exr sum.direct sum.indirect
run 2 merge -q part-0,0,112,30-a.exr part-50,30,62,82-a.exr -o no.exr
expect_text err "the films leave 4100 pixels of the rectangle around them, 0,0,112,112, without light"
run 2 merge -q part-0,0,112,30-a.exr below.exr -o no.exr
expect_text err "can't put 'below.exr' beside 'part-0,0,112,30-a.exr': they hold different passes"
run 2 merge -q below.exr whole.exr -o no.exr
expect_text err "can't put 'whole.exr' beside 'below.exr': they have pixels in common"
[ ! -e no.exr ] || fail "no.exr was written"

# --- what goes by other pixels is said ---

run 0 -q $small --crop 5,9,17,3 -p denoiser=gaussian -p normalization=weight -p tonemap=clip:exposure=auto -o part.png "$cornell"
for strategy in "denoiser gaussian" "normalization weight" "tonemap clip"; do
    expect_text err "psplat: warning: --crop: $strategy may go by other pixels"
done
run 0 -q $small --crop 5,9,17,3 -o part.png "$cornell"
expect_empty err
run 0 -q $small --crop 5,9,17,3 --error 90 --passes 2 -o part.png "$cornell"
expect_text err "psplat: warning: --crop: --error sees this part alone"

# --- memory ---

huge="-q --size 60000x60000 -p estimator=ambient -p denoiser=none --memory-limit 1G"
# shellcheck disable=SC2086
{
    run 1 $huge -o no.png "$cornell"
    expect_text err "a picture of 60000x60000 pixels takes"
    run 0 $huge --crop 30000,59990,40,10 --stats stats.json -o part.exr "$cornell"
    run 1 $huge --crop 0,0,30000,30000 -o no.png "$cornell"
    expect_text err "a picture of 30000x30000 pixels takes"
}
expect_match stats.json '"G-buffer": [0-9]{6},?$'

# --- errors ---

for crop in 0,0,49,1 48,0,1,1 0,26,1,2 40,20,9,7; do
    run 2 -q $small --crop $crop -o no.png "$cornell"
    expect_text err "psplat: error: --crop: $crop reaches out of the picture of 48x27 pixels"
done
run 2 -q $small --crop 4,4,0,3 -o no.png "$cornell"
expect_text err "psplat: error: --crop: a part has at least one pixel, '4,4,0,3' has none"
for crop in 1,2,3 1,2,3,4,5 1,2,3,x -1,0,4,4 0,0,1.5,2; do
    run 2 -q $small --crop $crop -o no.png "$cornell"
    expect_text err "psplat: error: --crop: expected X,Y,W,H in whole pixels, got '$crop'"
done
[ ! -e no.png ] || fail "a picture was written in spite of an error"

finish
