# Command lines that make no sense: status 2, a message that says what to do, and no file.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

# usage TEXT WORD...: a usage error with that text.
usage() {
    text=$1
    shift
    run 2 "$@"
    expect_empty out
    expect_match err '^psplat: error: '
    expect_text err "$text"
}

usage "which scene?"
usage "which scene?" render
usage "which scene?" --size 10x10
usage "one scene at a time: 'b.psd' after 'a.psd'" a.psd b.psd
usage "unknown option '--nonsense'" --nonsense "$cornell"
expect_text err "Try 'psplat render --help'."
usage "unknown option '--pases'; did you mean '--passes'?" --pases 3 "$cornell"
usage "unknown option '--outptu=a.exr'" --outptu=a.exr "$cornell"
usage "unknown option '-z'" -z "$cornell"
usage "a value is given to option '--quiet=yes'" --quiet=yes "$cornell"
usage "a value is missing after option '--size'" "$cornell" --size
usage "a value is missing after option '-o'" "$cornell" -o
usage "a value is missing after option '--stats'" "$cornell" --stats -o picture.exr
usage "a value is missing after option '-p'" "$cornell" -p --quiet
usage "unknown option '--passes'" plugins --passes 3

for value in 0 1000001 -1 1.5 1e7 x "" 0x10 nan inf; do
    usage "--passes: expected a whole number 1..1000000, got '$value'" --passes "$value" "$cornell"
done
for value in 0 1025 -2 two ""; do
    usage "--threads: expected a whole number 1..1024, got '$value'" --threads "$value" "$cornell"
    usage "--threads: expected a whole number 1..1024, got '$value'" --threads="$value" "$cornell"
done
for value in -1 9007199254740994 0.5 seed; do
    usage "--seed: expected a whole number 0..9007199254740992, got '$value'" --seed "$value" "$cornell"
done
for value in 0 1048577 many; do
    usage "--batch: expected a whole number 1..4096, got '$value'" --batch "$value" "$cornell"
done
for value in 0 8193 1.5 fine; do
    usage "--direct-resolution: expected a whole number 1..8192, got '$value'" \
        --direct-resolution "$value" "$cornell"
done
for value in maps Rays ""; do
    usage "--direct: expected rays or shadowmap, got '$value'" --direct "$value" "$cornell"
done
for value in 10 10x 10x0 0x10 65537x1 1x65537 1.5x2 -1x5 axb 10x10x10 10X10 "" x; do
    usage "--size: expected WxH, each 1..65536, got '$value'" --size "$value" "$cornell"
done
usage "--size: expected WxH, each 1..65536, got 'z'" --size z --size 8x8 "$cornell"
for value in 21 -21 x "" nan 1e99; do
    usage "--exposure: expected a number -20..20, got '$value'" --exposure "$value" "$cornell"
done
for value in picture picture.jpg .exr .png picture.EXR picture.exr/ ""; do
    usage "--output: '$value' ends neither in .exr nor in .png" -o "$value" "$cornell"
done
for value in filter "" = =box filtre=box Filter=box filter:box; do
    usage "--plugin: expected KIND=NAME[:KEY=VALUE,...], got '$value'" --plugin "$value" "$cornell"
    expect_text err "'psplat plugins' lists the kinds"
done
usage "no kind of plugin 'fitler'; the kinds are: injection stratification visibility filter" \
    plugins fitler
usage "no kind of plugin ''" plugins ""

# Numbers do not depend on the locale, and neither does what is written.
for locale in de_DE.UTF-8 de_DE.utf8 fr_FR.UTF-8; do
    LC_ALL=$locale "$PSPLAT" $small --exposure 0.5 -q -o locale.exr "$cornell" 2>err || fail "locale $locale"
done

# Help and version, wherever they stand.
run 0 --help
expect_empty err
expect_text out "usage: psplat [render] [options] SCENE.psd"
for command in render check plugins info compare diff view import; do
    expect_match out "^  $command +[a-z]"
done
for command in render check plugins info compare diff view import; do
    run 0 $command --help
    expect_empty err
    expect_text out "usage: psplat $command [options]"
    cp out long
    run 0 $command -h
    expect_same out long
done
run 0 render missing.psd --size bad -h
run 0 --version
expect_match out '^psplat [0-9]+\.[0-9]+\.[0-9]+$'
run 0 check --version
expect_match out '^psplat [0-9]'

# Nothing was written by all that.
rm -f long locale.exr
[ "$(ls -A | tr '\n' ' ')" = "err out " ] || fail "files appeared: $(ls -A)"

finish
