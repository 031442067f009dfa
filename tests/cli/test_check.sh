# psplat check: good scenes say nothing, bad ones say where.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

run 0 check "$cornell"
expect_empty out
expect_empty err
for scene in "$PSPLAT_SOURCE"/scenes/*.psd; do
    run 0 check --parameters "$scene"
    # A scene that needs what is not here, such as a mesh, says so.
    if grep -q '; required$' out; then
        run 2 check "$scene"
        expect_text err "has no default; give it with --param"
    else
        run 0 check "$scene"
    fi
done

cat >bad.psd <<'END'
psd: 1
camera: {location: [0, 1, 5], look_at: [0, 0, 0]}
materials:
  grey: {diffuse: 0.5}
lights:
  - spotlight:
      location: [0, 4, 0]
      point_at: [0, 0, 0]
      radios: 20
      intensity: 10
objects:
  - sphere: {center: [0, 0, 0], radius: -1, material: gray}
END
run 2 check bad.psd
expect_empty out
expect_text err "bad.psd:9:7: error: unknown key 'radios' in spotlight; did you mean 'radius'?"
expect_text err "    9 |       radios: 20"
expect_text err "      |       ^~~~~~"
expect_text err "bad.psd:12:"
expect_text err "radius in sphere: expected number > 0, got '-1'"
expect_text err "undefined material 'gray'; did you mean 'grey'?"
expect_text err "3 errors"

# All scenes are checked, in their order.
run 2 check bad.psd "$cornell" missing.psd
expect_text err "bad.psd:9:7: error:"
expect_match err '^missing\.psd: error: .*No such file'
run 2 check "$cornell" bad.psd
run 0 check "$cornell" "$cornell"
last="a scene on standard input"
"$PSPLAT" check - <bad.psd >out 2>err
check_status $? 2
expect_text err "<stdin>:9:7: error:"

# A warning is no error, and stands once.
printf 'psd: 1\ncamera: {location: [0, 0, 5], look_at: [0, 0, 0]}\n' >dark.psd
run 0 check dark.psd
expect_text err "warning: the scene has no lights"
[ "$(grep -c warning err)" -eq 1 ] || fail "a warning stands twice"
run 0 -q --size 8x8 -o dark.exr dark.psd
[ "$(grep -c warning err)" -eq 1 ] || fail "a warning of render stands twice"

# What shows only when the scene is made: pictures that can't be read, objects that have no shape.
# Both `check` and `render` say where.

# scene_of MATERIAL OBJECT: into built.psd
scene_of() {
    cat >built.psd <<END
psd: 1
camera: {location: [0, 1, 5], look_at: [0, 0, 0]}
lights:
  - point: {location: [0, 4, 0], intensity: 10}
materials:
  a: {$1}
objects:
  - $2
END
}
# refuses TEXT: by both, with no picture.
refuses() {
    run 2 check built.psd
    expect_text err "$1"
    run 2 -q -o built.exr built.psd
    expect_text err "$1"
    [ ! -e built.exr ] || fail "a scene that can't be made gave a picture"
}
ball='sphere: {center: [0, 0, 0], radius: 1, material: a}'
scene_of 'diffuse: {image: {file: nowhere.png}}' "$ball"
refuses "built.psd:6:31: error: nowhere.png: cannot open: No such file"
head -c 60 "$PSPLAT_SOURCE/tests/data/rgb8.png" >short.png
scene_of 'diffuse: {image: {file: short.png}}' "$ball"
refuses "built.psd:6:31: error: short.png: it ends too early"
scene_of 'diffuse: 0.5, normal_map: {file: nowhere.jpg}' "$ball"
refuses "error: nowhere.jpg: cannot open"
scene_of 'diffuse: 0.5' 'box: {corners: [[0, 0, 0], [1, 0, 1]], material: a}'
refuses "built.psd:8:5: error: box: its corners agree in a coordinate"
scene_of 'diffuse: 0.5' 'height_field: {file: nowhere.exr, material: a}'
refuses "built.psd:8:26: error: nowhere.exr: cannot open"

# Triangles without area are left out, which is worth a warning.
scene_of 'diffuse: 0.5' \
    'triangles: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0]], triangles: [[0, 1, 2], [0, 1, 3]], material: a}'
run 0 check built.psd
expect_text err "built.psd:8:5: warning: a triangle without area is left out"
run 0 -q --size 8x8 -o built.exr built.psd
expect_text err "built.psd:8:5: warning: a triangle without area is left out"

# Plugins and their parameters are checked too, with their places in the scene.
cat >plugins.psd <<'END'
psd: 1
camera: {location: [0, 1, 5], look_at: [0, 0, 0]}
lights:
  - point: {location: [0, 4, 0], intensity: 10}
render:
  injection: {photon: {cuont: 5}}
  visibility: {shadowmap: {resolution: 65}}
  filter: gausian
END
run 2 check plugins.psd
expect_text err "plugins.psd:6:24: error: unknown parameter 'cuont' of injection photon; did you mean 'count'?"
expect_text err "plugins.psd:7:40: error: visibility shadowmap: resolution: expected integer 1..64, got '65'"
expect_text err "plugins.psd:8:11: error: no filter 'gausian' (there are: box, "
expect_text err "3 errors"

# --bounds: of the scene without endless planes and lights, of mesh files and instances of them, and the camera.
printf 'v 0 0 0\nv 1 0 0\nv 0 2 3\nf 1 2 3\nv 9 9 9\n' >m.obj
cat >bounds.psd <<'END'
psd: 1
camera: auto
lights: [sphere: {location: [0, 99, 0], radius: 1, power: 5}]
materials: {a: {diffuse: 0.5}}
groups: {g: [mesh: {file: m.obj, material: a}], h: [sphere: {center: [0, 0, 0], radius: 0.5, material: a}]}
objects:
  - plane: {normal: [0, 1, 0], material: a}
  - for: i
    in: [0, 10]
    do: [mesh: {file: m.obj, material: a, translate: [=i, 0, 0]}]
  - instance: {of: g, translate: [0, -4, 0]}
  - instance: {of: h}
END
run 0 check --bounds bounds.psd
expect_empty err
cat >expected <<'END'
bounds.psd
  scene: extent [11.5, 6, 3.5], center [5.25, -1, 1.25], from [-0.5, -4, -0.5] to [11, 2, 3]
  mesh m.obj (bounds.psd:10:10): extent [1, 2, 3], center [0.5, 1, 1.5], from [0, 0, 0] to [1, 2, 3]
  mesh m.obj (bounds.psd:10:10): extent [1, 2, 3], center [10.5, 1, 1.5], from [10, 0, 0] to [11, 2, 3]
  instance of g (bounds.psd:11:5): extent [1, 2, 3], center [0.5, -3, 1.5], from [0, -4, 0] to [1, -2, 3]
END
grep -v camera out >found
expect_same found expected
# A scene with the camera that was printed gives the same picture.
sed -n 's/^  camera/camera/p' out >camera
{ grep -v '^camera' bounds.psd; cat camera; } >found.psd
for name in bounds found; do
    run 0 -q --size 80x45 -p estimator=splat -p denoiser=none -o $name.exr $name.psd
done
run 0 compare bounds.exr found.exr --layer N --metric max --fail 'max>0.01'
run 2 check --bounds bad.psd
expect_empty out

# --plugin lays over the scene.
run 2 check --plugin filter=nope "$cornell"
expect_text err "no filter 'nope'"
run 2 check -p injection=photon:count=0 "$cornell" bad.psd
expect_text err "count: expected integer"
expect_text err "bad.psd:9:7: error:"
run 0 check -p injection=photon:count=1 -p filter=box "$cornell"
run 2 check plugins.psd -p injection=photon:count=3
expect_no_text err "filter 'nope'"
expect_text err "unknown parameter 'cuont'"
run 2 check
expect_text err "psplat: error: check: which scene?"
run 2 check --size 1x1 "$cornell"
expect_text err "unknown option '--size'"

finish
