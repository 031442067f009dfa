# psplat schema: what psplat check accepts is valid by it, and what it can know to be wrong is not.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

run 0 schema
cp out schema.json
expect_empty err
expect_text schema.json '"$schema": "https://json-schema.org/draft/2020-12/schema"'
run 2 schema scene.psd
expect_text err "schema: takes no operands"

python3 -c 'import jsonschema, yaml; jsonschema.Draft202012Validator' 2>/dev/null || {
    echo "no python3-jsonschema and python3-yaml: the schema is not tried"
    finish
}

cat >validate.py <<'END_OF_PROGRAM'
import json, sys, jsonschema, yaml


class Loader(yaml.SafeLoader):
    """Takes a merge key whose value is a formula as it stands."""

    def flatten_mapping(self, node):
        for key, value in node.value:
            if key.tag == "tag:yaml.org,2002:merge" and isinstance(value, yaml.ScalarNode):
                key.tag = "tag:yaml.org,2002:str"
        super().flatten_mapping(node)


schema = json.load(open("schema.json"))
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
for path in sys.argv[1:]:
    errors = list(validator.iter_errors(yaml.load(open(path), Loader)))
    print(path, "invalid" if errors else "valid")
    for error in errors:
        print("   ", error.json_path, error.message[:300], file=sys.stderr)
END_OF_PROGRAM

# verdict WORD FILE...: each file is that, valid or invalid. All at once, as Python starts slowly.
verdict() {
    word=$1
    shift
    last="validation of $*"
    python3 validate.py "$@" >out 2>err || fail "the schema is not one: $(tail -n 1 err)"
    for file; do
        grep -qxF "$file $word" out && continue
        fail "$file is not $word:"
        sed 's/^/    /' err
    done
}

verdict valid "$PSPLAT_SOURCE"/scenes/*.psd
awk '/^\.Bd/ { count++; inside = 1; next } /^\.Ed/ { inside = 0 }
     inside { print > ("example" count ".psd") }' "$PSPLAT_SOURCE/man/psd.5"
# shellcheck disable=SC2046
verdict valid $(grep -lx 'psd: 1' example*.psd)
set --
for scene in "$PSPLAT_SOURCE"/tests/fuzz/corpus_psd/*; do
    ! "$PSPLAT" check "$scene" >out 2>err || set -- "$@" "$scene"
done
[ $# -ge 1 ] || fail "no text of the fuzzer's corpus is right"
verdict valid "$@"

cat >start <<'END'
psd: 1
camera: {location: [0, 1, =2+3], look_at: [0, 0, 0]}
END

# wrong TEXT...: these lines after a good start are an error to psplat and to the schema.
texts=100
wrong() {
    texts=$((texts + 1))
    { cat start; printf '%s\n' "$@"; } >wrong$texts.psd
    run 2 check wrong$texts.psd
}

# right TEXT...: to neither.
right() {
    texts=$((texts + 1))
    { cat start; printf '%s\n' "$@"; } >right$texts.psd
    run 0 check right$texts.psd
}

wrong 'imgae: {width: 5}'
wrong 'image: {widht: 5}'
wrong 'image: {width: wide}'
wrong 'image: {width: 70000}'
wrong 'image: {filter: cone}'
wrong 'cameras: {a: {location: [0, 0, 1], look_at: [0, 0]}}'
wrong 'cameras: {a: {location: [0, 0, 1], look_at: [0, 0, 0], angle: 5, vertical_angle: 5}}'
wrong 'cameras: {a: {location: [0, 0, 1], look_at: [0, 0, 0], angle: 180}}'
wrong 'lights: [laser: {}]'
wrong 'lights: [{point: {location: [0, 0, 0]}}]'
wrong 'lights: [{point: {location: [0, 0, 0], intensity: 1, power: 2}}]'
wrong 'lights: [{point: {location: [0, 0, 0], intensity: -1}}]'
wrong 'lights: [{rectangle: {corners: [[0, 0, 0]], power: 1}}]'
wrong 'materials: {a: {}}'
wrong 'materials: {a: {diffuse: 2}}'
wrong 'materials: {a: {diffuse: 1, mirror: 1}}'
wrong 'materials: {a: {diffuse: {chequer: {colors: [0, 1]}}}}'
wrong 'materials: {a: {diffuse: {checker: {colors: [0]}}}}'
wrong 'materials: {a: {mix: [{weight: 1}]}}'
wrong 'materials: {a: {diffuse: 1}}' 'objects: [{torus: {radius: 1, material: a}}]'
wrong 'materials: {a: {diffuse: 1}}' \
    'objects: [{torus: {radius: 1, minor_radius: 0.5, material: a, scale: 2, matrix: [1]}}]'
wrong 'materials: {a: {diffuse: 1}}' \
    'objects: [{torus: {radius: 1, minor_radius: 0.5, material: a, transform: [{scal: 2}]}}]'
wrong 'groups: {a: [{mesh: {file: a.obj, use: [geometri]}}]}'
wrong 'render: {filter: {gaussian: {}, box: {}}}'

right 'lights: [point: {location: [0, 0, 0], intensity: 1e6}, {for: i, in: [1], do: []}]' \
    'image: {width: =4*5, exposure: -1e-1}' 'objects:' 'materials: {m: {diffuse: .5}}'
right 'define: {p: {location: [0, 0, 0], intensity: 1}, v: [1, 2, 3]}' \
    'lights: [point: {<<: =p}, point: =p, spotlight: {<<: =p, point_at: =v}]' \
    'materials: {a: &a {diffuse: {noise: {colors: [0, [0, 1, 0]]}}, emission_both: on}, b: *a}' \
    'render: {filter: gaussian, denoiser: {gaussian: }, light_samples: 8}'

verdict invalid wrong*.psd
verdict valid right*.psd

finish
