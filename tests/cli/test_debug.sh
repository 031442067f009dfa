# psplat debug: every view as it is called, its files, and that nothing depends on threads and batches.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

small="--size 60x40 -p injection=photon:count=1000 -p estimator=splat $cornell"

# expect_size WxH FILE.png: as its header says.
expect_size() {
    found=$(od -An -tu1 -j16 -N8 "$2" | awk '{
        print $1 * 16777216 + $2 * 65536 + $3 * 256 + $4 "x" $5 * 16777216 + $6 * 65536 + $7 * 256 + $8 }')
    [ "$found" = "$1" ] || fail "$2 is $found, expected $1"
}

# Every view, with what its picture measures.
mkdir new && cd new || exit 1
while read -r view size; do
    run 0 debug $view $small
    name=cornell-$(echo "$view" | tr : -).png
    expect_picture "$name"
    expect_size "$size" "$name"
    expect_empty out
    expect_text err "psplat: wrote $name"
done <<END
photons 60x77
voxels 60x40
gbuffer 180x153
gbuffer:albedo 60x40
gbuffer:normal 60x40
gbuffer:position 60x40
gbuffer:depth 60x40
gbuffer:object 60x40
gbuffer:material 60x40
gbuffer:throughput 60x40
gbuffer:direct 60x40
gbuffer:emitted 60x40
maps 72x86
overlap 60x77
pixel 60x77
END
rm out err
cd .. || exit 1
expect_files cornell-photons.png cornell-voxels.png cornell-gbuffer.png cornell-gbuffer-albedo.png \
    cornell-gbuffer-normal.png cornell-gbuffer-position.png cornell-gbuffer-depth.png \
    cornell-gbuffer-object.png cornell-gbuffer-material.png cornell-gbuffer-throughput.png \
    cornell-gbuffer-direct.png cornell-gbuffer-emitted.png cornell-maps.png cornell-overlap.png cornell-pixel.png

# The same, to the last byte, for any number of threads and any batches.
for view in photons voxels gbuffer maps overlap pixel; do
    run 0 debug $view $small -t 1 -o one.png
    run 0 debug $view $small -t 3 --batch 17 -o three.png -q
    expect_empty err
    expect_same one.png three.png
    expect_same one.png new/cornell-$view.png
done

# Options count, each for its view.
differs() {
    view=$1
    shift
    run 0 debug $view $small -q -o other.png "$@"
    expect_different other.png new/cornell-$view.png
}
differs photons --count 50
differs photons --color bounce
differs photons --top 1000
differs photons --seed 5
differs voxels --resolution 5
differs voxels --set camera.location.2=-700
differs maps --count 3
differs maps -p visibility=shadowmap:resolution=16
differs maps --exposure 2
differs overlap --top 5000
differs overlap -p visibility=none
differs overlap -p injection=photon:count=2000
differs pixel --pixel 20,30
differs pixel --count 2
differs pixel --top 10
run 0 debug pixel $small --pixel 30,20 -o usual.png
expect_same usual.png new/cornell-pixel.png
run 0 debug voxels $small --resolution 16 -o usual.png
expect_same usual.png new/cornell-voxels.png
# The cells of the scene's own stratification, with its parameters; --resolution goes before it.
# cells NAME STRATIFICATION [OPTION...]: the pixels of that view, without what the file says of itself.
cells() {
    name=$1 stratification=$2
    shift 2
    run 0 debug voxels $small -p stratification=$stratification "$@" -o "$name.png"
    sed 's/.*IDAT/IDAT/; /IDAT/,$!d' "$name.png" >"$name.pixels"
}
cells usual none
cells grid grid:resolution=16,threshold=1
expect_same grid.pixels usual.pixels
cells fine grid:resolution=17,threshold=1
expect_different fine.pixels grid.pixels
cells joined grid:resolution=16,threshold=20
expect_different joined.pixels grid.pixels
cells cascade cascade:resolution=12
expect_different cascade.pixels grid.pixels
cells coarse cascade:resolution=6
expect_different coarse.pixels cascade.pixels
cells octree octree:capacity=2
cells octree3 octree:capacity=2 -t 3 --batch 17
expect_same octree.png octree3.png
cells crowded octree:capacity=20
expect_different crowded.pixels octree.pixels
cells own octree:capacity=2 --resolution 16
expect_same own.pixels usual.pixels
run 0 debug photons $small --count 20000 --color power -o usual.png
expect_same usual.png new/cornell-photons.png

# A larger sheet where there are more maps; a scene from standard input; more maps than splats.
run 0 debug maps $small --count 13 -o more.png
expect_size 72x109 more.png
run 0 debug maps --size 60x40 -p injection=photon:count=40 --count 10000000 "$cornell" -o all.png
expect_picture all.png
last="psplat debug voxels - <cornell.psd"
"$PSPLAT" debug voxels - --size 60x40 <"$cornell" >out 2>err
check_status $? 0
expect_picture stdin-voxels.png

# A scene in which nothing is seen, or nothing shines.
cat >dark.psd <<'END'
psd: 1
camera: {location: [0, 0, 9], look_at: [0, 0, 20]}
image: {width: 30, height: 20}
materials: {m: {diffuse: 0.5}}
lights: [{point: {location: [0, 0, 5], intensity: 0}}]
objects: [{sphere: {center: [0, 0, 0], radius: 1, material: m}}]
render: {injection: {photon: {count: 100}}}
END
for view in photons voxels gbuffer; do
    run 0 debug $view dark.psd -o dark.png
    expect_picture dark.png
done
run 2 debug maps dark.psd -o none.png
expect_text err "maps: no splat is in the picture"

# Pictures say what they show.
grep -qa 'psplat.debug' new/cornell-overlap.png || fail "no psplat.debug in the picture"
grep -qa 'psplat.visibility' new/cornell-overlap.png || fail "no settings in the picture"

# usage TEXT WORD...: a usage error with that text.
usage() {
    text=$1
    shift
    run 2 "$@" -o none.png
    expect_empty out
    expect_match err '^psplat: error: '
    expect_text err "$text"
}
usage "expected a view and a scene" debug
usage "expected a view and a scene" debug photons
usage "expected a view and a scene" debug photons a.psd b.psd
usage "there is no view 'fotons'; did you mean 'photons'?" debug fotons "$cornell"
usage "there are: photons, voxels, gbuffer, maps, overlap, pixel" debug picture "$cornell"
usage "the view gbuffer has no part 'red'; it has: albedo, normal" debug gbuffer:red "$cornell"
usage "the view overlap has no parts" debug overlap:1 "$cornell"
usage "overlap: the estimator vpl made no splats" debug overlap $small -p estimator=vpl
usage "maps: the visibility none has no depth maps" debug maps $small -p visibility=none
usage "pixel: (60, 5) is outside of the picture, which has 60x40 pixels" debug pixel $small --pixel 60,5
usage "pixel: nothing is seen at (0, 20)" debug pixel $small --pixel 0,20
for value in 5 5, ,5 5,6,7 -1,5 1.5,2 x,y ""; do
    usage "--pixel: expected a column and a row, as 120,80, got '$value'" debug pixel --pixel "$value" $small
done
usage "--plugin: expected KIND=NAME" debug maps -p nothing "$cornell"
usage "--size: expected WxH" debug maps --size 5 "$cornell"
usage "--color: expected power or bounce, got 'red'" debug photons --color red "$cornell"
usage "unknown option '--passes'" debug photons --passes 2 "$cornell"
for value in 0 -1 1.5 x ""; do
    usage "--count: expected a whole number 1..10000000, got '$value'" \
        debug photons --count "$value" "$cornell"
    usage "--resolution: expected a whole number 1..100000, got '$value'" \
        debug voxels --resolution "$value" "$cornell"
done
for value in 0 -1 x "" nan; do
    usage "--top: expected a number above 0, got '$value'" debug overlap --top "$value" "$cornell"
done
for value in picture.exr picture .png ""; do
    run 2 debug voxels "$cornell" -o "$value"
    expect_text err "--output: '$value' does not end in .png"
done
run 2 debug voxels missing.psd -o none.png
expect_text err "missing.psd: error: cannot open"
run 1 debug voxels $small -o nowhere/a.png
expect_text err "can't write 'nowhere/a.png'"
[ ! -e none.png ] || fail "a picture in spite of errors"

finish
