# The add-on for Blender: scenes come out as in Cycles, and what an engine does beside the picture. docs/blender.md has the
# means of the scenes. Skips without Blender or its numpy.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

command -v blender >blender_path || skip "no blender"
# The leak checker would look through each of many runs, and Blender is not ours.
is_on PSPLAT_SANITIZE && skip "Blender runs psplat as others do, without sanitizers"
ln -s "$PSPLAT" psplat
PATH=$PWD:$PATH
mkdir -p scripts/addons pictures
cp "$PSPLAT_SOURCE/blender/psplat_render.py" scripts/addons
BLENDER_USER_SCRIPTS=$PWD/scripts
PYTHONDONTWRITEBYTECODE=1
export PATH BLENDER_USER_SCRIPTS PYTHONDONTWRITEBYTECODE

# blender_python SCRIPT WORD...: its output goes to `out`, without the progress of renders.
blender_python() {
    script=$PSPLAT_SOURCE/tests/blender/$1
    shift
    last="blender --python $script -- $*"
    timeout 1800 blender -b --factory-startup --python-exit-code 1 --python "$script" -- "$@" >log 2>&1 </dev/null
    status=$?
    grep -v '^Fra:' log >out
    [ $status -eq 0 ] || {
        fail "exit status $status"
        sed 's/^/    /' out
    }
}

blender -b --factory-startup --python-exit-code 1 --python-expr 'import numpy' >out 2>&1 || skip "no numpy in Blender"
blender --version >out 2>&1
grep -q '^Blender 3\.4' out || skip "$(head -n 1 out), and not Blender 3.4"

# --- the engine ---

blender_python check.py pictures
expect_text out "Warning: Velvet: Velvet BSDF: psplat does not know this shader; it counts as grey"

# --- the scenes ---

scenes=
[ -z "${PSPLAT_QUICK:-}" ] || scenes="spot world_picture texture"
# shellcheck disable=SC2086
blender_python compare.py pictures $scenes --samples 64 --limit 2 --blocks 15
grep '^SCENE' out

# --- interrupts ---

# passes_of FILE KEY: how many passes a picture or a film says that it has, or 0.
passes_of() {
    "$PSPLAT" info "kept/ViewLayer-0001/$1" 2>/dev/null | sed -n "s/^psplat.$2//p" | grep . || echo 0
}

# interrupt PASSES: starts Blender, lets it write a picture of more than so many passes, and presses ^C.
interrupt() {
    blender -b --factory-startup --python "$PSPLAT_SOURCE/tests/blender/stop.py" -- "$PWD/kept" >log 2>&1 </dev/null &
    blender=$!
    for _ in $(seq 1200); do
        [ "$(passes_of picture.exr 'passes: ')" -le "$1" ] || break
        sleep 0.1
    done
    kill -INT $blender
    wait $blender
    expect_picture kept/ViewLayer-0001/picture.exr kept/ViewLayer-0001/film.exr
    expect_text kept/ViewLayer-0001/state.json '"whole": false'
}

interrupt 0
first=$(passes_of film.exr 'pass_set: 0:')
interrupt "$first"
second=$(passes_of film.exr 'pass_set: 0:')
[ "$first" -ge 1 ] && [ "$second" -gt "$first" ] || fail "a film of $first passes went on to $second"

finish
