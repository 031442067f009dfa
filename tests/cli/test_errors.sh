# Failures that are not the command line's: scenes that can't be read, pictures that can't be written.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

# --- scenes ---

run 2 missing.psd
expect_match err '^missing\.psd: error: .*No such file'
run 2 .
expect_match err '^\.: error: .*directory'
: >empty.psd
run 2 empty.psd
expect_match err '^empty\.psd:1:1: error: '
printf 'psd: 1\n\tcamera: {}\n' >tab.psd
run 2 tab.psd
expect_match err '^tab\.psd:2:[0-9]+: error: '
printf 'psd: 2\n' >version.psd
run 2 version.psd
expect_text err "version.psd:1:6: error: psd version 2 is unknown"
head -c 3000 /dev/urandom >noise.psd
run 2 noise.psd
expect_match err '^noise\.psd:'
cat >bad.psd <<'END'
psd: 1
camera: {location: [0, 1, 5], look_at: [0, 0, 0], angel: 40}
lights:
  - point: {location: [0, 4, 0], intensity: -10}
END
run 2 bad.psd
expect_text err "bad.psd:2:51: error: unknown key 'angel' in camera; did you mean 'angle'?"
expect_match err '^bad\.psd:4:[0-9]+: error: intensity in point: '
expect_text err "2 errors"
[ ! -e bad.exr ] && [ ! -e bad.png ] || fail "a bad scene gave a picture"

# A picture that the machine's memory can't hold is refused before any is asked for.
for how in "--size 65536x65536" "--set image={width:\ 65536,height:\ 65536}"; do
    eval "run 1 $how -o large.exr '$cornell'"
    expect_match err '^psplat: error: a picture of 65536x65536 pixels takes [0-9.]+ GiB of memory'
    [ ! -e large.exr ] || fail "a picture that is too large was written"
done

# --- output ---

# writes_nothing PATH TEXT: the picture can't be written there, and nothing is left in the folder `new`.
rm -rf new && mkdir new
writes_nothing() {
    run 1 $small -o "$1" "$cornell"
    expect_match err '^psplat: error: '
    expect_text err "$1"
    expect_text err "$2"
    expect_files
}
writes_nothing new/no_folder/a.exr "No such file or directory"
writes_nothing new/no_folder/a.png "No such file or directory"
writes_nothing empty.psd/a.exr "Not a directory"
mkdir folder.exr folder.png
writes_nothing folder.exr "it is a directory"
writes_nothing folder.png "it is a directory"
writes_nothing /proc/a.exr "cannot create a file in '/proc/'"
ln -s nowhere dangling.exr
writes_nothing dangling.exr "symbolic link to nothing"
mkfifo pipe.png
writes_nothing pipe.png "neither a file nor a device"
if [ -c /dev/full ]; then
    ln -s /dev/full full.exr
    ln -s /dev/full full.png
    writes_nothing full.exr "No space left on device"
    writes_nothing full.png "No space left on device"
fi
if [ "$(id -u)" -ne 0 ]; then
    chmod 555 new
    writes_nothing new/a.exr "Permission denied"
    chmod 755 new
    echo old >new/keep.exr
    chmod 444 new/keep.exr
    run 1 $small -o new/keep.exr "$cornell"
    expect_text err "Permission denied"
    expect_files keep.exr
    rm -f new/keep.exr
fi

# What was there before stays when the disk is full half-way; what could be written is.
# What can't be written is told before the render: nothing is written at all.
run 1 $small -o new/first.exr -o new/no/second.exr -o new/third.exr "$cornell"
expect_text err "new/no/second.exr"
expect_files
if (ulimit -f 8) 2>/dev/null; then
    echo old >new/first.exr
    last="a limit of 8 blocks for files"
    (
        ulimit -f 8
        trap '' XFSZ
        "$PSPLAT" --size 160x90 -p injection=photon:count=500 -o new/first.exr "$cornell" >out 2>err
    )
    check_status $? 1
    [ "$(cat new/first.exr)" = old ] || fail "the old picture is gone"
    expect_files first.exr
fi

run 1 $small -q -o ok.exr --stats new/no/stats.json "$cornell"
expect_text err "new/no/stats.json"
[ ! -e ok.exr ] || fail "a picture in spite of the error"
run 0 $small -q -o ok.exr "$cornell"

# --- standard output ---

if [ -c /dev/full ]; then
    for words in --help --version "plugins" "plugins filter=gaussian" "info ok.exr"; do
        last="psplat $words >/dev/full"
        # shellcheck disable=SC2086
        "$PSPLAT" $words >/dev/full 2>err
        check_status $? 1
        expect_text err "can't write to standard output"
    done
fi

# --- numbers at the edge of what is allowed ---

for size in 1e-30 1e18 1e300; do
    run 0 $small -q -p visibility=shadowmap:radius=$size,depth=1e300,bias=1e300,bandwidth_scale=1e300 -o edge.exr "$cornell"
done
cat >huge.psd <<'END'
psd: 1
camera: {location: [0, 0, -1e20], look_at: [0, 0, 0]}
materials: {m: {diffuse: 0.5}}
lights: [{point: {location: [0, 1e19, -1e19], intensity: 1}}]
objects: [{sphere: {center: [0, 0, 0], radius: 1e19, material: m}}]
END
run 2 -q -o huge.exr huge.psd
expect_text err "psplat: error: the scene's radius is"
[ ! -e huge.exr ] || fail "a picture in spite of the error"

# --- settings that only a plugin can judge ---

run 2 $small -p injection=photon:split=1.5 -o init.exr "$cornell"
expect_text err "injection photon: split: expected auto | integer 1..64, got '1.5'"
for bounces in 0 1001 1.5 none ''; do
    run 2 $small --bounces "$bounces" -o init.exr "$cornell"
    expect_text err "psplat: error: --bounces: expected all | integer 1..1000, got '$bounces'"
done
run 2 $small --set render.bounces=1.5 -o init.exr "$cornell"
expect_text err "--set:2:16: error: bounces in render: expected all | integer 1..1000, got '"
run 2 $small --set render.bounces=0 -o init.exr "$cornell"
expect_text err "bounces in render: expected all | integer 1..1000, got '0'"
[ ! -e init.exr ] || fail "a picture in spite of the error"

finish
