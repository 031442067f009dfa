# psplat import: the files that a scene of pbrt names and those that come of it; scenes that psplat must be able to read.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

# scene NAME [WORD...]: NAME.pbrt of standard input, behind WorldBegin.
scene() {
    { printf 'Film "rgb"\nWorldBegin LightSource "point"\n' && cat; } >"$1.pbrt"
}
scene3() {
    { printf 'Film "image"\nWorldBegin LightSource "point"\n' && cat; } >"$1.pbrt"
}
triangle='ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
0 1 0
3 0 1 2'
half_sphere='Shape "sphere" "float phimax" 180'

# --- names are data, whatever they begin with ---

echo 'Shape "plymesh" "string filename" "=a\", camera: no, b: \".ply"' | scene equals
run 0 import equals.pbrt
expect_text equals.psd '{file: "./=a\", camera: no, b: \".ply", use:'
printf '%s\n' "$triangle" >'=1+1.ply'
echo 'Shape "plymesh" "string filename" "=1+1.ply"' | scene equals
run 0 import equals.pbrt
expect_empty err
run 0 check equals.psd
bad=$(printf 'd\377')
echo "$half_sphere" | scene "$bad"
run 2 import "$bad.pbrt"
expect_text err 'must be UTF-8'
[ ! -e "$bad.psd" ] || fail "a file that is not UTF-8 was written"
run 0 import "$bad.pbrt" -o plain.psd
run 0 check plain.psd

# --- no file of the user's is overwritten, or lost where the import fails ---

printf '%s\n' "$triangle" >own-mesh-0.ply
cp own-mesh-0.ply kept.ply
echo "Shape \"plymesh\" \"string filename\" \"own-mesh-0.ply\" $half_sphere" | scene own
run 2 import own.pbrt
expect_text err "cannot write 'own-mesh-0.ply': the imported scene reads it; choose another name with --output"
[ ! -e own.psd ] || fail "own.psd was written"
expect_same own-mesh-0.ply kept.ply
run 0 import own.pbrt -o other.psd
run 0 check other.psd
ln -s own-mesh-0.ply link.ply
echo "Shape \"plymesh\" \"string filename\" \"./link.ply\" $half_sphere" | scene own
run 2 import own.pbrt
expect_same own-mesh-0.ply kept.ply
cp plain.psd scene.psd
run 2 import plain.psd
cp own.pbrt same.psd
run 2 import same.psd -o same.psd
expect_same same.psd own.pbrt

# What an earlier import made is replaced, or stays.
echo "$half_sphere" | scene again
run 0 import again.pbrt
cp again-mesh-0.ply kept.ply
echo "Scale 2 2 2 $half_sphere" | sed 's/180/90/' | scene again
rm again.psd
mkdir again.psd
run 1 import again.pbrt
expect_same again-mesh-0.ply kept.ply
rmdir again.psd
mkdir again-mesh-1.ply
echo "$half_sphere $half_sphere" | scene again
run 1 import again.pbrt
expect_text err again-mesh-1.ply
expect_same again-mesh-0.ply kept.ply
[ ! -e again.psd ] || fail "again.psd was written"
rmdir again-mesh-1.ply
run 0 import again.pbrt
run 0 check again.psd
for left in .psplat-import-*; do
    [ ! -e "$left" ] || fail "$left stayed"
done

# --- files that are not there, or not in the folder ---

mkdir inside
printf '%s\n' "$triangle" >inside/mesh.ply
cp inside/mesh.ply outside.ply
echo 'Shape "plymesh" "string filename" "none.ply"' | scene none
run 0 import none.pbrt
expect_text err 'none.pbrt:3:1: warning: none.ply: cannot open: No such file'
echo 'Shape "plymesh" "string filename" "none.ply.gz"' | scene none
run 0 import none.pbrt
expect_text err 'none.pbrt:3:1: warning: none.ply.gz: cannot open'
echo 'Texture "t" "spectrum" "imagemap" "string filename" "none.png"' | scene none
run 0 import none.pbrt
expect_text err 'none.pbrt:3:1: warning: none.png: cannot open'
run 2 import none.pbrt --restrict inside
expect_text err 'none.pbrt:3:1: error: none.png: no readable file of that name lies in'
echo 'Shape "plymesh" "string filename" "outside.ply"' | scene restricted
run 0 import restricted.pbrt
rm restricted.psd
run 2 import restricted.pbrt --restrict inside
expect_text err 'restricted.pbrt:3:1: error: outside.ply: no readable file of that name lies in'
[ ! -e restricted.psd ] || fail "restricted.psd was written"
echo 'Shape "plymesh" "string filename" "inside/mesh.ply"' | scene restricted
run 0 import restricted.pbrt --restrict inside
expect_empty err

# --- what is written can be read ---

# readable NAME: the scene of standard input becomes one that psplat reads.
readable() {
    run 0 import "$1.pbrt"
    cp err said
    run 0 check "$1.psd"
}
noise='Texture "n" "float" "fbm"'
echo "$noise"' Material "uber" "float opacity" .7 Shape "sphere" "texture alpha" "n"
    Material "uber" "texture opacity" "n" Shape "sphere" "float alpha" .6 Shape "sphere" "texture alpha" "n"' | scene3 opacity
readable opacity
expect_text opacity.psd 'opacity: {noise: {colors: [0, 0.7]'
expect_text opacity.psd 'opacity: {noise: {colors: [0, 0.6]'
expect_no_text said "parameter 'opacity' is left out"
expect_text said 'opacity of the material is left out where alpha varies too'
echo "$noise"' AreaLightSource "diffuse" Shape "sphere" "texture alpha" "n"' | scene shining
readable shining
expect_text shining.psd 'mesh: {file: "shining-mesh-0.ply"'
echo 'Shape "sphere" "float radius" 1e-60' | scene small
run 2 import small.pbrt
expect_text err 'radius and phimax must be above 0'
echo 'Shape "cylinder" "float zmin" 1 "float zmax" 1.00000000001' | scene small
run 2 import small.pbrt
expect_text err 'it has no extent'
printf 'Camera "perspective" "float fov" 179.9999999999\n%s\n' "$(echo 'Shape "disk" "float height" 1e9' | scene wide && cat wide.pbrt)" >wider.pbrt
readable wider
expect_text wider.psd 'angle: 179.999'
# Meshes of 64 triangles and 192 points, 768 numbers.
awk 'BEGIN { for (i = 0; i < 192; i++) { points = points " " i % 7 " " i % 5 " " i % 3; indices = indices " " i }
    for (i = 0; i < 1960; i++)
        print "Shape \"trianglemesh\" \"point3 P\" [" points "] \"integer indices\" [" indices "]" }' | scene many
readable many
[ "$(grep -c 'mesh: {file' many.psd)" -eq 7 ] || fail "not 7 of many meshes are files"
rm -f many-mesh-*
awk 'BEGIN { for (i = 0; i < 300000; i++) print "Shape \"sphere\" \"float radius\" .1 Translate 1 0 0" }' | scene many
rm many.psd
run 2 import many.pbrt
expect_text err 'the scene has more than 4000000 values, the most that psplat reads'
[ ! -e many.psd ] || fail "many.psd was written"

# nested COUNT: mixes in mixes, the shapes from the inside.
nested() {
    awk -v n="$1" 'BEGIN { print "MakeNamedMaterial \"m0\" \"string type\" \"diffuse\""
        for (i = 1; i <= n; i++) printf "MakeNamedMaterial \"m%d\" \"string type\" \"mix\" \"string materials\" [\"m%d\" \"m%d\"] NamedMaterial \"m%d\" Shape \"sphere\"\n", i, i - 1, i - 1, i }' |
        scene nested
}
nested 3
readable nested
nested 4
run 2 import nested.pbrt
expect_text err 'Material mix: it comes to 16 materials, of which psplat mixes up to 8'
# chain COUNT: each of one material alone.
chain() {
    nested "$1"
    sed -i 's/"mix"/& "float amount" 0/g' nested.pbrt
}
chain 16
readable nested
chain 17
run 2 import nested.pbrt
expect_text err 'mixes are in mixes more than 16 deep'

# The corpus of the fuzzer, in either version: what becomes a scene is one.
for file in "$PSPLAT_SOURCE"/tests/fuzz/corpus_pbrt/*; do
    name=$(basename "$file")
    for version in 3 4; do
        tail -c +2 "$file" >corpus.pbrt
        rm -f corpus.psd
        last="import --pbrt $version of $name"
        "$PSPLAT" import --pbrt $version corpus.pbrt >out 2>err
        status=$?
        [ $status -eq 0 ] || [ $status -eq 2 ] || fail "status $status: $(cat err)"
        [ $status -ne 0 ] || run 0 check corpus.psd
    done
done

finish
