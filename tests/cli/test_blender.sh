# The add-on for Blender: scenes come out as in Cycles, and what an engine does beside the picture. docs/blender.md has the
# means of the scenes. Skips without Blender or its numpy.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

command -v blender >blender_path || skip "no blender"
# The leak checker would look through each of many runs, and Blender is not ours.
is_on PSPLAT_SANITIZE && skip "Blender runs psplat as others do, without sanitizers"
cat >psplat <<END
#!/bin/sh
echo \$\$ >'$PWD/psplat_process'
exec '$PSPLAT' "\$@"
END
chmod +x psplat
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
for name in Nowhere Far Hole; do
    expect_text out "Warning: $name is left out: it has numbers that are not finite"
done
expect_text out "Warning: Line is left out: none of its faces has an area"

# --- the scenes ---

scenes=
[ -z "${PSPLAT_QUICK:-}" ] || scenes="spot world_picture texture"
# shellcheck disable=SC2086
blender_python compare.py pictures $scenes --samples 64 --limit 2 --blocks 15
grep '^SCENE' out

# --- interrupts ---

frame=kept/Scene/ViewLayer/0001

# passes_of FILE KEY: how many passes a picture or a film says that it has, or 0.
passes_of() {
    "$PSPLAT" info "$frame/$1" 2>/dev/null | sed -n "s/^psplat.$2//p" | grep . || echo 0
}

# interrupt SIGNAL PASSES: starts Blender in a session of its own, as a terminal does, lets it write a picture of more than so
# many passes, and sends the signal to all of the session. ^C is INT.
interrupt() {
    setsid blender -b --factory-startup --python "$PSPLAT_SOURCE/tests/blender/stop.py" -- "$PWD/kept" >log 2>&1 </dev/null &
    blender=$!
    for _ in $(seq 1200); do
        [ "$(passes_of picture.exr 'passes: ')" -le "$2" ] || break
        sleep 0.1
    done
    kill -s "$1" -- -$blender
    wait $blender 2>/dev/null
}

# stop PASSES: ^C leaves a picture, and a film to go on with.
stop() {
    interrupt INT "$1"
    expect_picture $frame/picture.exr $frame/film.exr
    expect_text $frame/state.json '"whole": false'
}

stop 0
first=$(passes_of film.exr 'pass_set: 0:')
[ "${first:-0}" -ge 1 ] || { fail "no film after the first stop"; finish; }
stop "$first"
second=$(passes_of film.exr 'pass_set: 0:')
[ "$first" -ge 1 ] && [ "$second" -gt "$first" ] || fail "a film of $first passes went on to $second"

interrupt KILL "$second"
for _ in $(seq 200); do
    kill -0 "$(cat psplat_process)" 2>/dev/null || break
    sleep 0.1
done
kill -KILL "$(cat psplat_process)" 2>/dev/null && fail "psplat goes on where Blender was killed"

finish
