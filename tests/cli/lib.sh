# lib.sh: what the command-line tests share. A test starts with
#
#     . "$PSPLAT_SOURCE/tests/cli/lib.sh"
#
# and ends with `finish`. It runs in an empty folder of its own that goes away with it. Checks print
# what is wrong and go on, so that one run shows all.

: "${PSPLAT:?the program under test}" "${PSPLAT_SOURCE:?the source tree}"
: "${PSPLAT_BUILD:?the build tree}"
CC=${PSPLAT_CC:-cc}
LC_ALL=C
export LC_ALL
unset PSPLAT_PLUGIN_PATH CDPATH
failures=0
last=

scratch=$(mktemp -d) || exit 1
trap 'status=$?; rm -rf "$scratch"; [ "$failures" -eq 0 ] || [ "$status" -ne 0 ] || exit 1' EXIT
trap 'exit 1' HUP INT TERM
cd "$scratch" || exit 1

cornell=$PSPLAT_SOURCE/scenes/cornell.psd
small="--size 48x27 --plugin injection=photon:count=500 --plugin estimator=splat --plugin denoiser=none --set render.aa_samples=1"

# small_choice KIND=NAME: that strategy with numbers that are few, and yet photons that fill more than one batch.
small_choice() {
    case $1 in
    injection=photon) echo "$1:count=5000" ;;
    injection=rsm) echo "$1:count=5000,resolution=32" ;;
    injection=voxel) echo "$1:resolution=32" ;;
    estimator=pathtrace) echo "$1:samples=4" ;;
    estimator=radiosity) echo "$1:epsilon=1e-3,samples=4" ;;
    estimator=irradiance_cache) echo "$1:samples=16" ;;
    estimator=lpv) echo "$1:cells=8" ;;
    estimator=voxel_cone) echo "$1:resolution=16,cones=5" ;;
    estimator=bdpt) echo "$1:samples=2" ;;
    estimator=vpl) echo "$1:lights=50" ;;
    estimator=lightcuts) echo "$1:lights=500" ;;
    visibility=imperfect) echo "$1:points=5000" ;;
    *) echo "$1" ;;
    esac
}

fail() {
    echo "FAILED: $*"
    [ -z "$last" ] || echo "    after: $last"
    failures=$((failures + 1))
}

skip() {
    echo "skipped: $*"
    exit 77
}

finish() {
    [ "$failures" -eq 0 ] || echo "$failures checks failed"
    [ "$failures" -eq 0 ]
    exit
}

# run STATUS WORD...: runs psplat into the files `out` and `err`, and expects that exit status.
run() {
    expected=$1
    shift
    last="psplat $*"
    "$PSPLAT" "$@" >out 2>err </dev/null
    check_status $? "$expected"
}

# As run, with a plugin that keeps memory on purpose: leaks are not looked for.
run_leaking() {
    lsan_options=${LSAN_OPTIONS:-}
    export LSAN_OPTIONS="detect_leaks=0:$lsan_options"
    run "$@"
    export LSAN_OPTIONS="$lsan_options"
}

# For a program that ran into `out` and `err`: its status, and that no sanitizer spoke.
check_status() {
    if [ "$1" -ne "$2" ]; then
        fail "exit status $1, expected $2"
        sed 's/^/    err: /' err
    fi
    if grep -qE 'Sanitizer|runtime error:' err; then
        fail "a sanitizer found something"
        sed 's/^/    err: /' err
    fi
}

# expect_text FILE TEXT: some line of the file holds the text.
expect_text() {
    grep -qF -e "$2" "$1" && return
    fail "no '$2' in $1:"
    sed 's/^/    /' "$1"
}

# expect_match FILE EXPRESSION: some line of the file matches the extended regular expression.
expect_match() {
    grep -qE -e "$2" "$1" && return
    fail "nothing like '$2' in $1:"
    sed 's/^/    /' "$1"
}

expect_no_text() {
    grep -qF -e "$2" "$1" || return 0
    fail "'$2' in $1:"
    sed 's/^/    /' "$1"
}

expect_empty() {
    [ -s "$1" ] || return 0
    fail "$1 is not empty:"
    sed 's/^/    /' "$1"
}

expect_same() {
    cmp -s "$1" "$2" || fail "$1 and $2 differ"
}

# Files for scenes to name: blender.glb, box.obj with a picture on it, and the pictures rgb8.png and baseline.jpg.
make_scene_files() {
    cp "$PSPLAT_SOURCE/tests/data/blender.glb" "$PSPLAT_SOURCE/tests/data/baseline.jpg" "$PSPLAT_SOURCE/tests/data/rgb8.png" .
    cat >box.mtl <<MTL
newmtl painted
map_Kd rgb8.png
MTL
    cat >box.obj <<OBJ
mtllib box.mtl
v 0 0 0
v 1 0 0
v 0 1 0
vt 0 0
vt 1 0
vt 0 1
usemtl painted
f 1/1 2/2 3/3
OBJ
}

# expect_same_pixels A B: the attributes of the pictures may differ.
expect_same_pixels() {
    for layer in direct indirect albedo N; do
        "$PSPLAT" compare "$1" "$2" --layer $layer --metric max --fail 'max>0' >out 2>err ||
            fail "$1 and $2 differ in layer $layer"
    done
}

expect_different() {
    [ -s "$1" ] && [ -s "$2" ] || fail "$1 or $2 is empty or not there"
    cmp -s "$1" "$2" && fail "$1 and $2 are the same"
    return 0
}

# expect_picture FILE...: whole files of the format that their suffix names.
expect_picture() {
    for picture; do
        case $picture in
        *.png) magic='89504e47' ;;
        *) magic='762f3101' ;;
        esac
        [ -s "$picture" ] || fail "no picture $picture"
        [ "$(head -c 4 "$picture" | od -An -tx1 | tr -d ' \n')" = "$magic" ] ||
            fail "$picture does not begin as a picture does"
    done
}

# expect_files NAME...: these, and no others (hidden ones too), lie in the folder `new`.
expect_files() {
    found=$(ls -A new | sort | tr '\n' ' ')
    wanted=$(for name; do echo "$name"; done | sort | tr '\n' ' ')
    [ "$found" = "$wanted" ] || fail "files '$found', expected '$wanted'"
}

# The cache's answer to an option of the build.
build_option() {
    sed -n "s/^$1:[A-Z]*=//p" "$PSPLAT_BUILD/CMakeCache.txt"
}

is_on() {
    case $(build_option "$1") in
    ON | on | 1 | TRUE | YES) return 0 ;;
    *) return 1 ;;
    esac
}

# compile_preload NAME: NAME.so of tests/preload, for LD_PRELOAD; false, and why in the file `compiler`. Not watched by a
# sanitizer, since it stands before one's own functions; its frames are kept for lsan.supp.
compile_preload() {
    ASAN_OPTIONS="verify_asan_link_order=0:${ASAN_OPTIONS:-}"
    export ASAN_OPTIONS
    "$CC" -std=c11 -O1 -fno-omit-frame-pointer -shared -fPIC -o "$1.so" "$PSPLAT_SOURCE/tests/preload/$1.c" -ldl 2>compiler
}

# compile_module INCLUDE SOURCE OUTPUT [FLAG...]
compile_module() {
    include=$1 source=$2 output=$3
    shift 3
    sanitize=
    ! is_on PSPLAT_SANITIZE || sanitize=-fsanitize=address,undefined
    # shellcheck disable=SC2086
    "$CC" -std=c11 -Wall -Wextra -Wpedantic -Wshadow -Werror $sanitize ${PSPLAT_CFLAGS:-} "$@" \
        -shared -fPIC -I "$include" -o "$output" "$source" -lm 2>compiler ||
        { fail "can't compile $source"; sed 's/^/    /' compiler; }
}
