# A plugin from outside: built against the installed headers, used by path and by name.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

command -v cmake >/dev/null || skip "no cmake"
cmake --install "$PSPLAT_BUILD" --prefix "$PWD/prefix" >install.log 2>&1 || {
    cat install.log
    fail "cmake --install"
    finish
}
[ -f prefix/include/psplat/plugin.h ] || fail "no header was installed"
mkdir -p mine/filter
compile_module prefix/include "$PSPLAT_SOURCE/plugins/examples/filter.c" "$PWD/mine/filter/cosine.so"
run 0 -q $small -p filter=box -o box.exr "$cornell"

# The shell's own way to make a picture's pixels comparable: PNG files differ by their texts, so they
# are left out. All text chunks stand before the pixels.
pixels() {
    offset=$(grep -abo IDAT "$1" | head -n 1 | cut -d : -f 1)
    tail -c "+$((offset + 1))" "$1"
}

# --- by path ---

run 0 -q $small -p "filter=$PWD/mine/filter/cosine.so" -o path.exr -o path.png "$cornell"
expect_different path.exr box.exr
run 0 -q $small -p filter=mine/filter/cosine.so:sharpness=3 -o sharp.exr -o sharp.png "$cornell"
run 0 info sharp.exr
expect_match out '^psplat\.filter: .*cosine.*:sharpness=3$'
run 0 -q $small -p filter=mine/filter/cosine.so:sharpness=0 -o flat.png "$cornell"
run 0 -q $small -p filter=box -o box.png "$cornell"
pixels flat.png >flat
pixels box.png >box
pixels path.png >path
pixels sharp.png >sharp
expect_same flat box
expect_different path box
expect_different sharp path
run 2 $small -p filter=mine/filter/cosine.so:sharpnes=1 "$cornell"
expect_text err "unknown parameter 'sharpnes' of filter cosine; did you mean 'sharpness'?"
run 2 $small -p filter=mine/filter/cosine.so:sharpness=17 "$cornell"
expect_text err "sharpness: expected number 0..16, got '17'"
run 0 plugins filter=mine/filter/cosine.so
expect_text out "filter=cosine, version 1.0"
expect_text out "number 0..16; default: 1"

# A scene can name the path too.
sed '/^render:/,$d' "$cornell" >scene.psd
cat >>scene.psd <<'END'
render:
  bounces: 1
  filter: {mine/filter/cosine.so: {sharpness: =1+2}}
END
run 0 -q $small -o scene.png scene.psd --allow-scene-plugins
pixels scene.png >scene
expect_same scene sharp
run 2 -q $small -p denoiser=./mine/filter/cosine.so "$cornell"
expect_match err '^psplat: error: denoiser plugin \./mine/filter/cosine\.so: it holds filter .cosine., no denoiser$'

# What info prints repeats a picture that a plugin's path made.
run 0 info sharp.exr
command=$(sed -n '/^to repeat it:$/{n;p;}' out)
last=$command
eval "\"\$PSPLAT\" ${command#psplat } -q -o repeated.exr" >out 2>err </dev/null
check_status $? 0
expect_same repeated.exr sharp.exr

# A row whose type is not that of its member does not compile.
for row in 'PS_INT(struct state, sharpness, "1", 0, 16, "", "")' 'PS_BOOL(struct state, sharpness, "yes", "")'; do
    sed "s/^    PS_NUMBER(.*/    $row,/" "$PSPLAT_SOURCE/plugins/examples/filter.c" >wrong.c
    last=$row
    ! "$CC" -std=c11 -fsyntax-only -I "$PSPLAT_SOURCE/include" wrong.c 2>compiler || fail "it compiles"
    grep -q "sharpness" wrong.c && grep -q "PS_TYPE_OF_MEMBER" compiler || fail "another error: $(cat compiler)"
done

# --- by name ---

run 2 $small -p filter=cosine "$cornell"
expect_text err "no filter 'cosine'"
PSPLAT_PLUGIN_PATH=$PWD/nowhere:$PWD/mine
export PSPLAT_PLUGIN_PATH
run 0 -q $small -p filter=cosine:sharpness=3 -o name.exr -o name.png "$cornell"
pixels name.png >name
expect_same name sharp
run 0 plugins filter
expect_match out '^  cosine +a raised cosine$'
expect_match out '^  box '
run 0 plugins filter=cosine
expect_text out "power of the raised cosine; 0: a box"
run 0 -q $small -p filter=cosine --threads 1 -o one.exr "$cornell"
run 0 -q $small -p filter=cosine --threads 3 -o three.exr "$cornell"
expect_same one.exr three.exr

# An earlier folder goes before psplat's own, which is passed over where a module is linked in.
cp mine/filter/cosine.so mine/filter/tent.so
run 0 plugins filter
expect_match out '^  tent +[a-z]'
if ! is_on PSPLAT_STATIC_PLUGINS; then
    sed 's/"cosine"/"tent"/' "$PSPLAT_SOURCE/plugins/examples/filter.c" >tent.c
    compile_module prefix/include tent.c "$PWD/mine/filter/tent.so"
    run 0 plugins filter=tent
    expect_text out "a raised cosine"
fi
rm -f mine/filter/tent.so
unset PSPLAT_PLUGIN_PATH

# --- the installed program, which finds its plugins wherever it lies ---

mv prefix moved
installed=moved/bin/psplat
last="$installed"
"$installed" plugins >out 2>err
check_status $? 0
expect_match out '^  photon '
expect_match out '^  gaussian '
# shellcheck disable=SC2086
"$installed" $small -p filter=box -q -o installed.exr "$cornell" >out 2>err
check_status $? 0
expect_same installed.exr box.exr
"$installed" check moved/share/psplat/scenes/cornell.psd >out 2>err
check_status $? 0
for page in man1/psplat.1 man5/psd.5 man7/psplat-plugins.7; do
    [ -f "moved/share/man/$page" ] || fail "no page $page"
done

# The flags that pkg-config gives are enough, and its folders hold the plugins and the examples.
if command -v pkg-config >/dev/null; then
    PKG_CONFIG_PATH=$(dirname "$(find "$PWD/moved" -name psplat.pc)")
    export PKG_CONFIG_PATH
    last="pkg-config psplat"
    folder=$(pkg-config --variable=plugindir psplat)
    is_on PSPLAT_STATIC_PLUGINS || [ -f "$folder/filter/box.so" ] || fail "no plugins in '$folder'"
    examples=$(pkg-config --variable=exampledir psplat)
    flags="$(pkg-config --variable=pluginflags psplat) $(pkg-config --cflags psplat)"
    is_on PSPLAT_SANITIZE && flags="$flags -fsanitize=address,undefined"
    for example in injection stratification visibility filter estimator normalization denoiser bloom tonemap; do
        last="$CC $flags $examples/$example.c"
        # shellcheck disable=SC2086
        "$CC" $flags -o "$example.so" "$examples/$example.c" -lm 2>compiler || fail "$(cat compiler)"
        run 0 plugins --test "./$example.so"
        expect_match out "^$example ./$example.so$"
        expect_text out "ok      makes it with three threads"
        # shellcheck disable=SC2086
        run 0 -q $small -p "$example=./$example.so" -o "$example.exr" "$cornell"
        expect_picture "$example.exr"
    done
    # The example of a visibility traces what psplat's own does, ray by ray.
    # shellcheck disable=SC2086
    run 0 -q $small -o usual.exr "$cornell"
    run 0 compare --fail 'rel_rmse>0.05' visibility.exr usual.exr
fi

# --- trials ---

run 0 plugins --test ./filter.so:sharpness=3 --test ./stratification.so:width=50
expect_text out "filter ./filter.so:sharpness=3"
expect_text out "ok      keeps the power"
run 1 plugins --test ./filter.so:sharpness=99
expect_text out "FAILED  makes a picture: filter cosine: sharpness: expected number 0..16, got '99'"
run 2 plugins --test filter.so
expect_text err "--test: expected the path of a file, with a slash"
run 2 plugins --test ./nowhere.so
expect_text err "plugin ./nowhere.so: no such file"
abusive=$PSPLAT_SOURCE/tests/plugins/abusive.c
bad="nan emit:infinite"
! is_on PSPLAT_SANITIZE || bad=nan # a trial takes half a minute
for what in $bad; do
    compile_module "$PSPLAT_SOURCE/include" "$abusive" "$PWD/abusive.so" "-DABUSE=\"$what\""
    run 1 plugins --test ./abusive.so
    expect_match out "FAILED +makes numbers"
done
compile_module "$PSPLAT_SOURCE/include" "$abusive" "$PWD/abusive.so" '-DABUSE="init:tile"'
run 1 plugins --test ./abusive.so
expect_text out "FAILED  makes a picture: estimator abusive: it called tile where that is not there"

finish
