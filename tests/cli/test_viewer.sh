# The picture in a viewer beside the render (--display tev), by a stand-in that speaks tev's protocol: what is shown at last
# is what is written, and a viewer that is absent, gone, or asleep costs a warning and no picture.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

cornell=$PSPLAT_SOURCE/scenes/cornell.psd
job="--size 96x54 -t 2 -p injection=photon:count=200 --compression none"

# start_viewer KIND: its port in $port, its process in $viewer.
start_viewer() {
    rm -rf port shown
    mkdir shown
    python3 "$PSPLAT_SOURCE/tests/cli/tev.py" "$1" port shown 2>viewer-errors &
    viewer=$!
    for i in $(seq 100); do
        [ -e port ] && break
        sleep 0.1
    done
    port=$(cat port)
}

end_viewer() {
    wait $viewer || fail "the viewer: $(cat viewer-errors)"
}

# --- shown as it is written ---

start_viewer listen
# shellcheck disable=SC2086
run 0 -q $job --passes 3 --display tev:127.0.0.1:"$port" -o a.exr "$cornell"
expect_empty err
end_viewer
python3 "$PSPLAT_SOURCE/tests/cli/tev.py" same shown a.exr >differs || fail "$(cat differs)"
grep -q "^create cornell.psd 96x54 " shown/log || fail "created: $(cat shown/log)"
[ "$(grep -c ^create shown/log)" -eq 1 ] || fail "created more than once"
# After the first pass, and at the end.
[ "$(grep -c "^shown cornell.psd" shown/log)" -ge 2 ] || fail "shown: $(cat shown/log)"

# A part; the layers that are asked for, whatever files hold.
start_viewer listen
# shellcheck disable=SC2086
run 0 -q $job --crop 10,20,50,30 -p denoiser=none --layers indirect,N --display tev:localhost:"$port" -o a.exr -o a.png "$cornell"
end_viewer
python3 "$PSPLAT_SOURCE/tests/cli/tev.py" same shown a.exr >differs || fail "$(cat differs)"
expect_text shown/log "create cornell.psd 50x30 B G N.X N.Y N.Z R indirect.B indirect.G indirect.R"
start_viewer listen
# shellcheck disable=SC2086
run 0 -q $job --display tev:127.0.0.1:"$port" -o a.png "$cornell"
end_viewer
expect_match shown/log "^create cornell.psd 96x54 .*N.X.* Z albedo.B .*direct.R"
# The picture is the same without.
# shellcheck disable=SC2086
run 0 -q $job -o b.png "$cornell"
cmp -s a.png b.png || fail "the picture is another one with --display"

# --- viewers that are none ---

kill_viewer() {
    kill $viewer
    wait $viewer
} 2>/dev/null

# The port was that of the last one, which is gone.
# shellcheck disable=SC2086
run 0 -q $job --passes 3 --display tev:127.0.0.1:"$port" -o b.exr "$cornell"
[ "$(cat err)" = "psplat: warning: no viewer tev at 127.0.0.1, port $port: Connection refused" ] || fail "told: $(cat err)"
# shellcheck disable=SC2086
run 0 -q $job --passes 3 -o c.exr "$cornell"
expect_same_pixels b.exr c.exr

# shellcheck disable=SC2086
run 0 -q $job --display "tev:[::1]:$port" -o b.exr "$cornell"
expect_match err "^psplat: warning: no viewer tev at ::1, port $port: "

start_viewer refuse
# shellcheck disable=SC2086
run 0 -q $job --size 480x270 --passes 2 --display tev:127.0.0.1:"$port" -o b.exr "$cornell"
expect_match err "^psplat: warning: the viewer tev is gone: "
kill_viewer

if [ -z "$PSPLAT_QUICK" ]; then
    start_viewer ignore
    # shellcheck disable=SC2086
    run 0 -q $job --size 480x270 --display tev:127.0.0.1:"$port" -o b.exr "$cornell"
    expect_text err "psplat: warning: the viewer tev took nothing for 5 seconds"
    kill_viewer
fi

# --- what is no viewer's name ---

for wrong in "" tv tevx tev: tev:: tev::14158 tev:host: tev:host:0 tev:host:65536 tev:host:1x tev:[::1 tev:[]:1 tev:[::1]1; do
    # shellcheck disable=SC2086
    run 2 -q $job --display "$wrong" -o no.exr "$cornell"
    expect_text err "--display: expected tev, tev:HOST or tev:HOST:PORT, got '$wrong'"
done
[ ! -e no.exr ] || fail "no.exr was written"

finish
