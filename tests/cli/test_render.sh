# Rendering: which files appear, under which names, and what does and does not change them.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

# --- names of the output ---

# in_new WORD...: runs psplat in an empty folder `new`, with the scene on standard input.
in_new() {
    last="psplat $*"
    rm -rf new && mkdir new
    # shellcheck disable=SC2086
    (cd new && exec "$PSPLAT" $small "$@" >../out 2>../err <"$cornell")
    check_status $? 0
}

in_new "$cornell"
expect_files cornell.exr cornell.png
expect_picture new/cornell.exr new/cornell.png
expect_empty out
expect_text err "psplat: wrote cornell.exr"
expect_text err "psplat: wrote cornell.png"
mv new/cornell.exr reference.exr
mv new/cornell.png reference.png
in_new -
expect_files stdin.exr stdin.png
cp "$cornell" scene.txt
in_new ../scene.txt
expect_files scene.txt.exr scene.txt.png
cp "$cornell" new/-x.psd
last="a scene's name that looks like an option"
# shellcheck disable=SC2086
(cd new && rm -f scene.* && exec "$PSPLAT" render $small -- -x.psd >../out 2>../err)
check_status $? 0
expect_files -x.psd -x.exr -x.png

# --- --output ---

rm -rf new && mkdir new
run 0 $small -o new/a.exr "$cornell"
expect_files a.exr
expect_same new/a.exr reference.exr
run 0 render $small -o new/b.exr --output new/c.png --output=new/d.exr -onew/e.png "$cornell"
expect_files a.exr b.exr c.png d.exr e.png
expect_same new/b.exr reference.exr
expect_same new/d.exr reference.exr
expect_same new/c.png reference.png
expect_same new/e.png reference.png

# Without layers the film keeps no surfaces, unless a denoiser asks for them.
for denoiser in none bilateral regression; do
    run 0 $small --plugin denoiser=$denoiser -o new/with.exr -o new/with.png "$cornell"
    run 0 $small --plugin denoiser=$denoiser -o new/alone.png "$cornell"
    expect_same new/alone.png new/with.png
done

# A picture that is there is replaced, also behind a link; a device is written to.
echo old >new/a.exr
ln -s a.exr new/link.exr
ln -s /dev/null new/null.png
run 0 $small -o new/link.exr -o new/null.png "$cornell"
[ -L new/link.exr ] && [ -L new/null.png ] || fail "a link was replaced"
expect_same new/a.exr reference.exr

# As many files as one likes.
set --
i=0
while [ $i -lt 40 ]; do
    set -- "$@" -o "new/n$i.exr"
    i=$((i + 1))
done
run 0 $small "$@" "$cornell"
expect_picture new/n0.exr new/n39.exr

# --- options may stand anywhere, and the last of several counts ---

run 0 "$cornell" $small --seed 3 --seed 0 -o again.exr
expect_same again.exr reference.exr

# --- what changes the picture, and what only a part of it ---

run 0 $small --seed 7 -o seed.exr -o seed.png "$cornell"
expect_different seed.exr reference.exr
expect_different seed.png reference.png
run 0 $small --passes 3 -o passes.exr "$cornell"
expect_different passes.exr reference.exr
run 0 info passes.exr
expect_text out "psplat.passes: 3"
run 0 --size 20x30 --plugin injection=photon:count=500 -o size.exr "$cornell"
run 0 info size.exr
expect_text out "size.exr: 20x30"
run 0 $small --exposure 2 -o bright.exr -o bright.png "$cornell"
expect_same_pixels bright.exr reference.exr
expect_different bright.png reference.png
run 0 $small --exposure -0.5 -o dark.exr -o dark.png "$cornell"
expect_same_pixels dark.exr reference.exr
expect_different dark.png reference.png
expect_different dark.png bright.png

# --layers takes channels out of the EXR, and changes none.
channels() { sed -n 's/^channels: //p' out; }
run 0 info reference.exr
names=$(channels | tr ' ' '\n' | sed '/^[RGB]$/d; s/\..*//' | sort -u)
run 0 $small --layers all -o layers.exr -o layers.png "$cornell"
expect_same layers.exr reference.exr
run 0 $small --layers none -o layers.exr -o layers.png "$cornell"
expect_same layers.png reference.png
run 0 info layers.exr
[ "$(channels)" = "B G R" ] || fail "--layers none: $(channels)"
run 0 compare layers.exr reference.exr --fail 'rel_rmse>0'
run 0 $small --layers Z,indirect,N -o layers.exr "$cornell"
run 0 info layers.exr
[ "$(channels)" = "B G N.X N.Y N.Z R Z indirect.B indirect.G indirect.R" ] || fail "--layers: $(channels)"
run 0 compare layers.exr reference.exr --layer indirect --fail 'rel_rmse>0'
for name in $names; do
    run 0 $small --layers "$name" -o layers.exr "$cornell"
    run 0 info layers.exr
    [ "$(channels | tr ' ' '\n' | sed '/^[RGB]$/d; s/\..*//' | sort -u)" = "$name" ] || fail "--layers $name: $(channels)"
done
run 0 $small --layers error -p denoiser=regression -o layers.exr "$cornell"
run 0 info layers.exr
[ "$(channels)" = "B G R error" ] || fail "--layers error: $(channels)"
run 2 $small --layers Z,error -p denoiser=bilateral -o layers.exr "$cornell"
expect_text err "denoiser 'bilateral' does not estimate its error; denoiser=regression does"
run 2 --layers nothing "$cornell"
for name in $names; do
    expect_match err "expected .* $name[, ]"
done
for wrong in "" , N, ,N N,,Z indirect.R R "N Z" nothing; do
    run 2 --layers "$wrong" "$cornell"
    expect_text err "--layers: expected none, or all and names among"
    expect_text err "got '$wrong'"
done

# --compression packs the same samples otherwise.
for name in zip zips rle none; do
    run 0 $small --compression $name -o packed-$name.exr "$cornell"
    run 0 compare packed-$name.exr reference.exr --fail 'rel_rmse>0'
done
expect_same packed-zip.exr reference.exr
expect_different packed-zips.exr packed-zip.exr
[ "$(wc -c <packed-none.exr)" -gt "$(wc -c <packed-rle.exr)" ] || fail "--compression none packs"
[ "$(wc -c <packed-rle.exr)" -gt "$(wc -c <packed-zip.exr)" ] || fail "--compression rle deflates"
for wrong in "" piz ZIP "zip,rle"; do
    run 2 --compression "$wrong" "$cornell"
    expect_text err "--compression: expected one of zip, zips, rle, none, got '$wrong'"
done

# The command line goes before the scene's own size, passes, seed and exposure.
sed 's/^image:.*/image: {width: 48, height: 27, exposure: 2}/
     s/^render:.*/&\n  passes: 3\n  seed: 7/' "$cornell" >own.psd
few="--plugin injection=photon:count=500"
run 0 $few -o own.exr -o own.png own.psd
run 0 info own.exr
expect_text out "own.exr: 48x27"
expect_text out "psplat.seed: 7"
expect_text out "psplat.passes: 3"
expect_different own.exr reference.exr
run 0 $few --seed 0 --passes 1 --exposure 0 -o over.exr -o over.png own.psd
run 0 info over.exr
expect_text out "psplat.seed: 0"
expect_text out "psplat.passes: 1"
run 0 $few --seed 0 --passes 1 --exposure 2 -o over2.png own.psd
expect_different over2.png over.png
run 0 $few --seed 0 --passes 1 -o over3.png own.psd
expect_same over3.png over2.png

# --- --quiet ---

run 0 --quiet $small -o quiet.exr "$cornell"
expect_empty out
expect_empty err
expect_same quiet.exr reference.exr
run 0 -q $small -o quiet.exr "$cornell"
expect_empty err
run 2 -q --size 0x1 "$cornell"
expect_text err "psplat: error: --size"

# --- --stats ---

run 0 $small --passes 2 --stats stats.json -o stats.exr "$cornell"
for key in seconds counters bytes load scene build gbuffer direct inject stratify place estimate film resolve \
    normalize maps bin splat write total "photons injected" photons passes \
    "pixels without weight" splats "map rays" "pixel-splat tests" \
    "pixel-splat tests with weight" "ray tracer" G-buffer; do
    expect_text stats.json "\"$key\":"
done
expect_match stats.json '"passes": 2,?$'

# Memory is what there is at a time, not the sum over passes.
for passes in 1 3; do
    run 0 -q --size 48x27 --bounces all --passes $passes --stats passes.json -o passes.exr "$cornell"
    grep '"splatted pixels"' passes.json >pixels$passes || fail "no splatted pixels in $passes passes"
done
cmp -s pixels1 pixels3 || fail "splatted pixels grow with passes: $(cat pixels1 pixels3)"

# --- --quality ---

for quality in draft normal high final; do
    case $quality in
    draft) made='6250 2 1' ;;
    normal) made='25000 8 1' ;;
    high) made='25000 8 4' ;;
    final) made='100000 32 16' ;;
    esac
    # shellcheck disable=SC2086 # three words
    set -- $made
    run 0 -q --size 8x4 --quality $quality -o quality.exr "$cornell"
    run 0 info quality.exr
    expect_text out "psplat.injection: photon:count=$1,"
    expect_text out "psplat.estimator: gather:samples=$2,"
    expect_text out "psplat.denoiser: regression:"
    expect_text out "psplat.passes: $3"
done
run 0 -q --size 8x4 --set render.quality=draft -p injection=photon:count=7 --passes 3 -o quality.exr "$cornell"
run 0 info quality.exr
expect_text out "psplat.injection: photon:count=7,"
expect_text out "psplat.estimator: gather:samples=2,"
expect_text out "psplat.passes: 3"
run 2 -q --quality best "$cornell"
expect_text err "psplat: error: --quality: expected draft | normal | high | final, got 'best'"

# --- --preview: the options that psplat(1) lists, and before them what else is given ---

preview_options() {
    sed -n '/^\.It Fl Fl preview$/,/^\.Ed$/{/^--/p}' "$PSPLAT_SOURCE/man/psplat.1"
}
[ "$(preview_options | wc -l)" -ge 5 ] || fail "psplat(1) does not list what --preview stands for"
run 0 --preview -o preview.exr "$cornell"
run 0 info preview.exr
expect_text out "640x360"
# shellcheck disable=SC2046
run 0 $(preview_options) --size 640x360 -o listed.exr "$cornell"
expect_same_pixels preview.exr listed.exr
run 0 --preview --set image.width=90 --set image.height=900 -o tall.exr "$cornell"
run 0 info tall.exr
expect_text out "36x360"
run 0 --preview $small -p injection=photon:count=70 --passes 2 -o other.exr "$cornell"
run 0 info other.exr
expect_text out "photon:count=70,roulette=2"
expect_text out "psplat.passes: 2"
expect_no_text out "640x360"

# Many lights, of which pixels ask some, have nothing to join.
run 0 -q --preview --size 48x27 -o many.exr "$PSPLAT_SOURCE/scenes/lanterns.psd"
expect_empty err

# Pixels that no light reached are told of where there are any, with the same number.
run 0 --size 48x27 -p injection=photon:count=8 -p estimator=splat --stats dark.json -o dark.exr "$cornell"
dark=$(sed -n 's/.*"pixels without weight": \([0-9]*\).*/\1/p' dark.json)
[ "${dark:-0}" -gt 100 ] || fail "$dark pixels without weight of 8 photons"
expect_match err "^psplat: no indirect light reached $dark pixels\$"
run 0 --size 48x27 -p estimator=ambient --stats lit.json -o lit.exr "$cornell"
expect_text lit.json '"pixels without weight": 0'
expect_no_text err "no indirect light reached"

# Valid JSON, as far as it has objects, texts and numbers: what is whole is replaced until one value is
# left.
is_json() {
    tr -d ' \n' <"$1" | sed 's/"[A-Za-z0-9 _-]*"/S/g
        s/:-\{0,1\}[0-9][0-9]*\(\.[0-9][0-9]*\)\{0,1\}\([eE][-+]\{0,1\}[0-9][0-9]*\)\{0,1\}/:V/g
        s/:S/:V/g
        :again
        s/{}/V/g
        s/{S:V\(,S:V\)*}/V/g
        t again' | grep -qx V
}
is_json stats.json || { fail "stats.json is no JSON"; cat stats.json; }
echo '{"a": {"b": 1,}}' >bad.json
is_json bad.json && fail "the check for JSON takes anything"

finish
