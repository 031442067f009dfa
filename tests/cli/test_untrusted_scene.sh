# Scenes of others: they load no plugin by a path, and read no file outside of the folder of --restrict.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

# --- plugins ---

mark=$PWD/mark
compile_module "$PSPLAT_SOURCE/include" "$PSPLAT_SOURCE/tests/plugins/marking_filter.c" \
    "$PWD/evil.so" "-DMARK=\"$mark\""
head="psd: 1
camera: {location: [0, 0, 5], look_at: [0, 0, 0]}
lights: [{point: {location: [0, 2, 5], intensity: 1}}]"

not_loaded() {
    [ ! -e "$mark" ] || fail "the plugin's constructor ran"
    rm -f "$mark"
}

loaded() {
    [ -e "$mark" ] || fail "the plugin was not loaded"
    rm -f "$mark"
}

# refuses_plugin SCENE: in whatever way the scene is read.
refuses_plugin() {
    for command in check render "debug gbuffer"; do
        # shellcheck disable=SC2086
        run 2 $command "$1"
        expect_match err "^[a-z]+\.psd:[0-9]+:[0-9]+: error: filter in render: a plugin is a program"
        expect_text err "use --plugin or --allow-scene-plugins"
        not_loaded
    done
    [ -z "$(find . -name '*.png' -o -name '*.exr')" ] || fail "a picture in spite of the error"
}

printf '%s\nrender: {filter: ./evil.so}\n' "$head" >path.psd
refuses_plugin path.psd
printf '%s\nrender: {filter: {%s: {}}}\n' "$head" "$PWD/evil.so" >map.psd
refuses_plugin map.psd
printf '%s\ndefine: {which: ./evil.so}\nrender: {filter: =which}\n' "$head" >formula.psd
refuses_plugin formula.psd
printf '%s\ninclude: path.psd\n' "$head" >including.psd
printf 'psd: 1\nrender: {filter: ./evil.so}\n' >path.psd
refuses_plugin including.psd
run 2 check "$cornell" --set render.filter=./evil.so
expect_text err "--set:1:15: error: filter in render: a plugin is a program"
not_loaded

# Who runs psplat may load it.
run 0 check including.psd --allow-scene-plugins
loaded
run 0 check "$cornell" --plugin filter=./evil.so
loaded
run 0 plugins filter=./evil.so
loaded
run 0 -q --size 16x9 including.psd --allow-scene-plugins -o by.exr
loaded
run 0 info by.exr
expect_text out " --allow-scene-plugins"

# A folder that depends on where psplat is started would do the same by a plain name.
mkdir filter
mv evil.so filter/marking.so
printf '%s\nrender: {filter: marking}\n' "$head" >name.psd
for path in . filter/.. "$PWD:" ":$PWD" "$PWD::/tmp" ::; do
    last="PSPLAT_PLUGIN_PATH=$path"
    for command in "check name.psd" "plugins filter"; do
        # shellcheck disable=SC2086
        PSPLAT_PLUGIN_PATH=$path "$PSPLAT" $command >out 2>err
        check_status $? 2
        expect_text err "psplat: error: PSPLAT_PLUGIN_PATH: expected absolute folders with ':' between them, got "
        not_loaded
    done
done
last="PSPLAT_PLUGIN_PATH=$PWD"
PSPLAT_PLUGIN_PATH=$PWD "$PSPLAT" check name.psd >out 2>err
check_status $? 0
loaded

# --- files ---

mkdir -p jail/sub outside
printf 'psd: 1\nmaterials: {%s: {diffuse: 0.5}}\n' red >jail/sub/red.psd
printf 'psd: 1\nmaterials: {%s: {diffuse: 0.5}}\n' blue >outside/blue.psd
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' | tee jail/mesh.obj >outside/mesh.obj
run 0 -q --size 4x4 "$cornell" -o jail/picture.png
cp jail/picture.png outside/picture.png
printf 'mtllib %s/outside/all.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' "$PWD" >jail/library.obj
printf 'newmtl m\nKd 1 1 1\n' >outside/all.mtl
ln -s ../outside jail/link
ln -s ../outside/picture.png jail/picture-link.png
ln -s sub/red.psd jail/inner-link.psd

# scene LINE: jail/scene.psd, which ends in that line.
scene() {
    printf '%s\n%s\n' "$head" "$1" >jail/scene.psd
}

mesh() {
    scene "objects: [{mesh: {file: $1, use: [geometry, materials], material: white}}]
materials: {white: {diffuse: 0.5}}"
}

picture() {
    scene "objects: [{sphere: {center: [0, 0, 0], radius: 1, material: painted}}]
materials: {painted: {diffuse: {image: {file: $1}}}}"
}

# allowed: with the folder as without.
allowed() {
    run 0 check jail/scene.psd
    run 0 check jail/scene.psd --restrict jail
    run 0 -q --size 4x4 -o allowed.png jail/scene.psd --restrict "$PWD/jail/sub/.."
}

# refused: without the folder all is well; with it nothing tells that the file is there.
refused() {
    run 0 check jail/scene.psd
    run 2 check jail/scene.psd --restrict jail
    expect_match err "^jail/scene\.psd:[0-9]+:[0-9]+: error: .*no readable file of that name lies in $PWD/jail,"
    run 2 -q --size 4x4 -o no.png jail/scene.psd --restrict jail
    [ ! -e no.png ] || fail "a picture in spite of the error"
}

for path in sub/red.psd ./sub/../sub/red.psd inner-link.psd "$PWD/jail/sub/red.psd"; do
    scene "include: $path"
    allowed
done
for path in ../outside/blue.psd link/blue.psd "$PWD/outside/blue.psd" sub/../../outside/blue.psd; do
    scene "include: $path"
    refused
done
sed -i 's/blue/nothing/' jail/scene.psd
run 2 check jail/scene.psd --restrict jail
expect_text err "no readable file of that name lies in $PWD/jail,"

mesh mesh.obj
allowed
for path in ../outside/mesh.obj link/mesh.obj "$PWD/outside/mesh.obj"; do
    mesh "$path"
    refused
done
# What a mesh file names is not there for it.
mesh library.obj
run 0 check jail/scene.psd --restrict jail
expect_no_text err "Kd"

picture picture.png
allowed
for path in ../outside/picture.png picture-link.png "$PWD/outside/picture.png"; do
    picture "$path"
    refused
done

# --- what is no scene is not shown ---

printf 'root:$y$hash:19000:0:::\npsd:*:19000::::::\n' >secret
printf 'password: hunter2\nuser: psdx\n' >settings.yaml
printf 'hunter2: [\npsd : {\n' >broken.yaml
for file in secret settings.yaml; do
    printf '%s\ninclude: %s\n' "$head" "$file" >leak.psd
    run 2 check leak.psd
    expect_match err "^leak\.psd:4:10: error: can't include '$file': it is no scene, since it has no key 'psd'"
    for word in hash root hunter2 psdx; do
        expect_no_text err "$word"
    done
done

# --- the options themselves ---

run 2 check "$cornell" --restrict nowhere
expect_text err "psplat: error: --restrict: 'nowhere' is not a folder that can be read: No such file"
run 2 "$cornell" --restrict "$cornell"
expect_text err "is not a folder that can be read"
run 2 check "$cornell" --restrict . --allow-scene-plugins
expect_text err "--restrict and --allow-scene-plugins exclude each other"

finish
