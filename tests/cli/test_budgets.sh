# Budgets of time, error and memory; pictures on the way; how progress is shown.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

job="--size 96x54 -p injection=photon:count=3000 $cornell"

# passes_of FILE: how many passes the picture has.
passes_of() {
    "$PSPLAT" info "$1" | sed -n 's/^psplat.passes: //p'
}

# --- time ---

# On whatever machine: it ends long before the passes that it might make, and not before the first; the command that the
# picture names makes it again.
# shellcheck disable=SC2086
run 0 -q $job --time 1s -o a.exr
made=$(passes_of a.exr)
[ "$made" -ge 1 ] && [ "$made" -lt 1000000 ] || fail "$made passes"
run 0 info a.exr
tail -n 1 out >command
expect_match command "--passes $made "
# shellcheck disable=SC2086
run 0 -q $job --passes "$made" -o same.exr
expect_same_pixels a.exr same.exr
# A budget that is no time at all has one pass; fewer passes come first.
# shellcheck disable=SC2086
run 0 -q $job --time 0.000001 -o a.exr
[ "$(passes_of a.exr)" -eq 1 ] || fail "$(passes_of a.exr) passes in no time"
# shellcheck disable=SC2086
run 0 -q $job --time 2h --passes 3 -o a.exr
[ "$(passes_of a.exr)" -eq 3 ] || fail "$(passes_of a.exr) passes of 3"

# --- error ---

# Less error takes more passes; the estimate of the last picture is below what was asked for, and the error itself is
# near it.
# shellcheck disable=SC2086
run 0 -q $job -p estimator=pathtrace:samples=16 -p denoiser=none --seed 5 --passes 64 -o truth.exr
for wanted in 20 8; do
    # shellcheck disable=SC2086
    run 0 $job -p estimator=pathtrace:samples=2 -p denoiser=none --error $wanted% --progress json -o $wanted.exr
    grep '"done"' out >last_line
    expect_match last_line "\"passes\": $(passes_of $wanted.exr),"
    sed 's/.*"error": \([0-9.e+-]*\),.*/\1/' last_line >estimate
    awk -v most=$wanted '{ exit !($1 > 0 && $1 <= most / 100) }' estimate || fail "an estimate of $(cat estimate)"
    run 0 compare truth.exr $wanted.exr --layer indirect --metric rel_rmse --fail "rel_rmse>$(awk -v most=$wanted 'BEGIN { print 1.5 * most / 100 }')"
done
[ "$(passes_of 20.exr)" -lt "$(passes_of 8.exr)" ] || fail "$(passes_of 20.exr) passes for 20 %, $(passes_of 8.exr) for 8 %"
# By the denoiser's estimate.
# shellcheck disable=SC2086
run 0 -q $job --error 50% -o a.exr
[ "$(passes_of a.exr)" -eq 1 ] || fail "$(passes_of a.exr) passes for 50 %"
# shellcheck disable=SC2086
run 2 -q $job --error 2% -p denoiser=gaussian -o no.exr
expect_text err "--error: denoiser 'gaussian' does not estimate its error"

# --- pictures on the way ---

# shellcheck disable=SC2086
"$PSPLAT" -q $job --passes 1000000 --write-every 1h -o way.exr -o way.png >out 2>err &
process=$!
for i in $(seq 50); do
    [ -e way.png ] && break
    sleep 0.1
done
kill -0 $process || fail "it ended"
expect_picture way.exr way.png
[ "$(passes_of way.exr)" -eq 1 ] || fail "the first picture has $(passes_of way.exr) passes"
kill -INT $process
wait $process
check_status $? 130
[ "$(passes_of way.exr)" -gt 1 ] || fail "the last picture has $(passes_of way.exr) passes"

# --- before the first pass ---

area=$PSPLAT_SOURCE/scenes/cornell-area.psd
# wait_for_first OPTION...: keeps what is written first, and ends the render.
wait_for_first() {
    rm -f way.exr first.exr
    "$PSPLAT" -q "$@" --write-every 1h -o way.exr "$area" >out 2>err &
    process=$!
    for i in $(seq 600); do
        ln way.exr first.exr 2>/dev/null && break
        sleep 0.05
    done
    kill -KILL $process
    wait $process 2>/dev/null
}
# Of a large picture there is one of few pixels first, scaled up, without layers; a blurred one of the same light, also of
# a part.
large=1600x900
! is_on PSPLAT_SANITIZE || large=800x450
for part in "" "--crop 300,100,403,301"; do
    # shellcheck disable=SC2086
    wait_for_first --size $large --passes 1000 $part
    run 0 info first.exr
    expect_match out "^channels: B G R$"
    expect_no_text out "psplat.passes"
    # shellcheck disable=SC2086
    run 0 -q --size $large --quality draft $part -o draft.exr "$area"
    run 0 compare draft.exr first.exr --metric bias --metric flip --fail 'flip>0.15'
    awk '$1 == "bias" { exit !($2 > 0.95 && $2 < 1.05 && $3 > 0.95 && $3 < 1.05) }' out || fail "not the light: $(cat out)"
done

# Where there is no time for a pass, the picture is one of these, with the layers; a warning says so.
run 0 -q --size $large --threads 1 --time 0.2s -o short.exr "$area"
expect_match err "^psplat: warning: --time: a draft pass would take about [0-9.e+]* s; the picture is one of [0-9]+x[0-9]+ pixels, scaled up$"
run 0 info short.exr
expect_match out "^short.exr: $large$"
expect_match out "^psplat.passes: 0$"
expect_match out "^psplat.scaled_from: [0-9]+x[0-9]+$"
expect_text out "indirect.R"
expect_text out "made in less time than a pass takes: no command repeats it"
# Not where passes or their quality are asked for, or a film is kept: a pass is made.
small="--size 320x180 -p injection=photon:count=1000 -p denoiser=none $area"
for asked in "--passes 4" "--quality draft" "--checkpoint film.exr"; do
    # shellcheck disable=SC2086
    run 0 -q --time 0.001 $asked -o asked.exr $small
    expect_empty err
    [ "$(passes_of asked.exr)" -eq 1 ] || fail "$(passes_of asked.exr) passes with $asked"
done
# Whatever quality there was time for, the picture's command makes it again.
# shellcheck disable=SC2086
run 0 -q --time 2s -o a.exr $small
made=$(passes_of a.exr)
if [ "$made" -gt 0 ]; then
    run 0 info a.exr
    tail -n 1 out | sed 's/^psplat render/"$PSPLAT" render -q/; s/$/ -o same.exr/' >command
    # shellcheck disable=SC1091
    . ./command || fail "$(cat command)"
    expect_same_pixels a.exr same.exr
fi

# --- memory ---

# shellcheck disable=SC2086
run 1 $job --memory-limit 1M -o no.exr
expect_match err "^psplat: error: a picture of 96x54 pixels takes [0-9]+ MiB of memory to render, and --memory-limit is 1 MiB; a smaller one is had by --size"
# shellcheck disable=SC2086
run 0 -q $job --memory-limit 1T -o a.exr

# A mesh is refused before the scene is made of it: half a million triangles.
awk 'BEGIN {
    n = 500
    for (y = 0; y < n; y++) for (x = 0; x < n; x++) print "v", x / n, 0.1 * sin(x * y), y / n
    for (y = 0; y + 1 < n; y++) for (x = 1; x < n; x++) {
        i = y * n + x
        print "f", i, i + 1, i + n + 1
        print "f", i, i + n + 1, i + n
    }
}' >mesh.obj
cat >mesh.psd <<'END'
psd: 1
camera: {location: [0.5, 1, -1], look_at: [0.5, 0, 0.5]}
lights: [{point: {location: [0.5, 2, 0], intensity: 10}}]
objects:
  - mesh: {file: mesh.obj}
END
run 2 -q --size 32x18 --memory-limit 60M mesh.psd -o mesh.exr
expect_match err "^mesh.psd:5:5: error: the scene's 498002 triangles take [0-9]+ MiB of memory while it is made, and --memory-limit is 60 MiB"
[ ! -e mesh.exr ] || fail "a picture beyond the limit"
run 0 -q --size 32x18 --quality draft --memory-limit 2G mesh.psd -o mesh.exr

# What is asked for is what a render takes, and no more than a fifth over it: with the denoiser, halves of the passes, the
# film's file, and splats.
peak_of() {
    python3 -c 'import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)' "$PSPLAT" -q "$@" "$PSPLAT_SOURCE/scenes/cornell-area.psd"
}
expect_estimate() {
    peak=$(peak_of "$@" -o a.exr) || fail "no peak of $*"
    rm -f a.film.exr
    # A denoiser that takes all light at a time where there is room does with less.
    limit=$((peak * 98 / 100))
    if lean=$(peak_of "$@" --memory-limit ${limit}K -o lean.exr 2>/dev/null); then
        [ "$lean" -le $limit ] || fail "$lean KiB in spite of a limit of $limit: $*"
        expect_same a.exr lean.exr
        peak=$lean
        rm -f a.film.exr
    fi
    run 1 -q "$@" --memory-limit $((peak * 98 / 100))K -o no.exr "$PSPLAT_SOURCE/scenes/cornell-area.psd"
    expect_match err "^psplat: error: a picture of [0-9x]* pixels takes"
    run 0 -q "$@" --memory-limit $((peak * 120 / 100))K -o a.exr "$PSPLAT_SOURCE/scenes/cornell-area.psd"
    rm -f a.film.exr
}
if ! is_on PSPLAT_SANITIZE; then
    few="-t 2 --size 800x500 -p injection=photon:count=1000"
    # shellcheck disable=SC2086
    expect_estimate $few -p estimator=pathtrace:samples=1
    # shellcheck disable=SC2086
    expect_estimate $few -p estimator=ambient --passes 2 --checkpoint a.film.exr
    # shellcheck disable=SC2086
    expect_estimate $few -p estimator=splat -p denoiser=none
fi

# --- progress ---

# shellcheck disable=SC2086
run 0 $job --passes 2 --progress json -o a.exr
expect_match out '^{"stage": "direct light", "fraction": 0.0000, "passes": 0, "error": null, "seconds": [0-9.e+-]+, "seconds_left": null, "bytes": [0-9]+}$'
expect_match out '^{"stage": "done", "fraction": 1.0000, "passes": 2, "error": null, "seconds": [0-9.e+-]+, "seconds_left": [0-9.nul]+, "bytes": [0-9]+}$'
expect_no_text err "%"
# shellcheck disable=SC2086
run 0 $job --passes 2 --progress plain -o a.exr
expect_match err '^psplat:  50 % '
expect_empty out
# shellcheck disable=SC2086
run 0 $job --passes 2 --progress bar -o a.exr
expect_text err "]   0 %  -:-- left  direct light"
# shellcheck disable=SC2086
run 0 $job --progress none -o a.exr
[ "$(cat err)" = "psplat: wrote a.exr" ] || fail "more than the file's name was said"

# --- what is no budget ---

for wrong in time=0 time=x time=5w time=-1s write-every=0s checkpoint-every=1x; do
    # shellcheck disable=SC2086
    run 2 $job --$wrong -o no.exr
    expect_text err "--${wrong%%=*}: expected a time such as 90s, 10m or 2h, got '${wrong#*=}'"
done
for wrong in 0 -1% 101% x%; do
    # shellcheck disable=SC2086
    run 2 $job --error=$wrong -o no.exr
    expect_text err "--error: expected percent such as 2%, got '$wrong'"
done
# shellcheck disable=SC2086
run 2 $job --memory-limit 5X -o no.exr
expect_text err "--memory-limit: expected a size such as 500M or 8G, got '5X'"
# shellcheck disable=SC2086
run 2 $job --progress often -o no.exr
expect_text err "--progress: expected auto, bar, plain, json or none, got 'often'"
[ ! -e no.exr ] || fail "no.exr was written"

finish
