# psplat import: scenes of pbrt beside the same scenes written by hand, what has no counterpart, and what is wrong.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

few="-p injection=photon:count=500 -p estimator=splat -p denoiser=none --set render.aa_samples=1"

# import NAME [WORD...]: makes NAME.psd of NAME.pbrt, without a warning, in a form that psplat reads.
import() {
    name=$1
    shift
    run 0 import "$name.pbrt" "$@"
    expect_empty err
    expect_empty out
    run 0 check "$name.psd"
    expect_no_text err warning
}

# render SCENE: its picture lies beside it.
render() {
    # shellcheck disable=SC2086
    run 0 render -q $few "$1.psd" -o "$1.exr"
}

# same A B [BOUND]: light that comes straight, and normals, are those of the other scene, but for rounding.
same() {
    render "$1"
    render "$2"
    for layer in direct N; do
        last="compare $1 $2, layer $layer"
        "$PSPLAT" compare "$2.exr" "$1.exr" --layer $layer --metric rel_rmse --fail "rel_rmse>${3:-1e-4}" >out 2>err ||
            fail "$1 and $2 differ in layer $layer: $(cat out err)"
    done
}

# As `same`, but that they do.
different() {
    render "$1"
    render "$2"
    "$PSPLAT" compare "$2.exr" "$1.exr" --layer direct --metric rel_rmse --fail 'rel_rmse>1e-3' >out 2>err &&
        fail "$1 and $2 are the same"
}

film='Film "rgb" "integer xresolution" 48 "integer yresolution" 32 PixelFilter "box"'
film3='Film "image" "integer xresolution" [48] "integer yresolution" [32]'
view='LookAt 0 1 -5  0 1 0  0 1 0  Camera "perspective" "float fov" 40'
hand_view='camera: {location: [0, 1, 5], look_at: [0, 1, 0], vertical_angle: 40}
image: {width: 48, height: 32}'

# --- a sphere under a point light; the world is mirrored ---

cat >sphere.pbrt <<EOF
# a comment, "quoted
$view
$film
WorldBegin
LightSource "point" "rgb I" [10 20 30] "point3 from" [2 4 -3]
AttributeBegin
  Translate 0.5 1 0
  Rotate 30 0 1 0
  Material "diffuse" "rgb reflectance" [.5 .25 .75]
  Shape "sphere" "float radius" 0.7
AttributeEnd
Material "diffuse" "float reflectance" .5
Shape "trianglemesh" "point3 P" [-3 0 -3  3 0 -3  3 0 3  -3 0 3] "integer indices" [0 2 1 0 3 2]
EOF
cat >sphere-hand.psd <<EOF
psd: 1
$hand_view
lights: [point: {location: [2, 4, 3], intensity: [10, 20, 30]}]
materials: {a: {diffuse: [0.5, 0.25, 0.75]}, b: {diffuse: 0.5}}
objects:
  - sphere: {center: [0.5, 1, 0], radius: 0.7, material: a}
  - quad: {corners: [[-3, 0, 3], [3, 0, 3], [3, 0, -3], [-3, 0, -3]], material: b}
EOF
import sphere
same sphere sphere-hand

# A camera that mirrors already: the world stays.
sed 's/^LookAt/Scale -1 1 1 LookAt/' sphere.pbrt >mirrored.pbrt
cat >mirrored-hand.psd <<EOF
psd: 1
camera: {location: [0, 1, -5], look_at: [0, 1, 0], vertical_angle: 40}
image: {width: 48, height: 32}
lights: [point: {location: [2, 4, -3], intensity: [10, 20, 30]}]
materials: {a: {diffuse: [0.5, 0.25, 0.75]}, b: {diffuse: 0.5}}
objects:
  - sphere: {center: [0.5, 1, 0], radius: 0.7, material: a}
  - quad: {corners: [[-3, 0, 3], [3, 0, 3], [3, 0, -3], [-3, 0, -3]], material: b}
EOF
import mirrored
same mirrored mirrored-hand
different mirrored sphere

# The same in the words of pbrt-v3, which say the same, but for the comment and the filter.
cat >sphere3.pbrt <<EOF
$view
$film3
WorldBegin
Include "parts/light.pbrt"
AttributeBegin
  Translate 0.5 1 0
  Rotate 30 0 1 0
  Material "matte" "rgb Kd" [.5 .25 .75]
  Shape "sphere" "float radius" [0.7]
AttributeEnd
MakeNamedMaterial "floor" "string type" "matte" "color Kd" [.5 .5 .5]
NamedMaterial "floor"
Include "parts/floor.pbrt" WorldEnd
EOF
mkdir parts
echo 'LightSource "point" "color I" [10 20 30] "point from" [2 4 -3]' >parts/light.pbrt
echo 'Shape "trianglemesh" "point P" [-3 0 -3  3 0 -3  3 0 3  -3 0 3]
    "integer indices" [0 2 1 0 3 2]' >parts/floor.pbrt
import sphere3
sed '1d; s/"matte"/"diffuse"/; s/"floor"/"diffuse-2"/' sphere3.psd >a
sed 1d sphere.psd >b
expect_same a b

# What an imported file does to the state ends with it; what an included one does stays.
echo 'Material "diffuse" "rgb reflectance" [.1 .2 .3] Translate 9 9 9 Shape "sphere"' >parts/blue.pbrt
for word in Import Include; do
    printf '%s\n%s\nWorldBegin LightSource "point" %s "parts/blue.pbrt" Shape "sphere" "float radius" 2\n' "$view" "$film" $word >$word.pbrt
    import $word
done
expect_match Import.psd 'radius: 2, material: "grey", matrix: [^9]*$'
expect_match Include.psd 'radius: 2, material: "diffuse", matrix: .*9'

# Names of textures: those of floats and of spectra are two sets. In pbrt-v3 they and named materials end with their
# level, and a material has the textures from before it.
red='"spectrum" "constant" "rgb value" [1 0 0]' green='"spectrum" "constant" "rgb value" [0 1 0]'
cat >names3.pbrt <<EOF
$film3
WorldBegin LightSource "point"
Texture "c" $red Texture "c" "float" "constant" "float value" .25
MakeNamedMaterial "m" "string type" "mirror" "color Kr" [.5 .5 .5]
AttributeBegin
Texture "c" $green MakeNamedMaterial "m" "string type" "mirror"
AttributeEnd
Material "plastic" "texture Kd" "c" "texture roughness" "c" "bool remaproughness" "false"
Texture "c" $green
Shape "sphere"
NamedMaterial "m" Shape "sphere"
EOF
import names3
expect_text names3.psd 'diffuse: [1, 0, 0], specular: 0.01, roughness: 0.5'
expect_text names3.psd 'mirror: 0.5}'
cat >names4.pbrt <<EOF
$film
WorldBegin LightSource "point"
AttributeBegin Texture "c" $red AttributeEnd
Texture "c" "float" "constant" "float value" .25
Material "diffuse" "texture reflectance" "c" Shape "sphere"
EOF
import names4
expect_text names4.psd 'diffuse: [1, 0, 0]'

# What pbrt reads with a warning, and materials that are named before they are made.
cat >lenient4.pbrt <<EOF
$film
WorldBegin LightSource "point"
NamedMaterial "m" MakeNamedMaterial "m" "string type" "diffuse" "rgb reflectance" [.1 .2 .3]
CoordSysTransform "nowhere" Shape "sphere"
EOF
run 0 import lenient4.pbrt
expect_text err "lenient4.pbrt:4:1: warning: there is no coordinate system 'nowhere'"
expect_text lenient4.psd '"m": {diffuse: [0.1, 0.2, 0.3]}'
cat >lenient3.pbrt <<EOF
$film3
WorldBegin LightSource "point"
Texture "n" "float" "fbm" Material "disney" "texture metallic" "n" "texture roughness" "n"
Shape "trianglemesh" "integer indices" [0 1 2] "point P" [0 0 0 1 0 0 0 1 0] "float uv" [0 0 1 0 0 1 1 1]
EOF
run 0 import lenient3.pbrt
expect_text err 'warning: uv: those past the last point are left out'
expect_text lenient3.psd 'roughness: {noise: {colors: [0, 1]'
run 0 check lenient3.psd

# TransformBegin is AttributeBegin in pbrt-v4; ActiveTransform ends with its level, and at WorldBegin.
for version in 3 4; do
    cat >levels.pbrt <<EOF
ActiveTransform EndTime Camera "perspective"
WorldBegin LightSource "point"
Translate 3 0 0
TransformBegin
ActiveTransform EndTime Translate 7 0 0 ReverseOrientation Material "mirror"
TransformEnd
Translate 2 0 0 Shape "sphere"
EOF
    run 0 import --pbrt $version levels.pbrt
    expect_match levels.psd "material: \"$([ $version = 3 ] && echo mirror || echo grey)\", matrix: \[-1, 0, 0, 5,"
done
printf '%s\nOption "disablepixeljitter" true Option "seed" 3 Option "rendercoordsys" "world"\nWorldBegin Shape "sphere"\n' "$film" >option.pbrt
run 0 import option.pbrt
expect_text err "option.pbrt:2:1: warning: Option 'disablepixeljitter' has no counterpart: left out"
expect_text err "Option 'rendercoordsys'"
run 0 check option.psd
printf '%s\nWorldBegin AreaLightSource "diffuse" ObjectBegin "a" Shape "sphere" ObjectEnd ObjectInstance "a"\n' "$film" >dark.pbrt
run 0 import dark.pbrt
expect_text err 'warning: lights in objects are left out, as pbrt does'

# --- fov is of the shorter side ---

sed 's/"integer xresolution" 48 "integer yresolution" 32/"integer xresolution" 24 "integer yresolution" 36/' \
    sphere.pbrt >portrait.pbrt
sed 's/vertical_angle: 40/angle: 40/; s/width: 48, height: 32/width: 24, height: 36/' sphere-hand.psd \
    >portrait-hand.psd
import portrait
same portrait portrait-hand
sed 's/"float fov" 40/& "float screenwindow" [-0.75 0.75 -0.5 0.5]/' sphere.pbrt >window.pbrt
cat >window-hand.psd <<EOF
$(sed 's/vertical_angle: 40/vertical_angle: =2*degrees(atan(0.5*tan(radians(20))))/' sphere-hand.psd)
EOF
import window
same window window-hand
sed 's/"perspective" "float fov" 40/"orthographic" "float screenwindow" [-3 3 -2 2]/' sphere.pbrt >parallel.pbrt
sed 's/vertical_angle: 40/projection: orthographic, width: 6/' sphere-hand.psd >parallel-hand.psd
import parallel
same parallel parallel-hand

# --- a box under an area light: sides, two-sidedness, power, reversal ---

cat >box.pbrt <<EOF
$view
$film
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [4 5 6]
  Material "diffuse" "rgb reflectance" [0 0 0]
  Shape "bilinearmesh" "point3 P" [-.5 3 -.5  .5 3 -.5  -.5 3 .5  .5 3 .5]
AttributeEnd
MakeNamedMaterial "white" "string type" "diffuse" "float reflectance" .7
MakeNamedMaterial "unused" "string type" "diffuse"
NamedMaterial "white"
Shape "trianglemesh" "point3 P" [-3 0 -3  3 0 -3  3 0 3  -3 0 3] "integer indices" [0 2 1 0 3 2]
Shape "trianglemesh" "point3 P" [-.5 0 -.5  .5 0 -.5  .5 1 -.5  -.5 1 -.5
                                -.5 0 .5  .5 0 .5  .5 1 .5  -.5 1 .5]
    "integer indices" [0 2 1 0 3 2  4 5 6 4 6 7  3 6 2 3 7 6  0 1 5 0 5 4  0 7 3 0 4 7  1 2 6 1 6 5]
EOF
cat >box-hand.psd <<EOF
psd: 1
$hand_view
lights: [rectangle: {corners: [[-0.5, 3, -0.5], [0.5, 3, -0.5], [0.5, 3, 0.5], [-0.5, 3, 0.5]], radiance: [4, 5, 6]}]
materials: {white: {diffuse: 0.7}}
objects:
  - quad: {corners: [[-3, 0, 3], [3, 0, 3], [3, 0, -3], [-3, 0, -3]], material: white}
  - box: {corners: [[-0.5, 0, -0.5], [0.5, 1, 0.5]], material: white}
EOF
import box
expect_text box.psd '"white": {diffuse: 0.7}'
expect_no_text box.psd unused
same box box-hand 0.2
sed 's/AreaLightSource/ReverseOrientation &/' box.pbrt >reversed.pbrt
import reversed
different reversed box
sed 's/AreaLightSource "diffuse"/ReverseOrientation & "bool twosided" true/' box.pbrt >both.pbrt
import both
same both box-hand 0.2
sed 's/"rgb L" \[4 5 6\]/& "float power" 15.707963 "float scale" 3/' box.pbrt >power.pbrt
sed 's/radiance: \[4, 5, 6\]/radiance: [60, 75, 90]/' box-hand.psd >power-hand.psd
import power
same power power-hand 0.2
sed 's/Shape "bilinearmesh"/& "float alpha" 0/' box.pbrt >hidden.pbrt
import hidden
expect_text hidden.psd 'camera: no'

# --- lights ---

cat >lights.pbrt <<EOF
$view
$film
WorldBegin
LightSource "distant" "rgb L" [1 2 3] "point3 from" [1 2 0] "point3 to" [0 0 1]
LightSource "spot" "rgb I" [9 9 9] "point3 from" [0 3 0] "point3 to" [.5 0 -.25] "float coneangle" 30
    "float conedeltaangle" 10
LightSource "infinite" "rgb L" [.25 .5 .5]
LightSource "point" "blackbody I" 6500 "float power" 100
Shape "sphere"
EOF
cat >lights-hand.psd <<EOF
psd: 1
$hand_view
lights:
  - sun: {direction: [-1, -2, -1], angle: 0, irradiance: [1, 2, 3]}
  - spotlight: {location: [0, 3, 0], point_at: [0.5, 0, 0.25], radius: 20, falloff: 30, intensity: 9}
  - sky: {radiance: [0.25, 0.5, 0.5]}
  - point: {location: [0, 0, 0], intensity: =100/(4*pi)}
materials: {grey: {diffuse: 0.5}}
objects: [sphere: {center: [0, 0, 0], radius: 1, material: grey}]
EOF
import lights
same lights lights-hand 1e-3

# --- instances, attributes, coordinate systems ---

cat >instances.pbrt <<EOF
$view
$film
WorldBegin
LightSource "point" "rgb I" [20 20 20] "point3 from" [2 4 -3]
ObjectBegin "pair"
  Attribute "shape" "float radius" .3
  Translate 0 .5 0
  Shape "sphere"
  Translate 1 .5 .5
  Shape "sphere" "float radius" .2
ObjectEnd
ObjectBegin "nothing"
ObjectEnd
CoordinateSystem "here"
TransformBegin
  Translate -1 0 0
  Rotate 40 0 1 0
  ObjectInstance "pair"
TransformEnd
AttributeBegin
  Scale 5 5 5
  CoordSysTransform "here"
  Transform [1 0 0 0  0 1 0 0  0 0 -1 0  1 0 0 1]
  ConcatTransform [1 0 0 0  0 2 0 0  0 0 1 0  0 0 0 1]
  ObjectInstance "pair"
AttributeEnd
ObjectInstance "nothing"
EOF
cat >instances-hand.psd <<EOF
psd: 1
$hand_view
lights: [point: {location: [2, 4, 3], intensity: 20}]
materials: {grey: {diffuse: 0.5}}
groups:
  pair:
    - sphere: {center: [0, 0.5, 0], radius: 0.3, material: grey}
    - sphere: {center: [1, 1, -0.5], radius: 0.2, material: grey}
objects:
  - instance: {of: pair, rotate: [0, -40, 0], translate: [-1, 0, 0]}
  - instance: {of: pair, scale: [1, 2, -1], translate: [1, 0, 0]}
EOF
import instances
expect_text instances.psd 'instance: {of: "pair"'
same instances instances-hand 2e-3

# --- shapes: whole ones, and parts that make up the same ---

scene() {
    printf '%s\n%s\nWorldBegin\nLightSource "point" "rgb I" [20 20 20] "point3 from" [2 4 -3]\n' "$view" "$film"
    cat
}
hand_scene() {
    printf 'psd: 1\n%s\nlights: [point: {location: [2, 4, 3], intensity: 20}]\n' "$hand_view"
    printf 'materials: {grey: {diffuse: 0.5}}\nobjects:\n'
    cat
}
scene >whole.pbrt <<'EOF'
Translate 0 1 0 Rotate 40 1 0 0
Shape "sphere" "float radius" .6
Translate 1.2 0 0 Shape "cylinder" "float radius" .4 "float zmin" -.5 "float zmax" .5
Translate -2.4 0 0 Shape "cone" "float radius" .4 "float height" .8
Translate 0 -.8 0 Shape "disk" "float radius" .4 "float innerradius" .2 "float height" .1
EOF
hand_scene >whole-hand.psd <<'EOF'
  - group:
      rotate: [-40, 0, 0]
      translate: [0, 1, 0]
      objects:
        - sphere: {center: [0, 0, 0], radius: 0.6, material: grey}
        - cylinder: {from: [1.2, 0, 0.5], to: [1.2, 0, -0.5], radius: 0.4, open: yes, material: grey}
        - cone: {from: [-1.2, 0, 0], from_radius: 0.4, to: [-1.2, 0, -0.8], to_radius: 0, open: yes, material: grey}
        - disc: {center: [-1.2, -0.8, -0.1], normal: [0, 0, -1], radius: 0.4, hole: 0.2, material: grey}
EOF
import whole
[ "$(ls whole-* | wc -l)" -eq 1 ] || fail "whole shapes became meshes"
same whole whole-hand 0.02
scene >parts.pbrt <<'EOF'
Translate 0 1 0 Rotate 40 1 0 0
TransformBegin
  Shape "sphere" "float radius" .6 "float phimax" 180
  Rotate 180 0 0 1
  Shape "sphere" "float radius" .6 "float phimax" 180 "float zmin" -.1
  Shape "sphere" "float radius" .6 "float phimax" 180 "float zmax" -.1
TransformEnd
Translate 1.2 0 0
TransformBegin
  Shape "cylinder" "float radius" .4 "float zmin" -.5 "float zmax" .5 "float phimax" 90
  Rotate 90 0 0 1
  Shape "hyperboloid" "point3 p1" [.4 0 -.5] "point3 p2" [.4 0 .5] "float phimax" 270
TransformEnd
Translate -2.4 0 0 Shape "cone" "float radius" .4 "float height" .8 "float phimax" 359.99
Translate 0 -.8 0 Shape "disk" "float radius" .4 "float innerradius" .2 "float height" .1 "float phimax" 359.99
EOF
import parts
[ "$(ls parts-mesh-*.ply | wc -l)" -eq 6 ] || fail "not 6 meshes: $(ls parts-*)"
same parts whole-hand 0.3
scene >sheets.pbrt <<'EOF'
Translate .013 .017 0
Shape "bilinearmesh" "point3 P" [-1 0 -1  1 0 -1  -1 0 1  1 0 1] "point2 uv" [0 0 1 0 0 1 1 1]
Translate -1 1 0
TransformBegin Scale .5 .5 .5
Shape "heightfield" "integer nu" 2 "integer nv" 3 "float Pz" [0 0 0 0 0 0]
TransformEnd
Shape "trianglemesh" "point3 P" [0 0 0  .5 0 0  0 -.5 0] "normal3 N" [0 0 -1 0 0 -1 0 0 -1] "integer indices" [0 1 2]
EOF
hand_scene >sheets-hand.psd <<'EOF'
  - group:
      translate: [0.013, 0.017, 0]
      objects:
        - quad: {corners: [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], material: grey}
        - quad: {corners: [[-1, 1, 0], [-0.5, 1, 0], [-0.5, 1.5, 0], [-1, 1.5, 0]], material: grey}
        - triangles: {vertices: [[-1, 1, 0], [-0.5, 1, 0], [-1, 0.5, 0]], triangles: [[0, 2, 1]], material: grey}
EOF
import sheets
same sheets sheets-hand
scene >curved.pbrt <<'EOF'
Translate 0 1 0
Shape "loopsubdiv" "integer levels" 3 "integer indices" [0 1 2 0 2 3 0 3 4 0 4 1 5 2 1 5 3 2 5 4 3 5 1 4]
  "point3 P" [0 0 1  1 0 0  0 1 0  -1 0 0  0 -1 0  0 0 -1]
Translate 1 0 0
Shape "paraboloid" "float radius" .4 "float zmin" .2 "float zmax" .8
Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 1]
EOF
import curved
render curved
expect_text curved-mesh-0.ply "element face 512"
expect_text curved-mesh-2.ply "element face 128"

# Subdivision rounds an octahedron to nearly a ball, of about 0.58 of its size.
scene >ball.pbrt <<'EOF'
Translate 0 1 0 Scale 1.7 1.7 1.7
Shape "loopsubdiv" "integer levels" 4 "integer indices" [0 1 2 0 2 3 0 3 4 0 4 1 5 2 1 5 3 2 5 4 3 5 1 4]
  "point3 P" [0 0 1  1 0 0  0 1 0  -1 0 0  0 -1 0  0 0 -1]
EOF
hand_scene >ball-hand.psd <<'EOF'
  - sphere: {center: [0, 1, 0], radius: 1, material: grey}
EOF
import ball
same ball ball-hand 1

# A mesh's file is named where it is, seen from the scene.
mkdir out-folder
{
    printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n'
    printf 'element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n'
} >parts/three.ply
echo 'Shape "plymesh" "string filename" "parts/three.ply"' | scene >ply.pbrt
import ply
expect_text ply.psd 'file: "parts/three.ply"'
run 0 import ply.pbrt -o out-folder/ply.psd
expect_text out-folder/ply.psd 'file: "../parts/three.ply"'
run 0 check out-folder/ply.psd
echo 'Shape "plymesh" "string filename" "parts/three.ply.gz"' | scene >gz.pbrt
run 0 import gz.pbrt
expect_text err "gz.pbrt:5:1: warning: 'parts/three.ply.gz' is compressed; the scene names 'parts/three.ply'"

# --- materials ---

scene >materials.pbrt <<'EOF'
MakeNamedMaterial "a b" "string type" "conductor" "rgb reflectance" [.9 .5 .2] "float roughness" .0625
MakeNamedMaterial "glass" "string type" "dielectric" "spectrum eta" "glass-BK7"
MakeNamedMaterial "both" "string type" "mix" "string materials" ["a b" "glass"] "float amount" .25
NamedMaterial "both" Shape "sphere"
Material "conductor" Shape "sphere"
Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "bool remaproughness" false
    "float roughness" .25 Shape "sphere"
Material "coateddiffuse" "rgb reflectance" [.1 .2 .3] "float eta" 2 Shape "sphere"
Material "interface" AreaLightSource "diffuse" "float scale" 2 Shape "sphere"
EOF
import materials
expect_text materials.psd '"a b": {metal: {color: [0.9, 0.5, 0.2], roughness: 0.5}}'
expect_text materials.psd '"glass": {dielectric: {ior: 1.5168, color: 1}}'
expect_text materials.psd '"both": {mix: [{material: "a b", weight: 0.75}, {material: "glass", weight: 0.25}]}'
expect_match materials.psd 'metal: \{color: \[0.9[0-9]*, 0.[678][0-9]*, 0.[56][0-9]*\], roughness: 0\}' # copper
expect_match materials.psd 'metal: \{color: \[0.9[0-9]*, 0.7[0-9]*, 0.3[0-9]*\], roughness: 0.5\}' # gold
expect_text materials.psd 'glossy: {diffuse: [0.1, 0.2, 0.3], specular: 0.11111111, roughness: 0}'
expect_text materials.psd '{diffuse: 0, emission: 2}'
cat >materials3.pbrt <<EOF
$view
$film3
WorldBegin
LightSource "point"
Material "plastic" "color Kd" [.1 .2 .3] "color Ks" [1 1 1] "float roughness" .04 "bool remaproughness" "false"
Shape "sphere"
Material "mirror" Shape "sphere"
Material "glass" "float index" 1.33 Shape "sphere"
Material "metal" "spectrum eta" [400 1.5 700 1.5] "spectrum k" [400 0 700 0] "float roughness" 0 Shape "sphere"
Material "mix" "string namedmaterial1" "x" "string namedmaterial2" "y" "color amount" [1 1 1]
MakeNamedMaterial "x" "string type" "matte" MakeNamedMaterial "y" "string type" "mirror"
Shape "sphere"
EOF
import materials3
expect_text materials3.psd 'glossy: {diffuse: [0.1, 0.2, 0.3], specular: 0.04, roughness: 0.2}'
expect_text materials3.psd '{mirror: 0.9}'
expect_text materials3.psd '{dielectric: {ior: 1.33, color: 1}}'
expect_match materials3.psd 'metal: \{color: (0.04|\[0.0[34][0-9]*, 0.0[34][0-9]*, 0.0[34][0-9]*\]), '
expect_text materials3.psd '{mix: [{material: "x", weight: 1}]}'

# --- textures ---

cat >textures.pbrt <<EOF
$view
$film
WorldBegin
LightSource "point" "rgb I" [20 20 20] "point3 from" [2 4 -3]
Texture "squares" "spectrum" "checkerboard" "rgb tex1" [.8 .1 .1] "float tex2" .2 "float uscale" 2 "float vscale" 4
Texture "half" "spectrum" "scale" "texture tex" "squares" "float scale" .5
Material "diffuse" "texture reflectance" "half"
Translate .013 .017 .011
Rotate -33 1 0 0
Shape "bilinearmesh" "point3 P" [-1 0 -1  1 0 -1  -1 0 1  1 0 1]
EOF
cat >textures-hand.psd <<EOF
psd: 1
$hand_view
lights: [point: {location: [2, 4, 3], intensity: 20}]
materials: {red: {diffuse: [0.4, 0.05, 0.05]}, grey: {diffuse: 0.1}}
define: {square: [[0, 0, 0], [1, 0, 0], [1, 0, -0.5], [0, 0, -0.5]]}
objects:
  - group:
      rotate: [33, 0, 0]
      translate: [0.013, 0.017, -0.011]
      objects:
        - for: i
          in: [0, 1]
          do:
            - for: j
              in: [0, 1, 2, 3]
              do:
                - if: =mod(i+j, 2) == 0
                  do:
                    quad: {corners: =square, material: red, translate: [=i-1, 0, =1-j/2]}
                  else:
                    quad: {corners: =square, material: grey, translate: [=i-1, 0, =1-j/2]}
EOF
import textures
same textures textures-hand 1e-3

# The same on a mesh that is a file.
sed 's/^Shape "bilinearmesh".*/ConcatTransform [2 0 0 0  0 0 2 0  0 1 0 0  -1 0 -1 1]\nShape "heightfield" "integer nu" 7 "integer nv" 7 "float Pz" [ZEROS]/' textures.pbrt |
    sed "s/ZEROS/$(printf '0 %.0s' $(seq 49))/" >textures-file.pbrt
import textures-file
expect_text textures-file.psd 'mesh: {file: "textures-file-mesh-1.ply"'
same textures-file textures-hand 1e-3

# A picture of colours on a quad, upright, and times a colour.
render textures-hand
cp textures-hand.exr parts/picture.exr
cat >picture.pbrt <<EOF
$view
$film
WorldBegin
LightSource "point" "rgb I" [20 20 20] "point3 from" [0 1 -3]
Texture "t" "spectrum" "imagemap" "string filename" "parts/picture.exr" "float udelta" .25
Texture "m" "spectrum" "mix" "texture tex1" "t" "float tex2" .5 "float amount" 0
Material "diffuse" "texture reflectance" "m"
Shape "bilinearmesh" "point3 P" [-1 0 0  1 0 0  -1 2 0  1 2 0]
EOF
cat >picture-hand.psd <<EOF
psd: 1
$hand_view
lights: [point: {location: [0, 1, 3], intensity: 20}]
materials: {picture: {diffuse: {image: {file: parts/picture.exr, offset: [0.25, 0]}}}}
objects: [quad: {corners: [[-1, 0, 0], [1, 0, 0], [1, 2, 0], [-1, 2, 0]], material: picture}]
EOF
import picture
same picture picture-hand

# A sky, which pbrt-v3 has with z upwards: seen, at twice as wide as high, it is the same turned by a quarter.
# shellcheck disable=SC2086
run 0 render -q $few --size 64x32 box-hand.psd -o box-hand.exr
wide_view='LookAt 0 1 -5  1 0.8 -5.4  0 1 0  Camera "perspective" "float fov" 90'
cat >sky.pbrt <<EOF
$wide_view
$film3
WorldBegin
AttributeBegin
Rotate -90 1 0 0
LightSource "infinite" "string mapname" "box-hand.exr" "color L" [2 2 2]
AttributeEnd
Shape "sphere" "float radius" 0.1
EOF
cat >sky-hand.psd <<EOF
psd: 1
camera: {location: [0, 1, 5], look_at: [1, 0.8, 5.4], vertical_angle: 90}
image: {width: 48, height: 32}
lights: [sky: {file: box-hand.exr, rotate: 90, radiance: 2}]
materials: {grey: {diffuse: 0.5}}
objects: [sphere: {center: [0, 0, 0], radius: 0.1, material: grey}]
EOF
import sky --pbrt 3
render sky
render sky-hand
last="the sky"
"$PSPLAT" compare sky-hand.exr sky.exr --metric rel_rmse --fail 'rel_rmse>1e-4' >out || fail "$(cat out)"

# pbrt-v4 has one as a square, whose left half is where x is negative, and whose middle is z.
halves() {
    cat <<EOF
psd: 1
camera: {location: [0, 0, 5], look_at: [0, 0, 0], angle: 90}
image: {width: 32, height: 32}
materials: {red: {diffuse: 0, emission: [1, 0, 0]}, blue: {diffuse: 0, emission: [0, 0, 1]}}
objects:
  - quad: {corners: [[-9, -9, 0], [0, -9, 0], [0, 9, 0], [-9, 9, 0]], material: red}
  - quad: {corners: [[0, -9, 0], [9, -9, 0], [9, 9, 0], [0, 9, 0]], material: blue}
EOF
}
halves >halves-hand.psd
render halves-hand
cat >halves.pbrt <<EOF
LookAt 0 0 -5  0 0 0  0 1 0
Camera "perspective" "float fov" 90
Film "rgb" "integer xresolution" 32 "integer yresolution" 32 PixelFilter "box"
WorldBegin
LightSource "infinite" "string filename" "halves-hand.exr"
Translate 0 0 -20
Shape "sphere"
EOF
import halves
render halves
last="the halves of a sky"
"$PSPLAT" compare halves-hand.exr halves.exr --metric p99 --crop 0,0,11,32 --fail 'p99>1e-3' >out || fail "left: $(cat out)"
"$PSPLAT" compare halves-hand.exr halves.exr --metric p99 --crop 21,0,11,32 --fail 'p99>1e-3' >out || fail "right: $(cat out)"

# Pictures of a light: what the scene says of its illuminance or power is of the light with the picture.
cat >grey.psd <<EOF
psd: 1
camera: {location: [0, 0, 5], look_at: [0, 0, 0], angle: 90}
image: {width: 32, height: 32}
materials: {grey: {diffuse: 0, emission: 0.25}}
objects: [quad: {corners: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: grey}]
EOF
render grey
cat >measured.pbrt <<EOF
$film
WorldBegin
LightSource "infinite" "string filename" "grey.exr" "float illuminance" 1.5707963
AreaLightSource "diffuse" "string filename" "grey.exr" "float power" 6.2831853
Shape "bilinearmesh" "point3 P" [-1 0 0  1 0 0  -1 2 0  1 2 0]
EOF
import measured
expect_match measured.psd 'sky: \{file: .*, radiance: (2|2.000[0-9]*|1.999[0-9]*)\}'
expect_match measured.psd 'emission: \{image: \{file: "grey.exr", color: (2|2.000[0-9]*|1.999[0-9]*)[,}]'

# Spectra end with their samples in pbrt-v4.
printf '%s\nWorldBegin LightSource "point" Material "diffuse" "spectrum reflectance" [500 .5 600 .5] Shape "sphere"\n' "$film" >band.pbrt
import band
expect_match band.psd 'diffuse: \[0.[0-9]*, 0.[0-9]*, 0\]'
printf '%s\nWorldBegin LightSource "point" Material "matte" "spectrum Kd" [500 .5 600 .5] Shape "sphere"\n' "$film3" >band.pbrt
import band
expect_match band.psd 'diffuse: (0.5|0.499[0-9]*|\[0.[45][0-9]*, 0.[45][0-9]*, 0.[45][0-9]*\])\}'

# --- what has no counterpart is said once for each kind, with its place ---

cat >odd.pbrt <<EOF
Sampler "halton"
Integrator "volpath"
$view
$film
WorldBegin
Material "diffusetransmission"
Shape "sphere"
Shape "sphere" "float radius" 2
Material "diffusetransmission"
Shape "sphere"
Shape "curve" "point3 P" [0 0 0 1 1 1 2 2 2 3 3 3]
Shape "blob"
LightSource "projection" "string filename" "x.png"
Texture "w" "spectrum" "marble"
Texture "x" "spectrum" "ptex" "string filename" "a.ptx"
Shape "sphere" "float radious" 1 "float zmim" 2
MediumInterface "fog" ""
Attribute "shape" "float alhpa" 1
EOF
run 0 import odd.pbrt
expect_text err 'odd.pbrt:1:1: warning: Sampler has no counterpart: left out'
expect_text err 'odd.pbrt:2:1: warning: Integrator has no counterpart'
[ "$(grep -c diffusetransmission err)" -eq 2 ] || fail "not one warning, and its line, of diffusetransmission"
expect_text err 'odd.pbrt:6:1: warning: Material diffusetransmission: a diffuse surface'
expect_text err "odd.pbrt:11:1: warning: Shape curve has no counterpart"
expect_text err "odd.pbrt:12:1: warning: Shape 'blob' has no counterpart"
expect_text err "warning: LightSource projection: a spotlight"
expect_text err "warning: Texture marble: a gradient"
expect_text err "warning: Texture 'ptex' has no counterpart"
expect_text err "odd.pbrt:16:16: warning: Shape sphere: parameter 'radious' is left out"
expect_text err "warning: media have no counterpart"
expect_text err "odd.pbrt:18:19: warning: Attribute shape: parameter 'alhpa' is left out"
run 0 check odd.psd
{
    printf '%s\nWorldBegin\n' "$film"
    for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25; do echo "Shape \"kind$i\""; done
} >crowd.pbrt
run 0 import crowd.pbrt
[ "$(grep -c warning: err)" -eq 25 ] || fail "not 25 warnings: $(grep -c warning: err)"
echo 'WorldBegin' >bare.pbrt
run 0 import bare.pbrt
expect_text err "bare.pbrt:1:1: warning: no word here tells pbrt-v3 from pbrt-v4"
run 0 import bare.pbrt --pbrt 3
expect_empty err
expect_text bare.psd 'width: 640, height: 480'

# --- what is wrong: file, line, column, and nothing is written ---

# wrong TEXT MESSAGE: behind WorldBegin, on line 2.
wrong() {
    printf 'WorldBegin\n%s\n' "$1" >wrong.pbrt
    run 2 import --pbrt 4 wrong.pbrt
    expect_text err "wrong.pbrt:2:$2"
    [ ! -e wrong.psd ] || fail "wrong.psd was written"
}
wrong 'Shap "sphere"' "1: error: unknown directive 'Shap'; did you mean 'Shape'?"
wrong 'Shape sphere' '7: error: Shape: expected a text in quotes'
wrong 'Shape "sphere" "flaot radius" 1' "16: error: unknown type 'flaot' of a parameter; did you mean 'float'?"
wrong 'Shape "sphere" "float radius" "x"' '31: error: float radius: expected a number'
wrong 'Shape "sphere" "float radius" [1' '31: error: the file ends before this bracket is closed'
wrong 'Shape "sphere" "string radius" "1"' '16: error: radius: expected one float, got 1 of type string'
wrong 'Shape "sphere' '7: error: Shape: expected a text in quotes'
printf 'WorldBegin\nTranslate 1 2' >wrong.pbrt
run 2 import --pbrt 4 wrong.pbrt
expect_text err 'wrong.pbrt:2:14: error: Translate: expected 3 numbers, got 2'
wrong 'Translate 1 2 0x3' '15: error: Translate: expected 3 numbers'
wrong 'AttributeEnd' '1: error: no Begin of this is open here'
echo AttributeBegin >parts/open.pbrt
printf 'WorldBegin Import "parts/open.pbrt" Shape "sphere"' >wrong.pbrt
run 2 import wrong.pbrt
expect_text err 'the file that was imported before this closes not all that it opens'
wrong 'AttributeBegin ObjectEnd' '16: error: no Begin of this is open here'
wrong 'NamedMaterial "x" Shape "sphere"' "19: error: there is no material 'x'"
printf '%s\nWorldBegin NamedMaterial "x"' "$film3" >wrong.pbrt
run 2 import wrong.pbrt
expect_text err "there is no material 'x'"
wrong 'ObjectInstance "x"' "1: error: there is no object 'x'"
wrong 'Material "diffuse" "texture reflectance" "x" Shape "sphere"' "20: error: reflectance: no texture 'x' before this"
wrong 'Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 3]' \
    '53: error: indices: expected 0..2, got 3'
wrong 'Shape "trianglemesh" "point3 P" [0 0 0 1 0]' '22: error: point3 P: expected numbers in groups of 3, got 5'
wrong 'Scale 0 1 1 Shape "sphere"' "1: error: Scale: factors can't be 0"
wrong 'Shape "loopsubdiv" "integer levels" 99 "point3 P" [0 0 0 1 0 0 0 1 0]' '20: error: levels: expected 0..12, got 99'
wrong 'Shape "loopsubdiv" "integer levels" 12 "point3 P" [0 0 0 1 0 0 0 1 0]' '1: error: Shape loopsubdiv: 12 levels make'
wrong 'Include "none.pbrt"' '9: error: none.pbrt: cannot open'
wrong 'Include "wrong.pbrt"' "9: error: 'wrong.pbrt' includes itself"
wrong 'LightSource "point" "spectrum I" "stdillum-D66"' "21: error: spectrum 'stdillum-D66': no such name; did you mean 'stdillum-D65'?"
wrong 'Film "rgb"' '1: error: Film: it must stand before WorldBegin'
echo 'Include "b.pbrt"' >parts/a.pbrt
echo 'Include "parts/a.pbrt"' >b.pbrt
wrong 'Include "parts/a.pbrt"' '9:'
expect_text err 'from wrong.pbrt:2:9:'
expect_text err "b.pbrt:1:9: error: 'parts/a.pbrt' includes itself"
for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17; do echo "Include \"deep$((i + 1)).pbrt\"" >deep$i.pbrt; done
printf 'WorldBegin Include "deep1.pbrt"' >wrong.pbrt
run 2 import wrong.pbrt
expect_text err 'files include each other more than 16 deep'
printf 'WorldBegin AttributeBegin' >wrong.pbrt
run 2 import wrong.pbrt
expect_text err 'the scene ends before a AttributeBegin is closed'
printf 'Shape "sphere"' >wrong.pbrt
run 2 import wrong.pbrt
expect_text err '1:1: error: Shape: it must stand behind WorldBegin'
printf '' >wrong.pbrt
run 2 import wrong.pbrt
expect_text err 'the scene has no WorldBegin'
run 2 import sphere.pbrt -o sphere.txt
expect_text err "--output: expected FILE.psd"
run 2 import
run 2 import --pbrt 5 sphere.pbrt
run 1 import none.pbrt
expect_text err none.pbrt
run 1 import sphere.pbrt -o none/sphere.psd
mkdir taken.psd
run 1 import textures.pbrt -o taken.psd
[ "$(ls taken* | grep -c exr)" -eq 0 ] || fail "a file beside the scene stayed"
run 2 import --restrict out-folder sphere3.pbrt
expect_text err 'sphere3.pbrt:4:9: error: parts/light.pbrt:'
run 0 import --restrict parts sphere3.pbrt

finish
