# A lone model in place of a scene, and `psplat new`.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

quick="-q --size 32x18 -p injection=photon:count=300 -p estimator=splat -p denoiser=none --set render.aa_samples=1"

# box LOW HIGH FIRST [in]: a box as OBJ, its faces outwards, or inwards, from vertex number FIRST on.
box() {
    awk -v low="$1" -v high="$2" -v first="$3" -v inwards="${4:-}" 'BEGIN {
        split(low, a, ","); split(high, b, ",")
        for (i = 0; i < 8; i++)
            print "v", (i % 2 ? b[1] : a[1]), (int(i / 2) % 2 ? b[2] : a[2]), (i >= 4 ? b[3] : a[3])
        n = split("0,2,3,1 4,5,7,6 0,1,5,4 2,6,7,3 0,4,6,2 1,3,7,5", faces, " ")
        for (i = 1; i <= n; i++) {
            split(faces[i], v, ",")
            printf "f"
            for (k = 1; k <= 4; k++)
                printf " %d", v[inwards ? 5 - k : k] + first
            print ""
        }
    }'
}

# --- every command that takes a scene ---

mkdir -p models scenes/deep
box -1,0,-1 1,2,1 1 >models/cube.obj
run 0 check models/cube.obj
expect_empty out
expect_empty err
run 0 check --bounds models/cube.obj
expect_text out "  mesh cube.obj (models/cube.obj:"
expect_text out "extent [2, 2, 2], center [0, 1, 0]"
run 0 check --parameters models/cube.obj
expect_text out "  no parameters"
run 0 $quick models/cube.obj
expect_empty err
expect_picture cube.exr cube.png
run 0 info cube.exr
expect_text out "psplat render models/cube.obj "
sh -c "$("$PSPLAT" info cube.exr | sed -n 's/^psplat render/"$PSPLAT" render/p') -q -o again.exr"
expect_same_pixels cube.exr again.exr
run 0 debug -q --size 32x18 gbuffer:normal models/cube.obj
expect_picture cube-gbuffer-normal.png
run 0 $quick --preview --camera camera -o preview.png models/cube.obj

# The command line changes its scene; what is wrong shows in the scene's text.
run 0 check --bounds --set objects.0.mesh.translate='[5, 0, 0]' --set camera.angle=20 models/cube.obj
expect_text out "center [5, 1, 0]"
expect_text out ", angle: 20}"
run 0 check --bounds --set camera.aperture=0.1 --set camera.focus=2.5 models/cube.obj
expect_text out ", aperture: 0.1, focus: 2.5}"
run 2 check --set objects.0.mesh.uup=z models/cube.obj
expect_text err "unknown key 'uup' in mesh; did you mean 'up'?"
run 2 check --restrict scenes models/cube.obj
expect_text err "models/cube.obj: no readable file of that name lies in"
run 0 check --restrict models models/cube.obj
run 2 check models/gone.obj models/cube.obj
expect_text err "psplat: error: models/gone.obj: cannot open: No such file"
run 2 check --parameters models/gone.obj
expect_text err "psplat: error: models/gone.obj: cannot open: No such file"
mkdir folder.obj
run 2 check --parameters folder.obj
expect_text err "folder.obj: it is a directory"
run 2 check --parameters --restrict scenes models/cube.obj
expect_text err "models/cube.obj: no readable file of that name lies in"
printf 'v 0 0 0\n' >models/empty.obj
run 2 check models/empty.obj
expect_text err "models/empty.obj: "
printf 'nonsense' >models/broken.glb
run 2 $quick models/broken.glb
expect_text err "models/broken.glb: not binary glTF"
[ ! -e broken.exr ] || fail "a picture of a broken model"

# Numbers in range, whose products are not.
cat >models/overflow.gltf <<'END'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
 "nodes": [{"mesh": 0, "matrix": [1e37, 0, 0, 0, 1e37, 1e-37, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [1e4, -3e4, 0], "max": [3e4, -1e4, 500]}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}],
 "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AEAcRgBAHMYAAAAAAECcRgBAnMYAAIA/AGDqRgBg6sYAAPpD"}]}
END
run 2 check models/overflow.gltf
expect_text err "models/overflow.gltf: there is nothing to see in it"

# --- the file is read once, by one child process, unless the scene is to have it in another way ---
# expect_forks N WORD...
expect_forks() {
    wanted=$1
    shift
    : >forks
    FORKS=$PWD/forks LD_PRELOAD=$PWD/counted_forks.so run 0 "$@"
    [ "$(wc -l <forks)" -eq "$wanted" ] || fail "$(wc -l <forks) child processes, not $wanted: $*"
}
compile_preload counted_forks || fail "no library that counts forks: $(head -n 1 compiler)"
expect_forks 1 $quick models/cube.obj
expect_forks 1 new --from models/cube.obj once.psd
expect_forks 2 check --bounds --set objects.0.mesh.up=z models/cube.obj
expect_text out "mesh cube.obj (models/cube.obj:"

# --- new ---

run 0 new first.psd
expect_text err "psplat: wrote first.psd"
run 0 check first.psd
expect_empty err
cp first.psd kept.psd
run 2 new first.psd
expect_text err "first.psd is there already"
expect_same first.psd kept.psd
run 0 $quick first.psd
expect_empty err
run 0 new --from models/cube.obj scenes/deep/cube.psd
expect_text scenes/deep/cube.psd 'file: "../../models/cube.obj"'
run 0 check scenes/deep/cube.psd
expect_empty err
run 2 new --from models/cube.obj scenes/deep/cube.psd
run 0 $quick -o written.exr scenes/deep/cube.psd
expect_same_pixels cube.exr written.exr
ln -s ../models scenes/link
run 0 new --from scenes/link/cube.obj here.psd
expect_text here.psd 'file: "models/cube.obj"'
run 0 new --from "$PWD/models/cube.obj" models/beside.psd
expect_text models/beside.psd 'file: "cube.obj"'
run 2 new
expect_text err "new: which file?"
run 2 new scene.yaml
expect_text err "'scene.yaml' does not end in .psd"
run 2 new a.psd b.psd
expect_text err "one scene at a time"
run 1 new --from models/gone.obj gone.psd
expect_text err "models/gone.obj: cannot open"
run 2 new --from first.psd other.psd
expect_text err "first.psd: unknown kind of mesh file; known by their extension are .obj,"
run 1 new nowhere/a.psd
expect_text err "nowhere/a.psd"
[ -z "$(find . -name 'a.psd' -o -name 'gone.psd' -o -name 'other.psd')" ] || fail "a scene in spite of the error"

# Names that mean something to YAML or to formulas.
soft=$(printf '\302\205\342\200\250\357\273\277\357\277\277\302\237') # U+0085, U+2028, U+FEFF, U+FFFF, U+009F
for name in '=1 + 1.obj' 'a"b\c: #d.OBJ' "it's, [x].obj" "two
lines.obj" "$(printf 'caf\303\251.obj')" "a${soft}b.obj"; do
    cp models/cube.obj "$name"
    run 0 check "$name"
    expect_empty err
    run 0 new --from "$name" odd.psd
    run 0 check odd.psd
    expect_empty err
    rm odd.psd
done

# Latin-1, which scenes are not written in.
latin=$(printf 'caf\351.obj')
cp models/cube.obj "$latin"
run 2 check "$latin"
expect_text err "the name is not UTF-8, so no scene can name it"
run 2 new --from "$latin" latin.psd
expect_text err "the name is not UTF-8, so no scene can name it"
[ ! -e latin.psd ] || fail "a scene that cannot be read"

# --- what a file lacks, and what it has ---

# Prints stand on x and y.
cat >models/up.stl <<'END'
solid s
facet normal 0 1 0
outer loop
vertex 0 0 0
vertex 0 0 9
vertex 1 0 0
endloop
endfacet
endsolid s
END
run 0 check --bounds models/up.stl
expect_text out "extent [1, 9, 0]"
run 0 new --from models/up.stl up.psd
expect_text up.psd "up: z"

# A model with a camera and a lamp keeps them; "Cam" looks at it from the left.
cat >models/own.gltf <<'END'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
 "extensionsUsed": ["KHR_lights_punctual"],
 "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 100}]}},
 "nodes": [{"mesh": 0}, {"name": "Cam", "camera": 0, "translation": [-5, 0, 0], "rotation": [0, -0.7071068, 0, 0.7071068]},
           {"translation": [-4, 4, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
 "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [0, 1, 1]}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}],
 "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/"}]}
END
run 0 check --bounds --camera Cam models/own.gltf
expect_match out 'camera: \{location: \[-5, 0, 0\], look_at: \[-4, '
run 0 new --from models/own.gltf own.psd
expect_text own.psd "use: [geometry, materials, camera, lights]"
expect_no_text own.psd "plane:"
expect_no_text own.psd "sky:"
run 0 check own.psd
expect_empty err

# Materials that the file names and lacks are told of; a model without any is grey without a word.
{ printf 'mtllib gone.mtl\nusemtl red\n'; cat models/cube.obj; } >models/unpainted.obj
run 0 check models/unpainted.obj
expect_text err "models/unpainted.obj: cannot read its library models/gone.mtl"
expect_text err "models/unpainted.obj: there is no library for material red"
printf 'newmtl red\nKd 1 0 0\n' >gone.mtl
sed 's|gone.mtl|../gone.mtl|' models/unpainted.obj >models/outside.obj
run 0 check --restrict models models/outside.obj
expect_text err "cannot read its library models/../gone.mtl"
run 0 check models/outside.obj
expect_empty err
run 0 new --from models/unpainted.obj unpainted.psd
expect_no_text unpainted.psd "has no materials"

# Pictures do not take the place of what the scene was read from, whatever they are called.
run 0 $quick --size 4x4 -o painted.png models/cube.obj
cp painted.png kept.png
printf 'newmtl red\nmap_Kd painted.png\n' >painted.mtl
{ printf 'mtllib painted.mtl\nusemtl red\n'; sed 's|^f \(.*\) \(.*\) \(.*\) |f \1/1 \2/1 \3/1 |;1i vt 0 0' models/cube.obj; } >painted.obj
run 0 check painted.obj
expect_empty err
run 2 $quick painted.obj
expect_text err "psplat: error: painted.png is a picture that the scene reads; give --output another name"
ln painted.png hard.png
ln -s painted.png soft.png
for name in hard soft; do
    run 2 $quick -o fine.exr -o "$name.png" painted.obj
    expect_text err "$name.png is a picture that the scene reads"
    run 2 debug -q --size 4x4 -o "$name.png" gbuffer:normal painted.obj
    expect_text err "$name.png is a picture that the scene reads; give --output another name"
done
run 2 $quick -o fine.exr --stats painted.obj painted.obj
expect_text err "painted.obj is a file of the scene; give --stats another name"
run 0 new --from painted.obj painted.psd
run 2 $quick -o fine.exr --stats painted.obj painted.psd
expect_text err "painted.obj is a file of the scene; give --stats another name"
[ ! -e fine.exr ] || fail "a picture in spite of the error"
expect_same painted.png kept.png
run 0 $quick -o fine.exr painted.obj
expect_empty err

# Rooms are seen from inside, or through the side that is open.
{ box 0,0,0 6,3,5 1 in; box 2,0,2 3,0.8,3.4 9; } >models/room.obj
run 0 new --from models/room.obj room.psd
expect_text room.psd "camera: {location: ["
expect_no_text room.psd "plane:"
run 0 check room.psd
expect_empty err
run 0 $quick -o room.exr room.psd
# The face at z = 5 is missing.
grep -v '^f 8 7 5 6\|^f 6 8 7 5\|^f 7 8 6 5\|^f 5 7 8 6' models/room.obj >models/stage.obj
[ "$(grep -c '^f' models/stage.obj)" -eq 11 ] || fail "the stage has $(grep -c '^f' models/stage.obj) faces"
run 0 check --bounds models/stage.obj
expect_match out 'camera: \{location: \[3, 1\.[0-9]*, [1-9][0-9.]*\], look_at: \[3, '
# A thing that is turned inside out is no room.
box 0,0,0 1,1,1 1 in >models/inverted.obj
run 0 new --from models/inverted.obj inverted.psd
expect_text inverted.psd "camera: {location: auto"

finish
