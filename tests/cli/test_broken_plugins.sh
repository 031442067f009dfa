# Modules that are broken in one place each: a clear error with status 2, and no crash.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

source=$PSPLAT_SOURCE/tests/plugins/broken_filter.c
mkdir -p mine/filter mine/denoiser
export PSPLAT_PLUGIN_PATH="$PWD/mine"

# build FLAG...: mine/filter/broken.so anew.
build() {
    rm -f mine/filter/broken.so
    compile_module "$PSPLAT_SOURCE/include" "$source" mine/filter/broken.so "$@"
}

# refused TEXT: the module that lies there is refused by path and by name, and listed as such.
refused() {
    run 2 plugins filter=mine/filter/broken.so
    expect_text err "psplat: error: filter plugin mine/filter/broken.so: "
    expect_text err "$1"
    expect_empty out
    run 2 check -p filter=mine/filter/broken.so "$cornell"
    expect_text err "$1"
    run 2 $small -o no.exr -p filter=broken "$cornell"
    expect_text err "no filter 'broken' (there are: box,"
    expect_text err "; tried $PWD/mine/filter/broken.so: "
    expect_text err "$1"
    [ ! -e no.exr ] || fail "a picture in spite of the error"
    run 0 plugins filter
    expect_match out "^  broken +can't be used; tried "
    expect_text out "$1"
    expect_match out '^  box '
}

# broken TEXT FLAG...
broken() {
    text=$1
    shift
    build "$@"
    before=$failures
    refused "$text"
    [ $failures -eq $before ] || echo "    with: $*"
}

# --- as it stands, it works ---

build
cp mine/filter/broken.so whole.so
run 0 plugins filter=broken
expect_text out "a filter that is broken by the tests"
expect_text out "file: $PWD/mine/filter/broken.so"
run 0 -q $small -p filter=broken -o whole.exr "$cornell"
expect_picture whole.exr

# --- the module ---

broken "does not begin with the magic number" -DMAGIC=1
minor=$(sed -n 's/^#define PS_ABI_MINOR \([0-9]*\)u$/\1/p' "$PSPLAT_SOURCE/include/psplat/module.h")
broken "it was built for plugin interface 2.$minor, this psplat has 1.$minor" -DABI_MAJOR=2
broken "it was built for plugin interface 0.$minor, this psplat has 1.$minor" -DABI_MAJOR=0
broken "it was built for plugin interface 1.99, this psplat has 1." -DABI_MINOR=99
broken "its structs are laid out otherwise" "-DFINGERPRINT=(PS_LAYOUT_FINGERPRINT^256)"
broken "no symbol psplat_module_v1" -DSYMBOL=psplat_module_v2
broken "it describes no strategy" -DMODULE_SIZE=8
broken "it describes no strategy" -DCOUNT=0
broken "it describes no strategy" -DDESCRIPTORS=NULL
broken "can't be loaded" -DUNDEFINED

# --- the descriptor ---

broken "its descriptor is too small" -DDESCRIPTOR=NULL
broken "its descriptor is too small" -DDESCRIPTOR_SIZE=16
broken "its descriptor is of an unknown kind" -DKIND=99
broken "lacks a name, version, summary or paper" -DNAME=NULL
broken "lacks a name, version, summary or paper" -DPAPER=NULL
broken "its table of functions is too small" -DVTABLE=NULL
broken "its table of functions is too small" -DVTABLE_SIZE=8
broken "it holds denoiser 'broken', no filter" -DKIND=PS_DENOISER
# A function that must be there is not.
broken "table of functions" -DWEIGH=NULL

# A name that is not the file's: found by path, not by name.
build '-DNAME="other"'
run 0 plugins filter=mine/filter/broken.so
expect_text out "filter=other, version 1.0"
run 2 check -p filter=broken "$cornell"
expect_text err "it holds filter 'other', no filter of that name"

# --- parameters ---

broken "its parameter rows are too small" -DPARAM_SIZE=8
broken "parameter" -DPARAMS=NULL
broken "a parameter lies outside of its state" -DPARAM_OFFSET=1
broken "a parameter lies outside of its state" -DPARAM_OFFSET=UINT64_MAX
broken "a parameter lies outside of its state" -DSTATE_SIZE=0
broken "a parameter has no name, help, unit or known type" -DPARAM_TYPE=99
broken "a parameter has no name, help, unit or known type" -DPARAM_HELP=NULL
broken "two of its parameters have the same name" -DPARAM_COUNT=2
broken "a parameter's range is empty" -DPARAM_MINIMUM=3
broken "a parameter's range is empty" -DPARAM_MINIMUM=NAN
broken "a parameter's choices do not fit its type" -DPARAM_TYPE=PS_PARAM_CHOICE "-DSTATE_SIZE=64"

broken "it has a bad default: expected number 0..2, got '7'" '-DPARAM_DEFAULT="7"'
broken "it has a bad default: expected number 0..2, got 'one'" '-DPARAM_DEFAULT="one"'
build -DPARAM_DEFAULT=NULL
run 2 check -p filter=broken "$cornell"
expect_text err "filter broken needs its parameter 'factor'"
run 0 check -p filter=broken:factor=2 "$cornell"
run 0 plugins filter=broken
expect_text out "number 0..2; required"

# --- what it does ---

build -DINIT=refuse
run 2 $small -o no.exr -p filter=broken "$cornell"
expect_text err "psplat: error: filter broken: the moon is in the wrong quarter"
run 2 check -p filter=broken "$cornell"
expect_text err "filter broken: the moon is in the wrong quarter"
build -DINIT=refuse_silently
run 2 $small -o no.exr -p filter=broken "$cornell"
expect_text err "psplat: error: filter broken failed"
for weight in -1.0f 0.0f NAN INFINITY; do
    build "-DWEIGHT=$weight"
    run 2 $small -o no.exr -p filter=broken "$cornell"
    expect_text err "filter broken: weights must not be negative, nor zero everywhere"
done
[ ! -e no.exr ] || fail "a picture in spite of the error"

# --- the file ---

put() {
    rm -rf mine/filter/broken.so
    cat >mine/filter/broken.so
}
put </dev/null
refused "it is no shared object"
echo "this is text" | put
refused "it is no shared object"
printf '\177ELF' | put
refused "it is no shared object"
rm -f mine/filter/broken.so
mkdir mine/filter/broken.so
refused "it is no ordinary file"
rmdir mine/filter/broken.so
ln -s nowhere mine/filter/broken.so
refused "no such file"
rm -f mine/filter/broken.so
"$CC" -I "$PSPLAT_SOURCE/include" -c -fPIC -o mine/filter/broken.so "$source"
refused "it is no shared object"
cp "$PSPLAT" mine/filter/broken.so
refused "it"

# Cut off anywhere: an error up to the end of the last segment; what comes behind that, the loader
# does not need.
size=$(wc -c <whole.so)
for length in 1 4 16 63 64 100 200 500 1000 2000 4095 4096 5000 8192; do
    [ $length -lt $((size / 2)) ] || continue
    head -c $length whole.so | put
    refused "it is"
done
step=1
while [ $step -le 31 ]; do
    head -c $((size * step / 32)) whole.so | put
    last="cut off at $step/32"
    "$PSPLAT" plugins filter=mine/filter/broken.so >out 2>err
    status=$?
    [ $status -eq 0 ] || check_status $status 2
    step=$((step + 1))
done

# Another machine's.
{
    head -c 18 whole.so
    printf '\371\377'
    tail -c +21 whole.so
} | put
refused "can't be loaded"

finish
