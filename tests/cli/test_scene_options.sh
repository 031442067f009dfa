# --param, --set, --camera and check --parameters; and scenes of several files.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

mkdir -p scenes/lib elsewhere
cat >scenes/table.psd <<'END'
psd: 1
include: lib/paint.psd
parameters:
  height: {default: 1, help: "height of the table, m"}
  legs: {type: number}
  paint: {default: white}
camera: {location: [0, 1, 5], look_at: [0, 0.5, 0]}
image: {width: 20, height: 10}
lights:
  - point: {location: [0, 4, 3], intensity: 10}
objects:
  - for: i
    from: 1
    to: =legs
    do: {box: {corners: [[=i, 0, 0], [=i+0.5, =height, 1]], material: =paint}}
render: {injection: {photon: {count: 100}}}
END
printf 'psd: 1\nmaterials: {white: {diffuse: 0.8}, red: {diffuse: [0.8, 0, 0]}}\n' >scenes/lib/paint.psd

run 0 check --parameters scenes/table.psd "$cornell"
cat >expected <<END
scenes/table.psd:
  height
      height of the table, m
      number; default: 1
  legs
      number; required
  paint
      string; default: white
$cornell:
  no parameters
END
expect_same out expected
expect_empty err
run 2 check --parameters scenes/gone.psd
expect_text err "scenes/gone.psd: error: cannot open"

run 2 check scenes/table.psd
expect_text err "scenes/table.psd:5:3: error: parameter 'legs' has no default; give it with --param legs=NUMBER"
run 0 check scenes/table.psd --param legs=2
expect_empty err
run 2 check scenes/table.psd --param legs=2 --param hieght=2
expect_text err "--param:2:1: error: unknown parameter 'hieght'; did you mean 'height'?"
expect_text err "    2 | hieght=2"
expect_text err "      | ^~~~~~"
run 2 check scenes/table.psd --param legs=2 --set image.width=wide
expect_text err "--set:1:13: error: width in image: expected integer 1..65536, got 'wide'"
expect_text err "    1 | image.width=wide"
expect_text err "      |             ^~~~"
run 2 check scenes/table.psd --param legs=2 --set render.injection.photon.cuont=3
expect_text err "--set:1:25: error: unknown parameter 'cuont' of injection photon; did you mean 'count'?"
run 2 check --param legs=2
expect_text err "which scene?"
run 2 check --param legs scenes/table.psd
expect_text err "psplat: error: --param: expected NAME=VALUE, got 'legs'"
run 2 check scenes/table.psd --prarm legs=2
expect_text err "unknown option '--prarm'; did you mean '--param'?"

# The command of a picture repeats them, quotes and all.
run 0 -q --param legs=3 --param 'paint=red' --set 'lights.0.point.intensity=[9, 8, 7]' \
    --camera camera --set image.width=24 -o table.exr scenes/table.psd
run 0 info table.exr
expect_text out "table.exr: 24x10"
expect_text out "psplat render scenes/table.psd --param legs=3 --param paint=red --set 'lights.0.point.intensity=[9, 8, 7]' --set image.width=24 --camera camera --size 24x10"
command=$(sed -n '/^to repeat it:$/{n;p;}' out)
eval "\"\$PSPLAT\" ${command#psplat } -q -o repeated.exr" >out 2>err </dev/null
check_status $? 0
expect_same repeated.exr table.exr
run 0 -q --param legs=3 -o other.exr scenes/table.psd
expect_different other.exr table.exr

# The command line's own options come after --set.
run 0 -q --param legs=1 --set image.width=24 --size 12x6 -o small.exr scenes/table.psd
run 0 info small.exr
expect_text out "small.exr: 12x6"

# Cameras.
run 2 --camera camrea -o no.exr scenes/table.psd --param legs=1
expect_text err "psplat: error: --camera: the scene has no camera 'camrea'; did you mean 'camera'?"
run 2 check --camera top scenes/table.psd --param legs=1
expect_text err "psplat: error: --camera: the scene has no camera 'top'; it has camera"

cat >views.psd <<'END'
psd: 1
camera: {location: [0, 1, 5], look_at: [0, 0, 0]}
cameras: {top: {location: [0, 5, 1], look_at: [0, 0, 0]}, side: {location: [5, 1, 0], look_at: [0, 0, 0]}}
image: {width: 16, height: 9}
materials: {white: {diffuse: 0.8}}
lights: [{point: {location: [0, 4, 3], intensity: 10}}]
objects: [{sphere: {center: [0, 0, 0], radius: 1, material: white}}]
render: {injection: {photon: {count: 10}}}
END
run 0 -q -o front.exr views.psd
run 0 -q -o same.exr --camera camera views.psd
run 0 -q -o side.exr --camera side views.psd
expect_same_pixels front.exr same.exr
expect_different front.exr side.exr
sed -e '/^camera:/d' -e 's/^cameras: {top: {[^}]*}, side: /camera: /' -e 's/0, 0]}}$/0, 0]}/' views.psd >side.psd
run 0 -q -o alone.exr side.psd
expect_same_pixels side.exr alone.exr
run 2 --camera back -o no.exr views.psd
expect_text err "psplat: error: --camera: the scene has no camera 'back'; it has camera, top, side"

# Files are found from where they are named, wherever psplat runs.
printf 'psd: 1\nmaterials: {white: {diffus: 0.8}}\n' >scenes/lib/paint.psd
cd elsewhere || exit 1
run 2 check ../scenes/table.psd --param legs=1
expect_text err "In file included from ../scenes/table.psd:2:10:"
expect_text err "../scenes/lib/paint.psd:2:21: error: unknown key 'diffus' in material; did you mean 'diffuse'?"
expect_text err "    2 | materials: {white: {diffus: 0.8}}"
last="a scene on standard input that includes a file"
printf 'psd: 1\ninclude: gone.psd\n' | "$PSPLAT" check - >out 2>err
check_status $? 2
expect_text err "<stdin>:2:10: error: can't include 'gone.psd': cannot open: No such file or directory"
cd .. || exit 1

finish
