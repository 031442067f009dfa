# --cache: the same picture from a mesh file and from what was made of it.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

cat >m.obj <<'END'
mtllib m.mtl
v -1 0 -1
v 1 0 -1
v 1 0 1
v -1 0 1
v 0 1.5 0
usemtl floor
f 4 3 2 1
usemtl roof
f 1 2 5
f 2 3 5
END
printf 'newmtl floor\nKd 0.6 0.6 0.6\nnewmtl roof\nKd 0.7 0.2 0.1\n' >m.mtl
cat >scene.psd <<'END'
psd: 1
camera: {location: [0, 1, -4], look_at: [0, 0.5, 0], angle: 50}
lights: [{point: {location: [2, 4, -3], intensity: 20}}]
objects: [{mesh: {file: m.obj}}, {mesh: {file: m.obj, translate: [0.5, 0, 2]}}]
END
quick="--quiet --size 32x18 --quality draft --passes 1"

# Names and numbers of the files.
entries() {
    ls -i cache >"$1" || fail "no cache"
}

run 0 $quick -o plain.exr scene.psd
run 0 $quick --cache cache -o first.exr scene.psd
expect_same_pixels plain.exr first.exr
entries before
[ "$(wc -l <before)" -eq 2 ] || fail "not an entry for each placement"
run 0 $quick --cache cache -o second.exr scene.psd
expect_same_pixels plain.exr second.exr
entries after
expect_same before after

# The job is the same.
run 0 $quick --cache cache --passes 0:1 --checkpoint half.exr scene.psd
run 0 $quick --passes 1:2 --checkpoint rest.exr scene.psd
run 0 merge half.exr rest.exr -o both.exr

# What a mesh file needs is looked at again.
sed -i 's/0.7 0.2 0.1/0.1 0.2 0.7/' m.mtl
run 0 $quick -o plain-blue.exr scene.psd
run 0 $quick --cache cache -o blue.exr scene.psd
expect_same_pixels plain-blue.exr blue.exr
entries after
[ "$(wc -l <after)" -eq 2 ] || fail "entries that nothing names any more"
cmp -s before after && fail "another library, and the same entries"

# A lone model, and the other commands.
run 0 $quick --cache models -o model.exr m.obj
run 0 $quick --cache models -o again.exr m.obj
expect_same_pixels model.exr again.exr
run 0 check --cache models scene.psd
run 0 debug -q --size 8x8 gbuffer:normal --cache models scene.psd

# A large picture: in memory, stored, from the cache, and with less memory than it takes.
run 0 $quick --size 640x560 -o large.png scene.psd
cat >textured.psd <<'END'
psd: 1
camera: {location: [0, 1, -4], look_at: [0, 0.5, 0], angle: 50}
lights: [{point: {location: [0, 2, -3], intensity: 20}}]
materials: {shown: {diffuse: {image: {file: large.png}}}}
objects:
  - quad: {corners: [[-2, 0, -2], [2, 0, -2], [2, 0, 2], [-2, 0, 2]], material: shown}
  - quad: {corners: [[-2, 0, 2], [2, 0, 2], [2, 3, 2], [-2, 3, 2]], material: shown}
END
run 0 $quick -o plain-textured.exr textured.psd
for options in "" "" "--texture-memory 100K" "--memory-limit 1G"; do
    run 0 $quick --cache textures $options -o textured.exr textured.psd
    expect_empty err
    expect_same_pixels plain-textured.exr textured.exr
done
ls textures >after
grep -q '\.texture$' after && [ "$(wc -l <after)" -eq 1 ] || fail "not one entry for the picture"
run 0 check --cache textures --texture-memory 100K textured.psd
run 2 $quick --texture-memory 500K -o none.exr textured.psd
expect_text err "textured.psd:4:45: error: up to this one the scene's pictures take 2 MiB of memory"
expect_text err "--texture-memory is 1 MiB"
expect_text err "with --cache large ones are read in tiles"
[ ! -e none.exr ] || fail "a picture in spite of the error"
run 2 $quick --texture-memory some -o none.exr textured.psd
expect_text err "--texture-memory: expected a size such as 500M or 8G, got 'some'"

# A damaged entry is made anew.
truncate -s 5000 textures/*.texture
run 0 $quick --cache textures -o textured.exr textured.psd
expect_same_pixels plain-textured.exr textured.exr
[ "$(wc -c <"$(ls textures/*.texture)")" -gt 1000000 ] || fail "the damaged entry is still there"

# Films of both are of one job.
run 0 $quick --cache textures --passes 0:1 --checkpoint half-textured.exr textured.psd
run 0 $quick --passes 1:2 --checkpoint rest-textured.exr textured.psd
run 0 merge half-textured.exr rest-textured.exr -o both-textured.exr

# Folders that can be none.
run 2 $quick --cache nowhere/cache -o none.exr scene.psd
expect_text err "--cache: cannot make the folder nowhere/cache: No such file or directory"
run 2 $quick --cache m.obj -o none.exr scene.psd
expect_text err "--cache: "
[ ! -e none.exr ] || fail "a picture without the cache"

# A folder that can't be written to loses nothing but the entry; root may write anywhere.
if [ "$(id -u)" != 0 ]; then
    mkdir -p locked && chmod 500 locked
    run 0 $quick --cache locked -o locked.exr scene.psd
    expect_text err "warning: m.obj: it is not kept in the cache: "
    chmod 700 locked
    expect_same_pixels plain-blue.exr locked.exr
fi
finish
