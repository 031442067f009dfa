# Numbers in pictures that surfaces and skies cannot have: each picture is warned of once.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

# A picture of radiance 3, and the same whose last number is NaN (little-endian).
cat >bright.psd <<'END'
psd: 1
camera: {location: [0, 0, 1], look_at: [0, 0, 0]}
image: {width: 4, height: 4}
materials: {glow: {diffuse: 0, emission: 3}}
objects: [{quad: {corners: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: glow}}]
END
run 0 --layers none --compression none -o bright.exr bright.psd
cp bright.exr broken.exr
printf '\0\0\300\177' | dd of=broken.exr bs=1 seek=$(($(wc -c <bright.exr) - 4)) conv=notrunc 2>/dev/null

# scene NAME PICTURE SKY: a wall of the picture, under a sky of another.
scene() {
    cat >"$1" <<END
psd: 1
camera: {location: [0, 0, 1], look_at: [0, 0, 0]}
materials:
  wall: {diffuse: {image: {file: $2}}}
  pale: {diffuse: {image: {file: $2, color: 0.25}}}
lights:
  - sky: {file: $3}
objects:
  - quad: {corners: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], material: wall}
  - quad: {corners: [[-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]], material: pale}
END
}

scene wall.psd bright.exr bright.exr
run 0 check wall.psd
expect_text err "wall.psd:4:34: warning: bright.exr: reflectances above 1 count as 1, and below 0 as 0"
count=$(grep -c warning err)
[ "$count" -eq 1 ] || fail "$count warnings"

sed -i '/wall: /s/bright.exr/&, color: 0.3/' wall.psd
run 0 check wall.psd
expect_empty err

scene sky.psd bright.exr broken.exr
run 0 check sky.psd
expect_text err "7:17: warning: broken.exr: 1 number is NaN or infinite: NaN counts as 0, infinity as 65504"

# A layer of a picture that psplat made.
scene plain.psd bright.exr bright.exr
run 0 render plain.psd --quiet --size 16x9 --quality draft -o layers.exr
scene layer.psd 'layers.exr, layer: albedo' 'layers.exr, layer: direct'
run 0 check layer.psd
expect_empty err
run 0 render layer.psd --quiet --size 16x9 --quality draft -o layer.exr
expect_picture layer.exr
scene no-layer.psd 'layers.exr, layer: albdo' layers.exr
run 2 render no-layer.psd --quiet -o no.exr
expect_text err "no-layer.psd:4:34: error: layers.exr: it has no layer 'albdo'; it has "
expect_text err "albedo"
[ ! -e no.exr ] || fail "a picture in spite of the error"
scene no-file.psd bright.exr 'bright.exr}
  - sky: {radiance: 1, layer: albedo'
run 2 check no-file.psd
expect_text err "layer in sky: there is no 'file' that it could be of"
scene list.psd 'bright.exr, layer: [a]' bright.exr
run 2 check list.psd
expect_text err "layer in image: expected the name of a layer, got a list"
finish
