# `psplat explore`: what its server answers, and whom; scenes that are edited; PSPLAT_QUICK: fewer changes in a row.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

if ! "$PSPLAT" --help | grep -q '^  explore '; then
    run 2 explore scene.psd
    expect_text err "libmicrohttpd"
    [ "$failures" -eq 0 ] || finish
    skip "psplat was built without libmicrohttpd"
fi
command -v python3 >/dev/null || skip "no python3"

# A sanitizer keeps what was freed.
! is_on PSPLAT_SANITIZE || export EXPLORE_NO_MEMORY_CHECK=1

: >err
last=explore.py
python3 "$PSPLAT_SOURCE/tests/cli/explore.py" || fail "what explore.py says"
check_status 0 0

finish
