# bench/study: a quick run makes all that the page needs, and a second one renders nothing.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

command -v bash >/dev/null || skip "the study needs bash"
is_on PSPLAT_SANITIZE && skip "two hundred renders by a sanitized program take too long; other tests run it"
study=$PSPLAT_SOURCE/bench/study

# study STATUS OPTION...: into the files `out` and `err`.
study() {
    expected=$1
    shift
    last="bench/study $*"
    PSPLAT=$PSPLAT "$study" "$@" >out 2>err </dev/null
    check_status $? "$expected"
}

# expect_rows FILE N: at least N rows below the line of names, all with as many fields, none of them empty.
expect_rows() {
    awk -F, -v least="$2" '
        NR == 1 { fields = NF }
        NF != fields || /(^|,)(,|$)/ { exit 1 }
        END { if (NR <= least) exit 1 }' "$1" || {
        fail "$1 is not a table of $2 rows:"
        sed 's/^/    /' "$1"
    }
}

study 2 --size 100x100
expect_text err "--size must be 16:9"
study 2 --quicker
expect_text err "unknown option '--quicker'"
study 2 --work
expect_text err "--work needs a value"
PSPLAT_REAL=$PSPLAT
PSPLAT=$scratch/none
study 1 --quick --work work
expect_text err "no program at $PSPLAT"
PSPLAT=$PSPLAT_REAL

# In the quick run, nothing is rendered.
[ -z "${PSPLAT_QUICK:-}" ] || finish

# The whole of it, without the conference room, whose model is not part of psplat.
study 0 --quick --work work --out page --conference "$scratch/none.obj"
expect_empty err
expect_text out "rendering cornell-a"
expect_text out "conference room: skipped (no model at $scratch/none.obj"
expect_rows page/points.csv 40
expect_rows page/levels.csv 20
expect_rows page/figures.csv 15
expect_rows page/references.csv 1
expect_rows page/memory.csv 5
expect_rows page/equal.csv 9
expect_rows page/trends.csv 10
expect_no_text page/README.md '{{'
expect_no_text page/README.md '}}'
expect_text page/README.md 'The model was not there'
command -v gnuplot >/dev/null || expect_text out "plots: skipped"
for name in $(grep -o '([a-z][A-Za-z0-9-]*\.[a-z]*)' page/README.md | tr -d '()'); do
    [ -s "page/$name" ] || fail "the page names $name, which is not there"
done

# What path tracing and psplat must give however coarse the pictures are.
awk -F, '$1 == "path-4" && $9 < 0.15 && $10 > 0.97 && $10 < 1.03 { found = 1 } END { exit !found }' page/points.csv ||
    fail "256 samples are not near the reference"
awk -F, '$1 == "own-6" && $9 < 0.3 { found = 1 } END { exit !found }' page/points.csv ||
    fail "psplat at its best is not near the reference"

# Nothing again; what is lost, or was cut short, alone.
cp page/points.csv before
study 0 --quick --work work --out page
expect_text out 'conference room: skipped (--conference names no model)'
expect_no_text out rendering
expect_same before page/points.csv
rm work/pm-2.key
study 0 --quick --work work --out page
[ "$(grep -c rendering out)" -eq 1 ] || fail "one render was lost, not those: $(grep rendering out)"
expect_text out "rendering pm-2"

# A placeholder that nothing fills stops the page.
for placeholder in '{{points:none:seconds}}' '{{points:pm-1:none}}' '{{picture:none}}' '{{none:a:b}}' '{{points:pm-1'; do
    if echo "$placeholder" | awk -v folder=page -f "$PSPLAT_SOURCE/bench/study.d/page.awk" >out 2>err; then
        fail "the page takes $placeholder"
    fi
    expect_text err "study: error: page.md:1:"
done

# judge QUICK VALUE: the status of a study whose one trend, to be above 1, is VALUE.
judge() {
    mkdir -p trends
    bash -c 'set -euo pipefail
        parts=$1/bench/study.d quick=$2 out=trends
        . "$parts/measure.sh"
        . "$parts/trends.sh"
        start_trends
        trend some "$3" ">" 1 "a trend"
        report_trends' bash "$PSPLAT_SOURCE" "$@" >out 2>err
}

# A trend that does not hold fails a full study, and one that could not be measured any.
judge 0 1.5 || fail "a trend that holds fails the study"
expect_match out '^holds +some +1\.5'
judge 0 0.5 && fail "a trend that does not hold passes"
expect_match out '^does not hold +some'
judge 1 0.5 || fail "a trend fails a quick study"
judge 1 '' && fail "a trend without a number passes"
expect_text err "no value for a field of trends.csv"

finish
