# Renders that are stopped, or whose stages fail: what was done by then is written, and it is said what is missing.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

# interrupt SIGNAL STATUS PASSES WORD...: starts psplat, waits until it is at indirect light and has so many passes, and
# sends the signal.
interrupt() {
    signal=$1 status=$2 passes=$3
    shift 3
    last="psplat $* and SIG$signal"
    rm -rf new && mkdir new
    : >out # the last one's lines don't count
    "$PSPLAT" "$@" --progress json --stats new/a.json -o new/a.exr -o new/a.png "$cornell" >out 2>err &
    process=$!
    while ! grep -q "indirect light.*\"passes\": $passes" out && kill -0 $process; do
        sleep 0.1
    done
    kill "-$signal" $process || fail "it ended before the signal"
    wait $process
    check_status $? "$status"
    expect_text err "psplat: interrupted: finishing this batch, then writing the picture without what is left"
    expect_text err "psplat: error: interrupted: the picture holds what was done by then"
    expect_files a.exr a.png a.json
    expect_picture new/a.exr new/a.png
    run 0 info new/a.exr
    expect_text out "new/a.exr: 48x27"
}

# Many passes: those that were complete make the picture.
interrupt INT 130 "[1-9]" --size 48x27 --passes 1000000 -p injection=photon:count=5000
expect_match new/a.json '"passes": [0-9]+'
expect_no_text new/a.json '"passes": 0'
expect_no_text new/a.json '"passes": 1000000'
expect_no_text err "is not denoised"

# One endless pass: direct light alone, which is what black indirect light gives.
interrupt TERM 143 0 --size 48x27 -p estimator=splat -p injection=photon:count=2000000000
expect_match new/a.json '"passes": 0,?$'
expect_text out "psplat.passes: 0"
expect_text out "interrupted in its first pass"
expect_no_text out "psplat render"

# --- a second signal, of either kind, ends it at once and writes nothing ---

stages=$PSPLAT_SOURCE/tests/plugins/failing_stage.c
compile_module "$PSPLAT_SOURCE/include" "$stages" "$PWD/deaf.so" -DRESULT=PS_CANCELLED -DDEAF=1
for signals in "INT TERM" "TERM INT" "INT INT" "TERM TERM"; do
    rm -rf new && mkdir new
    : >err
    last="SIG${signals% *}, then SIG${signals#* }"
    "$PSPLAT" --size 48x27 -p denoiser=./deaf.so -o new/a.exr "$cornell" >out 2>err &
    process=$!
    while ! grep -q "waiting" err && kill -0 $process; do
        sleep 0.1
    done
    kill "-${signals% *}" $process
    while ! grep -q "a second signal ends at once" err && kill -0 $process; do
        sleep 0.1
    done
    kill "-${signals#* }" $process
    wait $process
    status=$?
    [ $status -eq 130 ] || [ $status -eq 143 ] || fail "exit status $status"
    expect_files
done

# --- stages that fail: the picture is there without them ---

compile_module "$PSPLAT_SOURCE/include" "$stages" "$PWD/failing.so"
run 0 -q $small --passes 2 -o whole.exr "$cornell"
run 2 -q $small --passes 2 -o without.exr -p denoiser=./failing.so "$cornell"
expect_text err "psplat: warning: denoiser failing failed; the picture is not denoised"
expect_text err "psplat: error: denoiser failing failed"
expect_same_pixels whole.exr without.exr
run 2 -q $small --passes 2 -o without.exr -p normalization=./failing.so "$cornell"
expect_text err "psplat: warning: normalization failing failed; the picture is normalized by density"
expect_same_pixels whole.exr without.exr
# The third of five passes.
run 2 $small --passes 5 -o some.exr -p estimator=./failing.so "$cornell"
expect_text err "psplat: warning: a pass failed; the picture holds those before it"
expect_text err "psplat: error: estimator failing failed"
run 0 $small --passes 2 -o two.exr -p estimator=./failing.so "$cornell"
expect_same_pixels two.exr some.exr
run 0 info some.exr
expect_text out "psplat.passes: 2"

# --- stages that are stopped ---

compile_module "$PSPLAT_SOURCE/include" "$stages" "$PWD/waiting.so" -DRESULT=PS_CANCELLED
: >err
last="a denoiser that is stopped"
"$PSPLAT" $small --passes 2 -o stopped.exr -p denoiser=./waiting.so "$cornell" >out 2>err &
process=$!
while ! grep -q waiting err && kill -0 $process; do
    sleep 0.1
done
kill -TERM $process
wait $process
check_status $? 143
expect_text err "psplat: warning: denoiser failing was stopped; the picture is not denoised"
expect_same_pixels whole.exr stopped.exr

finish
