# The library as programs use it: the examples, built against an installed tree by what pkg-config says, make the
# command's pictures and tell its errors; and the library shows nothing but psplat.h.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

command -v cmake >/dev/null || skip "no cmake"
command -v pkg-config >/dev/null || skip "no pkg-config"
cmake --install "$PSPLAT_BUILD" --prefix "$PWD/built" >install.log 2>&1 || {
    cat install.log
    fail "cmake --install"
    finish
}
mkdir "a folder"
mv built "a folder/moved"
PKG_CONFIG_PATH=$(dirname "$(find "$PWD/a folder" -name psplat.pc)")
export PKG_CONFIG_PATH
folder=$(find "$PWD/a folder" -name libpsplat.so.0)
folder=${folder%/*}
LD_LIBRARY_PATH=$folder
export LD_LIBRARY_PATH

# --- exports: the functions of the header, no state that changes ---

last="nm libpsplat.so.0"
sed -n 's/^[a-z].*[ *]\(psplat_[a-z_]*\)(.*/\1/p' "$PSPLAT_SOURCE/include/psplat/psplat.h" | sort >header
[ "$(wc -l <header)" -ge 15 ] || fail "no functions in psplat.h"
nm -D --defined-only "$folder/libpsplat.so.0" | awk '$2 != "A" { sub(/@.*/, "", $3); print $3 }' | sort >exports
expect_same header exports
# But for what compilers put there.
is_on PSPLAT_SANITIZE ||
    nm --defined-only "$folder/libpsplat.so.0" |
    awk '$2 ~ /^[bB]$/ && $3 !~ /^_/ && $3 !~ /^completed/ { print $3 }' >variables
[ ! -f variables ] || expect_empty variables
# Nor any that begin as something; constants with addresses in them lie elsewhere.
is_on PSPLAT_SANITIZE ||
    objdump -t "$folder/libpsplat.so.0" |
    awk -F '\t' '$1 ~ / \.data$/ { print $2 }' | awk '$2 != ".data" && $2 !~ /^__/ { print $2 }' >variables
[ ! -f variables ] || expect_empty variables
readelf -d "$folder/libpsplat.so.0" | grep -q 'SONAME.*\[libpsplat\.so\.0\]' || fail "another SONAME"

# The manual has the header's functions, too.
sed -n 's/^\.Fo \(psplat_[a-z_]*\)$/\1/p; s/^\.Fn \(psplat_[a-z_]*\) .*/\1/p; s/^\.Fn \(psplat_[a-z_]*\)$/\1/p' \
    "$PSPLAT_SOURCE/man/libpsplat.3" | sort -u >page
expect_same header page
# And its options, which are those of `psplat render` but for what that does by callbacks.
run 0 render --help
sed -n 's/^  -., --\([a-z-]*\).*/\1/p; s/^      --\([a-z-]*\).*/\1/p' out |
    grep -vx 'help\|version\|quiet\|progress\|display' |
    sort >program
sed -n '/^\.Sh OPTIONS/,/^\.Sh/s/^\.It Cm //p' "$PSPLAT_SOURCE/man/libpsplat.3" | sort >page
expect_same program page

# --- the example in C ---

sanitize=
! is_on PSPLAT_SANITIZE || sanitize=-fsanitize=address,undefined
# Both are quoted for a shell.
eval "examples=$(pkg-config --variable=exampledir psplat)"
last="$CC $(pkg-config --cflags --libs psplat)"
eval "\"\$CC\" -std=c11 -Wall -Wextra -Wpedantic -Werror $sanitize -o render \"\$examples/render.c\" \
    $(pkg-config --cflags --libs psplat)" 2>compiler || fail "$(cat compiler)"

# example STATUS WORD...: as run does for psplat.
example() {
    expected=$1
    shift
    last="render $*"
    ./render "$@" >out 2>err </dev/null
    check_status $? "$expected"
}

run 0 -q --size 48x27 --passes 2 --seed 3 -p injection=photon:count=500 -o command.exr -o command.png "$cornell"
example 0 "$cornell" library size=48x27 passes=2 seed=3 plugin=injection=photon:count=500
expect_empty out
expect_text err "48x27 pixels, 24 channels"
expect_same command.exr library.exr
expect_same command.png library.png

# Words of errors are the command's.
printf 'psd: 1\ncamera: {locaton: [0, 0, 0]}\nlights: []\n' >wrong.psd
run 2 wrong.psd
cp err command
example 1 wrong.psd wrong
expect_same command err
run 2 missing.psd
cp err command
example 1 missing.psd missing
expect_same command err
run 2 -q -p filter=round "$cornell"
sed 's/^psplat: error: //; s/; tried.*//' err >command
example 1 "$cornell" wrong plugin=filter=round
sed 's/; tried.*//' err >library
expect_same command library
example 1 "$cornell" wrong sise=1x1
expect_text err "unknown option 'sise'; did you mean 'size'?"
[ ! -e wrong.exr ] && [ ! -e missing.exr ] || fail "a picture of nothing"

# --- the one in Python ---

python=$(command -v python3) || python=
if [ -n "$python" ] && ! is_on PSPLAT_SANITIZE; then
    last="python3 render.py"
    "$python" "$examples/render.py" "$cornell" python.exr size=48x27 passes=2 seed=3 plugin=injection=photon:count=500 >out 2>err
    check_status $? 0
    expect_match out '^mean of R: 0\.[0-9]*[1-9]'
    expect_match out '^mean of R after 1: 0\.[0-9]*[1-9]'
    expect_text err "% indirect light"
    expect_same command.exr python.exr
    "$python" "$examples/render.py" missing.psd python.exr >out 2>err
    check_status $? 1
    expect_text err "missing.psd: error: cannot open: No such file or directory"
fi

# From another language, which takes the header as it is.
if command -v g++ >/dev/null; then
    last="g++ psplat.h"
    printf '#include <psplat/psplat.h>\nint main() { return psplat_version() == nullptr; }\n' >include.cpp
    eval "g++ -Wall -Wextra -Wpedantic -Werror -fsyntax-only $(pkg-config --cflags psplat) include.cpp" 2>compiler ||
        fail "$(cat compiler)"
fi

finish
