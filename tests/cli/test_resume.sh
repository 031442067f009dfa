# Jobs that end before their time go on where they were, and their film is that of a run that was left in peace; the
# file on disk is always whole.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

passes=2000 kills=20
[ -n "$PSPLAT_QUICK" ] && passes=600 kills=5
is_on PSPLAT_SANITIZE && passes=$((passes / 4)) # each takes four times as long
job="-q --size 96x54 -p injection=photon:count=3000 -p estimator=pathtrace:samples=2 --passes $passes $cornell"

# shellcheck disable=SC2086
run 0 $job --checkpoint whole.exr -o whole.png

# --- kill -9 at any moment ---

killed=0
pause=1
while [ $killed -lt $kills ]; do
    # shellcheck disable=SC2086
    "$PSPLAT" $job --checkpoint part.exr --checkpoint-every 0.02s --resume -o part.png >out 2>err &
    process=$!
    sleep "0.$((pause * 3 + 9))" # 0.12 to 0.39 s
    pause=$((pause * 7 % 11))
    kill -KILL $process 2>kill_err || break # it was done
    wait $process 2>kill_err
    killed=$((killed + 1))
    [ ! -e part.exr ] || run 0 resolve -q part.exr -o whole_film.png
done
wait
# shellcheck disable=SC2086
run 0 $job --checkpoint part.exr --resume -o part.png
expect_same whole.exr part.exr
expect_same whole.png part.png
[ $killed -eq $kills ] || echo "it was done after $killed kills"
[ $killed -gt 1 ] || fail "it was killed $killed times alone"
rm -f .part.exr.* # of writes that were killed
expect_files_here() { [ "$(ls "$1"* | wc -l)" -eq 1 ] || fail "more than one $1"; }
expect_files_here part.exr
# Of a film that is whole, nothing is left to do.
# shellcheck disable=SC2086
run 0 $job --checkpoint part.exr --resume -o again.png
expect_same whole.png again.png

# --- signals ---

for signal in INT TERM; do
    rm -f ./*.exr
    : >err
    last="SIG$signal"
    # shellcheck disable=SC2086
    "$PSPLAT" $job --passes 1000000 --checkpoint part.exr -o part.exr.png >out 2>err &
    process=$!
    sleep 0.5
    kill -$signal $process
    wait $process
    check_status $? "$([ $signal = INT ] && echo 130 || echo 143)"
    expect_text err "interrupted: the picture holds what was done by then"
    run 0 resolve -q part.exr -o resolved.png
    expect_picture part.exr.png resolved.png
done

# What was interrupted goes on, with more passes than were asked for first.
"$PSPLAT" info part.exr | sed -n 's/^psplat.pass_set: 0://p' >done_by_then
more=$(($(cat done_by_then) + 3))
# shellcheck disable=SC2086
run 0 $job --passes $more --checkpoint part.exr --resume -o more.png
run 0 info part.exr
expect_match out "^psplat.pass_set: 0:$more\$"

# Of passes with gaps, no command makes the picture again.
# shellcheck disable=SC2086
run 0 $job --passes 1:2 --checkpoint gap.exr
# shellcheck disable=SC2086
run 0 $job --passes 3:4 --checkpoint gap.exr --resume -o gap_picture.exr
run 0 info gap_picture.exr
expect_text out "psplat.passes: 2"
expect_text out "no command repeats it"
# shellcheck disable=SC2086
run 0 $job --passes 1:4 --checkpoint gap.exr --resume -o gap_picture.exr
run 0 info gap_picture.exr
expect_text out " --passes 1:4 "

# SIGUSR1 writes now, and the render goes on.
rm -f ./*.exr ./*.png
# shellcheck disable=SC2086
"$PSPLAT" $job --passes 1000000 --checkpoint part.exr -o now.png >out 2>err &
process=$!
sleep 0.3
[ ! -e now.png ] || fail "now.png is there before it was asked for"
kill -USR1 $process
for i in 1 2 3 4 5 6 7 8 9 10; do
    [ -e now.png ] && [ -e part.exr ] && break
    sleep 0.2
done
kill -0 $process || fail "it ended"
expect_picture now.png
run 0 resolve -q part.exr -o resolved.png

# --- two processes on one film, and films that are there ---

# shellcheck disable=SC2086
run 1 $job --checkpoint part.exr --resume -o other.png
expect_text err "another process is at work on 'part.exr'"
kill -KILL $process
wait $process 2>kill_err
# shellcheck disable=SC2086
run 2 $job --checkpoint part.exr -o other.png
expect_text err "--checkpoint: 'part.exr' is there already; --resume goes on with it"
cp part.exr kept.exr
# shellcheck disable=SC2086
run 2 $job --seed 3 --checkpoint part.exr --resume -o other.png
expect_text err "can't go on with 'part.exr': it is of another job, which differs in the seed, '0' and '3'"
expect_same part.exr kept.exr
head -c 3000 kept.exr >cut.exr
# shellcheck disable=SC2086
run 1 $job --checkpoint cut.exr --resume -o other.png
expect_text err "cannot read 'cut.exr'"
# shellcheck disable=SC2086
run 2 $job --resume
expect_text err "--resume needs --checkpoint FILE.exr, which names the film"
# shellcheck disable=SC2086
run 2 $job --checkpoint-every 5s
expect_text err "--checkpoint-every needs --checkpoint FILE.exr"
# shellcheck disable=SC2086
run 2 $job --checkpoint film.png
expect_text err "--checkpoint: a film needs a name that ends in .exr"
# shellcheck disable=SC2086
run 1 $job --checkpoint missing/film.exr
expect_text err "can't write 'missing/film.exr'"
[ ! -e other.png ] || fail "other.png was written"

finish
