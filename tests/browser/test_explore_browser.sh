# The page of `psplat explore` in a real browser, without a display; PSPLAT_QUICK: fewer changes in a row.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

"$PSPLAT" --help | grep -q '^  explore ' || skip "psplat was built without libmicrohttpd"
! is_on PSPLAT_SANITIZE || skip "test_explore.sh asks the server for the same without a browser"
# 127.0.0.1 is reached by no proxy.
unset http_proxy HTTP_PROXY all_proxy ALL_PROXY
command -v python3 >/dev/null || skip "no python3"
command -v chromium >/dev/null && command -v chromedriver >/dev/null || skip "no chromium or chromedriver"

PYTHONDONTWRITEBYTECODE=1
export PYTHONDONTWRITEBYTECODE
[ -z "$PSPLAT_QUICK" ] || export PAGE_CHANGES=20

python3 "$PSPLAT_SOURCE/tests/browser/explore_page.py" || fail "explore_page.py"
finish
