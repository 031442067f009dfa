# psplat info: what a picture says about itself, and that its command repeats it.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

# repeats PICTURE: runs the command that info prints; the new picture is the same to the last bit.
repeats() {
    run 0 info "$1"
    command=$(sed -n '/^to repeat it:$/{n;p;}' out)
    case $command in
    "psplat render "*) ;;
    *) fail "no command in what info prints: '$command'" ;;
    esac
    rm -f repeated.exr
    last=$command
    eval "\"\$PSPLAT\" ${command#psplat } -o repeated.exr" >out 2>err </dev/null
    check_status $? 0
    expect_same repeated.exr "$1"
}

run 0 $small -o plain.exr "$cornell"
repeats plain.exr

run 0 info plain.exr
expect_text out "plain.exr: 48x27"
for channel in R G B direct.R direct.G direct.B indirect.R indirect.G indirect.B albedo.R albedo.G \
    albedo.B N.X N.Y N.Z P.X P.Y P.Z Z weight; do
    expect_match out "^channels:.* $channel( |\$)"
done
expect_text out "psplat.version: $("$PSPLAT" --version | sed 's/^psplat //')"
expect_text out "psplat.scene: $cornell"
expect_text out "psplat.seed: 0"
expect_text out "psplat.passes: 1"
expect_text out "psplat.direct: rays"
expect_text out "psplat.injection: photon:count=500,roulette=2"
expect_text out "psplat.bounces: 1"
expect_text out "psplat.stratification: none"
expect_text out "psplat.visibility: shadowmap:radius=auto,bandwidth_scale=0.6,"
expect_text out "psplat.filter: gaussian:sigma=0.5"
expect_text out "psplat.estimator: splat"
expect_text out "psplat.normalization: density"
expect_text out "psplat.denoiser: none"

# Everything that can be set on the command line.
run 0 --size 30x20 --passes 2 --seed 9007199254740992 --threads 2 --batch 77 \
    -p injection=photon:count=300 --bounces all -p visibility=none:radius=12.345,step_back=full \
    -p filter=gaussian:sigma=0.33333333333333331 -p normalization=weight:exposure=0.1 \
    -p denoiser=gaussian:size=3x3 -o all.exr "$cornell"
repeats all.exr

# Shadows by maps: on the command line, in the scene, and a line that takes them back.
run 0 $small --direct shadowmap --direct-resolution 20 -o maps.exr "$cornell"
repeats maps.exr
run 0 info maps.exr
expect_text out "psplat.direct: shadowmap:resolution=20"
expect_different maps.exr plain.exr
sed 's/^render:.*/&\n  direct: shadowmap\n  direct_resolution: 20/' "$cornell" >maps.psd
run 0 $small -o scene-maps.exr maps.psd
repeats scene-maps.exr
expect_same_pixels scene-maps.exr maps.exr
run 0 $small --direct rays -o rays.exr maps.psd
repeats rays.exr
expect_same_pixels rays.exr plain.exr

# A scene whose name needs quotes, with settings of its own that no option has.
mkdir "it's a folder"
sed 's/^render:.*/&\n  indirect_exposure: 2\n  ambient: [0.1, 0.2, 0.3]\n  seed: 5/' "$cornell" \
    >"it's a folder/my \$scene.psd"
run 0 $small -o quoted.exr "it's a folder/my \$scene.psd"
repeats quoted.exr

# Several pictures; the attributes are in the PNG too.
run 0 info plain.exr all.exr
expect_text out "plain.exr: 48x27"
expect_text out "all.exr: 30x20"
run 0 $small -o text.png "$cornell"
grep -qa "psplat.injection" text.png || fail "the PNG has no attributes"

# What is no picture.
run 2 info
expect_text err "psplat: error: info: which picture?"
run 1 info missing.exr
expect_text err "missing.exr"
run 1 info "$cornell"
expect_text err "cornell.psd"
expect_match err '^psplat: error: '
run 1 info text.png
expect_text err "text.png"
: >empty.exr
run 1 info empty.exr
expect_text err "empty.exr"
run 1 info .
head -c 1000 plain.exr >cut.exr
run 1 info cut.exr
expect_text err "cut.exr"
# What came before the bad one was told.
run 1 info plain.exr empty.exr
expect_text out "plain.exr: 48x27"
run 2 info --size 1x1 plain.exr
expect_text err "unknown option '--size'"

finish
