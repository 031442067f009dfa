# psplat import: scenes of POV-Ray; beside POV-Ray's own pictures, where it is installed.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

head='#version 3.7;
global_settings { assumed_gamma 1.0 }
#default { finish { ambient 0 diffuse 0.7 } }
camera { location <0, 3, -7> look_at <0, 0.9, 0> angle 45 }'

# import NAME: makes NAME.psd of NAME.pov, without a warning, in a form that psplat reads.
import() {
    run 0 import "$1.pov"
    expect_empty err
    expect_empty out
    run 0 check "$1.psd"
    expect_no_text err warning
}

# --- files: includes, libraries, pictures ---

mkdir parts library
echo '#declare Red = rgb <1, 0, 0>; #include "radius.inc"' >parts/colors.inc
echo '#declare R = 0.5;' >library/radius.inc
printf '%s\n#include "parts/colors.inc"\nlight_source { y*5 1 fade_distance 1 fade_power 2 }\nsphere { 0, R pigment { Red } }\n' "$head" >files.pov
run 2 import files.pov
expect_text err "parts/colors.inc:1:31: error: #include: no readable file 'radius.inc'"
[ ! -e files.psd ] || fail "a scene with an error was written"
run 0 import --library library files.pov
expect_empty err
expect_text files.psd 'sphere: {center: [0, 0, 0], radius: 0.5'
expect_text files.psd 'diffuse: [0.7, 0, 0]'
run 2 import --library library --restrict parts files.pov
run 0 import --library library files.pov -o parts/other.psd
run 0 check parts/other.psd
echo '#include "self.pov"' >self.pov
run 2 import self.pov
expect_text err 'files and macros are in each other more than 200 deep'
printf '%s\nlight_source { y*5 1 fade_distance 1 fade_power 2 }\nbox { 0, 1 pigment { image_map { png "none.png" } } }\n' "$head" >picture.pov
run 0 import picture.pov
expect_text err 'picture.pov:6:22: warning: none.png: there is no readable file of that name'
run 2 import --library library

# --- what has no counterpart, once for each kind, where it is used ---

cat >said.pov <<END
$head
#declare Unused = blob { threshold 1 sphere { 0, 1, 1 } }
light_source { <4, 7, -5>, rgb 1 }
light_source { <4, 9, -5>, rgb 1 }
sphere { 0, 1 pigment { bozo } normal { bumps 1 } }
sphere { 1, 1 pigment { bozo } normal { bumps 1 } }
text { ttf "x.ttf" "a" 1, 0 }
END
run 0 import said.pov
expect_text err 'said.pov:6:1: warning: light_source without fade_power: fades by the square'
expect_text err "said.pov:8:25: warning: pattern 'bozo' becomes noise of two colours"
expect_text err 'said.pov:8:32: warning: normal and material_map are left out'
expect_text err 'said.pov:10:1: warning: text has no counterpart: left out'
[ "$(grep -c warning: err)" -eq 4 ] || fail "not 4 warnings: $(cat err)"
run 0 check said.psd

# --- a height field, pictures on u and v and planar, a sky ---

"$PSPLAT" --version >/dev/null
cat >grey.psd <<'END'
psd: 1
camera: {location: [0, 0, 3], look_at: [0, 0, 0]}
image: {width: 16, height: 16}
lights: [sky: {radiance: 1}]
materials: {a: {diffuse: 0.5}}
objects: [sphere: {center: [0, 0, 0], radius: 1, material: a}]
END
run 0 render -q -p estimator=splat grey.psd -o grey.exr -o grey.png
cat >pictures.pov <<END
$head
light_source { <4, 7, -5>, rgb 9 fade_distance 1 fade_power 2 }
height_field { png "grey.png" smooth translate <-0.5, 0, -0.5> scale 4 }
box { 0, 1 pigment { image_map { png "grey.png" interpolate 2 } scale 2 } }
mesh { triangle { 0, x, y uv_vectors <0, 0>, <1, 0>, <0, 1> } pigment { image_map { png "grey.png" once } } translate 2*x }
END
import pictures
expect_text pictures.psd 'height_field: {file: "grey.png", smooth: yes'
expect_text pictures.psd 'wrap: clamp, interpolate: nearest'
run 0 render -q -p estimator=splat --size 32x24 pictures.psd -o pictures.exr

# A picture that lies in a library is named from wherever the new scene is.
mkdir scenes
cp grey.png library/lent.png
printf '%s\nlight_source { y 9 fade_distance 1 fade_power 2 }\nbox { 0, 1 pigment { image_map { png "lent.png" interpolate 2 } } }\n' "$head" >scenes/lent.pov
run 0 import --library library scenes/lent.pov
expect_text scenes/lent.psd 'library/lent.png"'
run 0 check scenes/lent.psd
expect_no_text err warning

# --- what does not end ends; what is wrong says where ---

wrong() {
    printf '%s\n' "$1" >wrong.pov
    rm -f wrong.psd
    run 2 import wrong.pov
    expect_text err "$2"
    [ ! -e wrong.psd ] || fail "wrong.psd was written"
}
wrong '#while (1) #end' 'wrong.pov:1:12: error: more than 100000000 tokens were read'
wrong '#macro M(A) M(A + 1) #end M(0)' 'more than 200 deep'
wrong '#declare A = array[1000000000];' '1024 MiB, the most that is allowed'
wrong 'sphere { <0, 0, 0>, 1 pigmnt { rgb 1 } }' "wrong.pov:1:23: error: expected a transform, texture or other modifier"
wrong '#declare F = function { noise3d(x, y, z) } sphere { 0, F(1, 2, 3) }' "'noise3d', which is not declared"

# The corpus of the fuzzer: what becomes a scene is one.
for file in "$PSPLAT_SOURCE"/tests/fuzz/corpus_pov/*; do
    cp "$file" corpus.pov
    rm -f corpus.psd
    last="import of $(basename "$file")"
    "$PSPLAT" import corpus.pov >out 2>err
    status=$?
    [ $status -eq 0 ] || [ $status -eq 2 ] || fail "status $status: $(cat err)"
    [ $status -ne 0 ] || run 0 check corpus.psd
done

# --- beside POV-Ray itself ---

command -v povray >/dev/null || { echo "without povray: no comparison"; finish; }

# like_povray NAME [BOUND]: the mean of light that comes straight is POV-Ray's within 2 %, and the pictures are alike.
like_povray() {
    povray -GA -D +I"$1.pov" +O"$1-pov.exr" +FE +W120 +H90 +A0.05 >out 2>err || fail "povray: $(tail -3 err)"
    run 0 import "$1.pov"
    run 0 render -q -p estimator=splat --size 120x90 --set render.indirect_exposure=0 "$1.psd" -o "$1.exr"
    last="compare $1 with POV-Ray's"
    "$PSPLAT" compare "$1-pov.exr" "$1.exr" -m bias -m rel_rmse --fail 'bias<0.98' --fail 'bias>1.02' --fail "rel_rmse>${2:-0.08}" >out 2>err ||
        fail "$1 is not as POV-Ray has it: $(cat out err)"
}

body='plane { y, 0 pigment { checker rgb 0.9 rgb <0.9, 0.4, 0.2> } }
sphere { <-1, 1, 0>, 1 pigment { rgb <0.9, 0.5, 0.7> } }
box { <0.5, 0, -1>, <2, 1.2, 0.5> pigment { rgb <0.3, 0.6, 0.9> } rotate y*20 }'
i=0
while read -r kind; do
    i=$((i + 1))
    printf '%s\n%s\nlight_source { <4, 7, -5>, rgb <1, 0.9, 0.8>*40 fade_distance 0.5 fade_power 2 %s }\n' "$head" "$body" "$kind" >lit$i.pov
    like_povray lit$i
done <<'END'

spotlight point_at <0, 0, 0> radius 12 falloff 22
spotlight point_at <0, 0, 0> radius 5 falloff 30 tightness 8
area_light x*2, z*2, 9, 9 circular orient
area_light x*4, z*0.5, 9, 3
END
printf '%s\n%s\nlight_source { <4, 7, -5>, rgb 0.8 parallel point_at 0 }\n' "$head" "$body" >sun.pov
like_povray sun 0.15

light='light_source { <4, 7, -5>, rgb 40 fade_distance 0.5 fade_power 2 }'
cat >solids.pov <<END
$head
$light
plane { y, 0 pigment { rgb 0.6 } }
difference { box { -1, 1 } sphere { 0, 1.25 pigment { rgb <1, 1, 0> } } cylinder { -2*y, 2*y, 0.5 }
    pigment { rgb <0.2, 0.3, 0.9> } rotate y*25 translate <-1.8, 1, 0> }
intersection { sphere { 0, 1 } box { -0.8, 0.8 } pigment { rgb <0.3, 0.9, 0.3> } rotate <20, 30, 0> translate <0.6, 1, -0.3> }
sphere { 0, 1 clipped_by { plane { y, 0.2 } } pigment { rgb <0.9, 0.3, 0.8> } translate <2.5, 1, 0.5> }
lathe { cubic_spline 6, <0.2, -0.3>, <0.3, 0>, <0.5, 0.4>, <0.2, 0.8>, <0.4, 1.2>, <0.5, 1.4> scale 0.6
    pigment { rgb <0.9, 0.8, 0.3> } translate <-0.4, 0, -2.2> }
prism { 0, 0.5, 6, <0, 0>, <1, 0>, <1.2, 0.6>, <0.5, 1>, <0, 0.6>, <0, 0> scale 0.7 pigment { rgb <0.4, 0.8, 0.9> } translate <1.2, 0, -2.5> }
END
like_povray solids 0.12
cat >program.pov <<END
$head
$light
#declare Dice = seed(7);
#macro Stack(P, N)
    #local T = transform { rotate z*10*N translate P }
    #if (N > 0)
        cone { 0, 0.3, y*0.5, 0.1 pigment { gradient y color_map { [0 rgb 1] [1 rgb <1, 0, 0>] } scale 0.5 } transform T }
        Stack(P + y*0.5, N - 1)
    #end
#end
#for (I, -3, 3)
    torus { 0.3, 0.1 + 0.1*rand(Dice) pigment { rgb <rand(Dice), rand(Dice), rand(Dice)> } rotate x*30*I translate <I, 0.5, 0> }
    Stack(<I, 0, 2>, 3)
#end
union { sphere { 0, 0.4 } cylinder { 0, y, 0.2 } pigment { rgb <0.2, 0.8, 0.5> } matrix <1, 0, 0, 0.5, 1, 0, 0, 0, 1, 0, 1, -1> }
plane { y, 0 pigment { rgb 0.7 } }
END
like_povray program 0.12

# The system's files of textures and shapes can be read.
for file in /usr/share/povray-3.7/include/*.inc; do
    [ -e "$file" ] || continue
    printf '#include "colors.inc"\n#include "shapes.inc"\n#include "%s"\nlight_source { y 1 }\n' "$(basename "$file")" >system.pov
    run 0 import system.pov
done

finish
