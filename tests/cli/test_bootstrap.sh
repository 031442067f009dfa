#!/bin/sh
# The set-up script: what it answers, and that its package list and the documents agree. Installs nothing.
set -eu

bootstrap=$PSPLAT_SOURCE/bootstrap
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

fail() {
    printf 'FAILED: %s\n' "$*" >&2
    exit 1
}

# expect STATUS WORD...: runs bootstrap with the words; what it prints goes to out and err.
expect() {
    expected=$1
    shift
    status=0
    "$bootstrap" "$@" >out 2>err </dev/null || status=$?
    [ "$status" -eq "$expected" ] || fail "'bootstrap $*' ended with $status, not with $expected"
}

check_syntax() {
    [ -x "$bootstrap" ] || fail "bootstrap is not executable"
    sh -n "$bootstrap" || fail "bootstrap is no valid shell script"
    if command -v bash >/dev/null; then
        bash -n "$PSPLAT_SOURCE/.ci/run" || fail ".ci/run is no valid shell script"
    fi
}

check_usage() {
    expect 0
    grep -q '^Usage: ' out || fail "without a command it does not tell usage"
    for word in -h --help help; do
        expect 0 "$word"
        grep -q '^Usage: ' out || fail "'$word' does not tell usage"
        [ ! -s err ] || fail "'$word' writes to standard error"
    done
}

check_usage_errors() {
    for word in rendr --render 'render test' 'test --everything' 'render --all'; do
        # shellcheck disable=SC2086 # words
        expect 2 $word
        grep -q "unknown command '$word'" err || fail "'$word' is not named as the mistake"
        [ ! -s out ] || fail "the mistake '$word' writes to standard output"
    done
}

check_packages() {
    expect 0 packages
    [ "$(sort out | uniq -d)" = '' ] || fail "a package is listed twice"
    for document in README.md CONTRIBUTING.md; do
        [ -f "$PSPLAT_SOURCE/$document" ] || continue
        grep -q 'bootstrap' "$PSPLAT_SOURCE/$document" || fail "$document does not name bootstrap"
        check_document "$PSPLAT_SOURCE/$document"
    done
}

# A document may leave the packages to bootstrap; if it names some, it names all and no others.
check_document() {
    grep -oE 'lib[a-z0-9+-]+-dev' "$1" | sort -u >named || return 0
    [ -s named ] || return 0
    while read -r package; do
        grep -qx -- "$package" out || fail "$1 names the package $package, bootstrap does not"
    done <named
    while read -r package; do
        grep -qw -- "$package" "$1" || fail "$1 leaves out the package $package"
    done <out
}

# Without root and sudo it says what is missing, and neither installs nor builds. The programs it
# asks are replaced by ones that tell of a machine with nothing installed.
check_refusal() {
    mkdir -p tools checkout
    for tool in sh dirname sed cat nproc; do
        ln -s "$(command -v "$tool")" "tools/$tool"
    done
    printf '#!/bin/sh\nexit 1\n' >tools/dpkg-query
    printf '#!/bin/sh\necho 1000\n' >tools/id
    printf '#!/bin/sh\necho called >>"%s/calls"\n' "$scratch" >tools/apt-get
    chmod +x tools/dpkg-query tools/id tools/apt-get
    cp "$bootstrap" checkout/bootstrap
    status=0
    PATH=$scratch/tools checkout/bootstrap render >out 2>err </dev/null || status=$?
    [ "$status" -eq 1 ] || fail "without root and sudo it ended with $status, not with 1"
    for package in cmake libembree-dev; do
        grep -q "$package" err || fail "without root and sudo it does not name $package"
    done
    for package in libcmocka-dev python3; do
        ! grep -q "$package" err || fail "it wants $package to render, which only tests need"
    done
    status=0
    PATH=$scratch/tools checkout/bootstrap test >out 2>err </dev/null || status=$?
    [ "$status" -eq 1 ] || fail "tests without root and sudo ended with $status, not with 1"
    for package in cmake libembree-dev libcmocka-dev python3; do
        grep -q "$package" err || fail "without root and sudo it does not name $package to test"
    done
    [ ! -e calls ] || fail "without root and sudo it called apt-get"
    [ ! -e checkout/build ] || fail "without root and sudo it made a build folder"
}

check_syntax
check_usage
check_usage_errors
check_packages
check_refusal
