# Strategies: how they are listed, found, and laid over what a scene says.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

# --- lists ---

kinds="injection stratification visibility filter estimator normalization denoiser bloom tonemap"
run 0 plugins
expect_empty err
cp out all
[ "$(sed -n 's/^\([a-z]*\) .*(default: .*/\1/p' all | tr '\n' ' ')" = "$kinds " ] ||
    fail "kinds are missing, or not in the order of the pipeline"
expect_no_text all "can't be used"
for kind in $kinds; do
    run 0 plugins $kind
    while read -r line; do
        expect_text all "$line"
    done <out
    sed '1d' out | sort -c || fail "the list of $kind is not sorted"
    default=$(sed -n '1s/.*(default: \(.*\))$/\1/p' out)
    expect_match out "^  $default +[a-zA-Z]"
    # Every strategy can be described by the name that the list gives.
    for name in $(sed '1d' out | awk '{ print $1 }'); do
        run 0 plugins "$kind=$name"
        expect_match out "^$kind=$name, version [0-9]+"
        expect_match out "^after: [A-Za-z]"
        expect_match out '^(no parameters|parameters:|for experts)'
    done
done
run 0 plugins visibility=shadowmap filter
expect_text out "visibility=shadowmap, version"
expect_text out "filter          radial weight"
run 0 plugins visibility=shadowmap
expect_match out '^  resolution$'
! grep -q "^  step_back$" out || fail "a parameter for experts is listed"
expect_text out "for experts, shown by --expert: bandwidth_scale, depth, step_back, max_merge_scale, boundary_correction, bias"
run 0 plugins --expert visibility=shadowmap
expect_match out '^parameters for experts:$'
expect_match out '^  step_back$'
expect_no_text out "shown by --expert"
run 0 plugins filter=cone
expect_no_text out expert
run 0 plugins injection=photon
expect_text out "light paths in each pass"
expect_match out '^      integer 1\.\..*, in paths; default: 25000, by quality$'
run 2 plugins filter=nope
expect_text err "no filter 'nope' (there are: box,"
run 2 plugins filter=
expect_match err "^psplat: error: no filter ''"

# --- a name that is not there ---

mkdir -p mine/filter other "with space/filter"
export PSPLAT_PLUGIN_PATH="$PWD/mine:$PWD/other:$PWD/with space"
echo text >mine/filter/wrong.so
run 2 $small -p filter=wrong "$cornell"
expect_text err "psplat: error: no filter 'wrong' (there are: box, "
expect_text err "; tried $PWD/mine/filter/wrong.so: it is no shared object"
expect_text err "; tried $PWD/other/filter/wrong.so: no such file"
expect_text err "; tried $PWD/with space/filter/wrong.so: no such file"
is_on PSPLAT_STATIC_PLUGINS || expect_match err 'tried [^;]*psplat/plugins-1/filter/wrong\.so: no such file$'
[ ! -e cornell.exr ] || fail "a picture in spite of the error"
run 0 plugins filter
expect_match out "^  wrong +can't be used; tried "
expect_text out "it is no shared object"
expect_match out "^  box "
unset PSPLAT_PLUGIN_PATH

# All paths are listed, however long they are.
long=$PWD/$(printf '%0200d' 1)
last="a long PSPLAT_PLUGIN_PATH"
PSPLAT_PLUGIN_PATH=$long/a:$long/b:$long/c:$long/d:$long/e "$PSPLAT" check -p filter=nope "$cornell" >out 2>err
check_status $? 2
for folder in a b c d e; do
    expect_text err "tried $long/$folder/filter/nope.so: no such file"
done

for name in Box ../filter/box box.so 'b ox' é; do
    run 2 $small -p "filter=$name" "$cornell"
    expect_match err '^psplat: error: '
done
run 2 $small -p filter=./box.so "$cornell"
expect_text err "filter plugin ./box.so: no such file"

# --- parameters that are wrong ---

run 2 $small -p visibility=shadowmap:resolutoin=4 "$cornell"
expect_text err "psplat: error: unknown parameter 'resolutoin' of visibility shadowmap; did you mean 'resolution'?"
run 2 $small -p filter=gaussian:zzzzzz=4 "$cornell"
expect_text err "unknown parameter 'zzzzzz' of filter gaussian"
expect_no_text err "did you mean"
run 2 $small -p filter=gaussian:sigma=wide "$cornell"
expect_text err "filter gaussian: sigma: expected number 0.05..10, got 'wide'"
run 2 $small -p filter=gaussian:sigma=11 "$cornell"
expect_text err "sigma: expected number 0.05..10, got '11'"
run 2 $small -p filter=gaussian:sigma= "$cornell"
expect_text err "got ''"
run 2 $small -p injection=photon:count=1.5 "$cornell"
expect_text err "count: expected integer"
run 2 $small -p denoiser=gaussian:size=4x4 "$cornell"
expect_text err "size: expected 3x3 | 5x5 | 7x7 | 9x9, got '4x4'"
run 2 $small -p visibility=shadowmap:radius=0 "$cornell"
expect_text err "radius: expected auto | number > 0, got '0'"
run 2 $small -p filter=gaussian:sigma=1,sigma=2 "$cornell"
expect_text err "--plugin filter: parameter 'sigma' is given twice"
run 2 $small -p filter=gaussian:sigma "$cornell"
expect_text err "expected KEY=VALUE, got 'sigma'"
run 2 $small -p filter=gaussian: "$cornell"
expect_text err "expected KEY=VALUE, got ''"
run 2 $small -p filter=gaussian:sigma=1, "$cornell"
expect_text err "expected KEY=VALUE, got ''"
run 2 $small -p filter=gaussian:=1 "$cornell"
expect_text err "expected KEY=VALUE, got '=1'"
run 2 $small -p filter= "$cornell"
expect_text err "expected NAME[:KEY=VALUE,...]"
run 2 $small -p filter=:sigma=1 "$cornell"
expect_text err "expected NAME[:KEY=VALUE,...]"
# Several problems come in one go.
run 2 $small -p filter=gaussian:sigma=0 -p visibility=shadowmap:bais=1 -p denoiser=nope "$cornell"
expect_text err "sigma: expected"
expect_text err "did you mean 'bias'?"
expect_text err "no denoiser 'nope'"

# --- how choices are laid over each other ---

# chosen KIND CHOICE WORD...: a render with these options used that.
chosen() {
    kind=$1 choice=$2
    shift 2
    run 0 -q --size 16x9 -p injection=photon:count=50 -o chosen.exr "$@"
    run 0 info chosen.exr
    [ "$(sed -n "s/^psplat\.$kind: //p" out)" = "$choice" ] ||
        fail "$kind is '$(sed -n "s/^psplat\.$kind: //p" out)', expected '$choice'"
}
scene=merge.psd
sed '/^render:/,$d' "$cornell" >$scene
cat >>$scene <<'END'
render:
  visibility: {shadowmap: {radius: =10*3, resolution: 4}}
  filter: {gaussian: {sigma: 0.7}}
  normalization: weight
END
shadowmap="bandwidth_scale=0.6,depth=auto,step_back=full,max_merge_scale=1.5,boundary_correction=yes"
# What the scene says.
chosen visibility "shadowmap:radius=30,$shadowmap,resolution=4,bias=slope" $scene
chosen filter "gaussian:sigma=0.7" $scene
chosen normalization "weight:exposure=auto" $scene
# The same strategy: the scene's other parameters stay.
chosen visibility "shadowmap:radius=20,$shadowmap,resolution=4,bias=slope" -p visibility=shadowmap:radius=20 $scene
chosen visibility "shadowmap:radius=30,$shadowmap,resolution=4,bias=2" -p visibility=shadowmap:bias=2 $scene
chosen visibility "shadowmap:radius=30,$shadowmap,resolution=4,bias=slope" -p visibility=shadowmap $scene
chosen normalization "weight:exposure=2" -p normalization=weight:exposure=2 $scene
# Another strategy: nothing of the scene's choice stays.
chosen visibility "none:radius=auto,bandwidth_scale=0.6,depth=auto,step_back=auto,max_merge_scale=1.5,boundary_correction=no" -p visibility=none $scene
chosen filter "box" -p filter=box $scene
# There and back again: the scene's parameters are gone.
chosen filter "gaussian:sigma=0.5" -p filter=box -p filter=gaussian $scene
# Several options of one kind add up, and the last word counts.
chosen visibility "shadowmap:radius=1,$shadowmap,resolution=2,bias=3" \
    -p visibility=shadowmap:radius=9,bias=3 -p visibility=shadowmap:radius=1,resolution=2 $scene
# Where the scene says nothing, the default is laid over.
chosen denoiser "none" -p denoiser=none $scene
chosen denoiser "gaussian:size=7x7" -p denoiser=gaussian:size=7x7 $scene
chosen injection "photon:count=50,roulette=3,split=auto,caustics=8" -p injection=photon:roulette=3 $scene

# --- each strategy makes another picture than the default ---

run 0 -q $small -o default.exr "$cornell"
for choice in filter=box filter=tent filter=gaussian:sigma=0.2 filter=cone filter=cone:k=9 \
    filter=epanechnikov visibility=none \
    visibility=shadowmap:resolution=4 visibility=shadowmap:radius=60 visibility=shadowmap:step_back=auto \
    visibility=shadowmap:step_back=15,bias=5 visibility=shadowmap:bandwidth_scale=0 visibility=shadowmap:depth=1 \
    estimator=pathtrace estimator=bdpt estimator=bdpt:strategies=camera estimator=bdpt:strategies=light estimator=photonmap estimator=sppm:neighbours=20 estimator=final_gather estimator=vpl estimator=lightcuts estimator=lightcuts:error=0.5 estimator=irradiance_cache:samples=16 estimator=irradiance_cache:spacing=0.3 estimator=radiosity:epsilon=1e-3 estimator=radiosity:epsilon=1e-3,reconstruction=elements estimator=lpv estimator=lpv:cells=8,cascades=1 estimator=lpv:steps=8 estimator=voxel_cone:resolution=64 estimator=voxel_cone:resolution=32,cones=5 estimator=voxel_cone:resolution=64,turn=pass estimator=ambient estimator=ssao estimator=hbao estimator=hbao:cosine=no estimator=vpl:visibility=rays estimator=vpl:visibility=none estimator=vpl:compensation=0 estimator=gather \
    normalization=weight normalization=intensity:exposure=9 denoiser=gaussian \
    denoiser=bilateral denoiser=bilateral:normal=1,sigma=9 denoiser=regression denoiser=regression:distance=9 injection=photon:roulette=1 injection=rsm; do
    run 0 -q $small -p $choice -o other.exr "$cornell"
    expect_different other.exr default.exr
done
run 2 -q $small -p denoiser=bilateral:size=8 -o no.exr "$cornell"
expect_text err "denoiser bilateral: size must be odd, got 8"

finish
