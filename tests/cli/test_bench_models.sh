# bench/models tells right from seen, warned, refused and absent files.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

command -v python3 >/dev/null || skip "bench/models needs python3"

# gltf NAME [MEMBER]: a triangle.
gltf() {
    mkdir -p "files/gltf/$1"
    cat >"files/gltf/$1/$1.gltf" <<END
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],"materials":[{"name":"m"${2-}}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}
END
}

gltf BoxInterleaved
gltf TextureSettingsTest
gltf BoxVertexColors ',"extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1}}'
mkdir -p files/gltf/Duck
echo none >files/gltf/Duck/Duck.gltf

last="bench/models"
for name in BoxInterleaved TextureSettingsTest BoxVertexColors Duck.gltf VertexColorTest; do
    PSPLAT_MODELS=files "$PSPLAT_SOURCE/bench/models" --only "$name" >>out 2>>err || fail "status $?"
done
expect_text out '| BoxInterleaved.gltf | right |'
expect_text out '| TextureSettingsTest.gltf | seen: its row single-sided fails'
expect_text out '| BoxVertexColors.gltf | warned: the clearcoat of material m is left out |'
expect_match out '| Duck.gltf | refused: .*'
expect_text out '| VertexColorTest.gltf | not there |'
expect_text err '1 files: 1 warned'

finish
