# SIGINT and SIGTERM during a long render: the picture is written, status 1, a message.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

# interrupt SIGNAL N WORD...: starts psplat, waits until it begins with indirect light for the Nth time, which
# it does once a pass, and sends the signal.
interrupt() {
    signal=$1 times=$2
    shift 2
    last="psplat $* and SIG$signal"
    rm -rf new && mkdir new
    : >err # the last one's lines don't count
    "$PSPLAT" "$@" --stats new/a.json -o new/a.exr -o new/a.png "$cornell" >out 2>err &
    process=$!
    while [ "$(grep -c "indirect light" err)" -lt "$times" ] && kill -0 $process; do
        sleep 0.1
    done
    kill "-$signal" $process || fail "it ended before the signal"
    wait $process
    check_status $? 1
    expect_text err "psplat: error: interrupted: the picture holds what was done by then"
    expect_files a.exr a.png a.json
    expect_picture new/a.exr new/a.png
    run 0 info new/a.exr
    expect_text out "new/a.exr: 48x27"
}

# Many passes: those that were complete make the picture.
interrupt INT 2 --size 48x27 --passes 1000000 -p injection=photon:count=5000
expect_match new/a.json '"passes": [0-9]+'
expect_no_text new/a.json '"passes": 0'
expect_no_text new/a.json '"passes": 1000000'

# One endless pass: direct light alone, which is what black indirect light gives.
interrupt TERM 1 --size 48x27 -p injection=photon:count=2000000000
expect_match new/a.json '"passes": 0,?$'
expect_text out "psplat.passes: 0"
expect_text out "interrupted in its first pass"
expect_no_text out "psplat render"

finish
