# The measurements of bench/speed, bench/marks, bench/preview, bench/scaling, bench/passes, bench/ranks, bench/renderers, bench/throughput, bench/occlusion and bench/methods run, at small
# sizes, and say what they should of times that are made up. No time is asserted.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

command -v python3 >/dev/null || skip "bench/speed needs python3"
is_on PSPLAT_SANITIZE && skip "other tests run the program; its measurements are Python"
bench=$PSPLAT_SOURCE/bench
PYTHONDONTWRITEBYTECODE=1
export PSPLAT PYTHONDONTWRITEBYTECODE

# measure STATUS COMMAND WORD...: a program of the folder bench, as `run` does with psplat.
measure() {
    expected=$1 program=$2
    shift 2
    last="bench/$program $*"
    "$bench/$program" --work work --out results "$@" >out 2>err </dev/null
    check_status $? "$expected"
}

# number FILE EXPRESSION: of a JSON file, which is called `d`.
number() {
    python3 -c "import json, sys; d = json.load(open(sys.argv[1])); print($2)" "$1" || fail "no $2 in $1"
}

# true_of TEXT EXPRESSION: a Python expression.
true_of() {
    python3 -c "import sys; sys.exit(not ($2))" || fail "$1: not $2"
}

expect_drawing() {
    if command -v gnuplot >/dev/null; then
        expect_text "$1" "</svg>"
    else
        expect_text err "not drawn: there is no gnuplot"
    fi
}

# --- times to an error and their ratios, from curves that are made up ---

PYTHONPATH=$bench/speed.d python3 - >out 2>err <<'END' || { fail "curves:"; cat err; }
import math
from types import SimpleNamespace

from curve import AT, NEVER, WITHIN, Reach, error_at, ratio_text, reach_text, time_to
from equal import rung_at
from render import Run

slope = [(1.0, 0.4), (4.0, 0.2), (16.0, 0.1)]  # error = 0.4 / sqrt(time)
assert time_to(slope, 0.4) == Reach(WITHIN, 1.0)
assert time_to(slope, 0.5) == Reach(WITHIN, 1.0)
reach = time_to(slope, 0.3)
assert reach.kind == AT and abs(reach.seconds - 16 / 9) < 1e-9, reach
reach = time_to(slope, 0.1)
assert reach.kind == AT and abs(reach.seconds - 16) < 1e-9, reach
assert time_to(slope, 0.09) == Reach(NEVER, 16.0)
assert time_to([], 0.1) is None
assert abs(error_at(slope, 2.0) - 0.4 / math.sqrt(2)) < 1e-9
assert abs(error_at(slope, 4.0) - 0.2) < 1e-9
assert error_at(slope, 0.9) is None and error_at(slope, 17.0) is None
# There and back, and there sooner: the least time counts.
twice = [(10.0, 0.4), (40.0, 0.2), (1.0, 0.4), (4.0, 0.2)]
assert abs(time_to(twice, 0.2).seconds - 4) < 1e-9

# Between two steps of a ladder: a quarter of the way in the logarithms. Never past its ends.
ladder = [(1.0, {"n": "100", "x": "0.2", "of": "cone"}), (16.0, {"n": "1600", "x": "0.2", "of": "box"})]
assert rung_at(ladder, 2.0) == {"n": "200", "x": "0.2", "of": "cone"}, rung_at(ladder, 2.0)
assert rung_at(ladder, 0.5) == ladder[0][1] and rung_at(ladder, 20.0) == ladder[1][1]
assert rung_at([(1.0, {"x": "1e-4"}), (4.0, {"x": "4e-4"})], 2.0) == {"x": "0.0002"}
assert rung_at([(1.0, {"n": "1"})], 2.0) == {"n": "1"}

assert reach_text(Reach(AT, 2.0)) == "2 s"
assert reach_text(Reach(WITHIN, 2.0)) == "<= 2 s"
assert reach_text(Reach(NEVER, 2.0)) == "not reached"
assert ratio_text(Reach(AT, 6.0), Reach(AT, 2.0)) == "3x"
assert ratio_text(Reach(AT, 6.0), Reach(WITHIN, 2.0)) == "> 3x"
assert ratio_text(Reach(NEVER, 6.0), Reach(AT, 2.0)) == "> 3x"
assert ratio_text(Reach(WITHIN, 6.0), Reach(AT, 2.0)) == "< 3x"
assert ratio_text(Reach(WITHIN, 6.0), Reach(WITHIN, 2.0)) == "both at once"
assert ratio_text(Reach(AT, 6.0), Reach(NEVER, 2.0)) == "not reached"

# On a busy machine files take more seconds of the clock than the whole process of the processor.
usage = SimpleNamespace(ru_utime=0.75, ru_stime=0.25, ru_maxrss=1)
run = Run({"seconds": {"load": 1.0, "write": 2.0}, "counters": {}, "bytes": {}}, 4.0, usage, None)
assert run.wall_rendering == 1 and run.cpu_rendering == 0.25
END

# --- bench/speed ---

measure 0 speed --quick
expect_text err "reference cornell-96x54-1-a.exr: "
expect_no_text err "reused"
expect_same out results/speed.md
python3 -m json.tool results/speed.json >json || fail "speed.json is no JSON"
methods=$(sed -n 's/^\[\(.*\)\]$/\1/p' "$bench/speed.d/methods.ini")
for method in $methods; do
    expect_match results/speed.md "^\| $method \| (<= )?[0-9n].* %"
    expect_text json "\"name\": \"$method\""
done
expect_text results/speed.md "| pathtrace | splat |"
expect_text results/speed.md "not reached"
[ "$(number results/speed.json 'len(d["groups"][0]["methods"][0]["points"])')" = 2 ] || fail "not two rungs"
[ "$(grep -c '^0,pathtrace,' results/speed.csv)" = 2 ] || fail "speed.csv has not two points of path tracing"
expect_drawing results/speed.svg
grep -q '"estimate":' json && grep -q '"splat":' json || fail "no seconds by stage in speed.json"

measure 0 speed --quick --methods pathtrace --rungs 1 --repeats 2
[ "$(grep -c reused err)" -eq 2 ] || fail "the reference was not used again"
[ "$(number results/speed.json 'd["groups"][0]["methods"][0]["points"][0]["repeats"]')" = 2 ] ||
    fail "not two repeats"
expect_no_text results/speed.md "| splat"

# What a render that was interrupted leaves of a reference is not used.
printf '#!/bin/sh\n"%s" "$@"\n[ "$1" != render ] || exit 130\n' "$PSPLAT" >interrupted
chmod +x interrupted
rm -rf work
measure 1 speed --quick --methods pathtrace --rungs 1 --psplat "$PWD/interrupted"
expect_text err "status 130 of $PWD/interrupted render "
measure 0 speed --quick --methods pathtrace --rungs 1
expect_no_text err reused

# Each method by both denoisers, and pictures at equal time.
measure 0 speed --quick --methods pathtrace,photonmap --denoisers none,regression --pictures 0.01
for denoiser in none regression; do
    expect_text results/speed.md "## cornell, 96x54, 1 bounce, 1 thread, denoiser=$denoiser"
    for picture in pathtrace photonmap reference; do
        [ -s results/cornell-1-1-$denoiser-$picture.png ] || fail "no picture $denoiser-$picture"
    done
    if command -v montage >/dev/null; then
        [ -s results/cornell-1-1-$denoiser.jpg ] || fail "no sheet of pictures"
    else
        expect_text err "there is no montage"
    fi
done
[ "$(number results/speed.json 'len(d["groups"][1]["equal"])')" = 2 ] || fail "not two methods at equal time"
true_of "denoised path tracing has less error" "$(number results/speed.json 'd["groups"][1]["equal"][0]["error"]') < \
    0.9 * $(number results/speed.json 'd["groups"][0]["equal"][0]["error"]')"

# A noisy reference finds the error that a good one finds; as it stands, it would be half as large again.
error_with() {
    measure 0 speed --quick --methods splat-best --rungs 1 --reference-samples "$1"
    expect_no_text err reused
    number results/speed.json "d['groups'][0]['methods'][0]['points'][0]['$2']"
}
noisy=$(error_with 256 error)
measured=$(number results/speed.json "d['groups'][0]['methods'][0]['points'][0]['measured_error']")
good=$(error_with 1024 error)
true_of "noise of the reference" "abs($noisy / $good - 1) < 0.25 and $measured > 1.5 * $good"

measure 0 speed --quick --scenes conference --mesh /nowhere/conference.obj
expect_text results/speed.md "Left out: conference: there is no /nowhere/conference.obj."
measure 1 speed --quick --scenes nowhere
expect_text err "speed: error: no scene 'nowhere'; there are: cornell, cornell-area, cornell-spheres, "
measure 0 speed --quick --scenes cornell --methods all --rungs 1
expect_text results/speed.md "| lightcuts |"
measure 1 speed --quick --methods guess
expect_text err "no method 'guess'; there are: gather"
measure 1 speed --quick --methods pathtrace --denoisers nothing
expect_text err "no denoiser 'nothing'"
measure 1 speed --quick --psplat /nowhere/psplat
expect_text err "no program '/nowhere/psplat'"
measure 2 speed --quick --targets 0
printf '[wrong]\noptions: estimator=nothing\n*:\n    x=1\n' >wrong.ini
measure 1 speed --quick --table wrong.ini
expect_text err "no estimator 'nothing'"

# --- bench/marks: against a picture that is direct light alone, all indirect light is an error ---

area=$PSPLAT_SOURCE/scenes/cornell-area.psd
mkdir -p reference/pictures
plain="--size 64x36 -q -p denoiser=none --set render.aa_samples=1"
# shellcheck disable=SC2086
run 0 "$area" $plain -p estimator=pathtrace:samples=16 --bounces all -o reference/pictures/A_full.exr
# shellcheck disable=SC2086
run 0 "$area" $plain -p estimator=ambient:irradiance=0 -o reference/pictures/A_direct.exr
cat >reference/README.md <<'END'
| another | table |
|---|---|
| 1 | 2 |

## The marks to beat (of some machine)

| renderer, method | seconds | error | bias |
|---|---|---|---|
| Another renderer, 16 samples | 3.2 | 35 % | 1.000 |

## Another heading
| no mark | 1 | 2 | 3 |
END
printf '[dark]\noptions: estimator=ambient:irradiance={light}\n*:\n    light=0\n' >dark.ini
measure 0 marks --quick --reference reference/pictures --size 64x36 --table dark.ini
expect_match out '^\| psplat dark: light=0 \| [0-9.]+ \| 100 % \| 0\.5[0-9]* \|$' # its bias with the lamp: 0.75
expect_text out "| Another renderer, 16 samples | 3.2 | 35 % | 1.000 |"
expect_no_text out "no mark"
python3 -m json.tool results/marks.json >/dev/null || fail "marks.json is no JSON"
measure 0 marks --quick
expect_text out 'skipped: --reference names no folder'
measure 0 marks --quick --reference nowhere
expect_match out '^skipped: there is no .*A_full.exr'

# --- bench/preview ---

measure 0 preview --quick
expect_text err "left out: conference: --mesh names no conference.obj"
expect_match out '^\| cornell \| [0-9.]+ \| [0-9.]+ \| [0-9.]+ \| [0-9.]+ \|$'
true_of "preview.json" "$(number results/preview.json "d['scenes'][0]['picture'] > 0 < d['scenes'][0]['loading']")"

# --- bench/scaling ---

measure 0 scaling --quick
[ "$(wc -l <results/scaling.csv)" -eq 33 ] || fail "scaling.csv has not 32 points"
expect_match results/scaling.csv '^series,x,threads,photons,'
expect_match results/scaling.csv '^pixels,32400,2,'
# 64 times the lights; asked one by one they would cost more than ten times.
processor_seconds() {
    awk -F, -v series="$1" -v x="$2" '$1 == series && $2 == x && $3 == 1 { print $7 }' results/scaling.csv
}
true_of "lights" "$(processor_seconds lights 1024) < 4 * $(processor_seconds lights 16)"
true_of "rooms" "$(processor_seconds rooms 9) < 5 * $(processor_seconds rooms 1)"
true_of "instances" "$(processor_seconds instances 100000) < 20 * $(processor_seconds instances 1000)"
# Bytes for each triangle that is added, with the ray tracer's tree and what it needs to build it; for each instance.
bytes_each() {
    awk -F, -v series="$1" '$1 == series && $3 == 1 { x[++n] = $2; bytes[n] = $9 } END { print (bytes[n] - bytes[1]) / (x[n] - x[1]) }' results/scaling.csv
}
true_of "bytes of a triangle" "0 < $(bytes_each triangles) < 200"
true_of "bytes of an instance" "0 < $(bytes_each instances) < 1000"
measure 0 scaling --quick --series instances --threads 1
[ "$(wc -l <results/scaling.csv)" -eq 3 ] || fail "scaling.csv has not 2 points"
measure 1 scaling --quick --series instances,dances
expect_text results/scaling.md "| wall seconds with instances | 1000 to 100000 |"
measure 0 scaling --quick --series paths,pixels,passes
expect_text results/scaling.md "| indirect seconds with paths | 3162 to 10000 |"
expect_drawing results/scaling.svg

# --- bench/passes ---

measure 0 passes --quick
[ "$(wc -l <results/passes.csv)" -eq 7 ] || fail "passes.csv has not 6 points"
expect_match results/passes.csv '^0,none,1,[0-9.]+,NaN$'
expect_match results/passes.csv '^0,none,4,[0-9.]+,[0-9.]+$'
expect_match results/passes.md '^\| regression \| 4 \| [0-9.]+ % \| [0-9.]+ % \| [0-9.]+ \|$'
true_of "the rate of Monte Carlo" "-0.7 < $(sed -n 's/^Exponent with denoiser=none: \(.*\)\.$/\1/p' results/passes.md) < -0.3"
expect_drawing results/passes.svg

# --- bench/ranks ---

if command -v mpirun >/dev/null && [ -n "$(find "$PSPLAT_BUILD" -path '*/psplat/mpi.so')" ]; then
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_btl=self,vader
    measure 0 ranks --quick --ranks 1,2
    expect_match results/ranks.md '^\| 2 \| [0-9.]+ s \| [0-9.]+ s \| [0-9.]+ \|$'
    expect_match results/ranks.md '^\| 100 \| [0-9.]+% \| [0-9]+ \| (0\.9|1\.0)[0-9]+ \|' # the model, beside the simulation
fi

# --- bench/renderers: beside those that there are ---

measure 0 renderers --quick
expect_match results/renderers.md '^\| 1000 \| [0-9.]+ s, [0-9]+ MB, [0-9.]+ % \|'
expect_match results/renderers.md '^\| 10 \| [0-9.]+ s, [0-9]+ MB, [0-9.]+ % \|'
for pair in povray:povray Cycles:blender; do
    if command -v "${pair#*:}" >/dev/null; then
        [ "$(number results/renderers.json "sum(p['renderer'] == '${pair%:*}' for p in d['points'])")" = 2 ] || fail "not two pictures by $pair"
    else
        expect_text results/renderers.md "Left out: ${pair%:*}: there is no ${pair#*:}."
    fi
done
measure 2 renderers --lights few

# --- bench/throughput ---

sed -e 's/width: 1600, height: 900/width: 96, height: 54/' -e 's/count: [0-9]*/count: 1000/' "$cornell" >small.psd
last="bench/throughput"
"$bench/throughput" "$PSPLAT" small.psd >out 2>err
check_status $? 0
expect_match out '^baseline +[0-9.]+ G +[0-9.]+ % +[0-9.]+ M$'
"$bench/throughput" nowhere >out 2>err
check_status $? 2
expect_text err "there is no program nowhere"
"$bench/throughput" --help >out 2>err
check_status $? 0
expect_match out 'bench/throughput \[PSPLAT \[SCENE\]\]'

# --- bench/occlusion ---

last="bench/occlusion"
"$bench/occlusion" 96x54 >out 2>err
check_status $? 0
expect_empty err
error_of() { sed -n "s/^| $1 | \([0-9.]*\) % .*/\1/p" out; }
true_of "horizons are closer than samples" \
    "$(error_of 'hbao, radius 100, 16x64 samples') < $(error_of 'ssao, radius 8, 256 samples') < $(error_of ambient)"

# --- bench/methods: the pictures that docs/methods.md shows, which has each estimator ---

last="bench/methods"
"$bench/methods" pictures 96x54 4 >out 2>err
check_status $? 0
expect_empty err
methods=$PSPLAT_SOURCE/docs/methods.md
grep -o 'pictures/methods/[a-z_-]*\.png' "$methods" | sed 's|.*/||' | sort -u >shown
ls pictures | sort >made
expect_same shown made
ls "$PSPLAT_SOURCE/docs/pictures/methods" | sort >kept
expect_same shown kept
run 0 plugins estimator
for estimator in $(sed -n 's/^  \([a-z_]*\) .*/\1/p' out); do
    expect_text "$methods" "-p estimator=$estimator"
done

# --- bench/pictures: those that README.md and docs/ show; the LBNL conference room's mesh is not shipped ---

last="bench/pictures"
if command -v montage >/dev/null; then
    "$bench/pictures" sheets '' 8 >out 2>err
    check_status $? 0
    expect_empty err
    for picture in cornell.png plate.png corridor.png columns.png lanterns.jpg pixel.png beside-others.jpg; do
        [ -s "sheets/$picture" ] || fail "no $picture"
        grep -q "pictures/$picture" "$PSPLAT_SOURCE/README.md" "$PSPLAT_SOURCE"/docs/*.md || fail "nobody shows $picture"
    done
fi

# --- scripts that know arguments alone ---

for script in compare methods occlusion pictures throughput; do
    last="bench/$script"
    "$bench/$script" --help >out 2>err
    check_status $? 0
    expect_empty err
    grep -q "^$script: " out || fail "its help does not begin with its name"
    "$bench/$script" --frob >out 2>err
    check_status $? 2
    expect_empty out
done

finish
