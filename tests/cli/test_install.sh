#!/bin/sh
# An installed psplat is whole, runs from any place, can be moved, and can be built against.
set -eu
unset PSPLAT_PLUGIN_PATH DESTDIR

cache=$PSPLAT_BUILD/CMakeCache.txt
for option in PSPLAT_STATIC_PLUGINS PSPLAT_SANITIZE PSPLAT_FUZZ; do
    if grep -q "^$option:BOOL=ON" "$cache"; then
        echo "skipped: $option is on, and such a build is not for installing"
        exit 77
    fi
done

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

fail() {
    printf 'FAILED: %s\n' "$*" >&2
    exit 1
}

libdir=$(sed -n 's/^CMAKE_INSTALL_LIBDIR:[A-Z]*=//p' "$cache")

write_scene() {
    cat >"$1" <<'END'
psd: 1
camera: {location: [0, 1, -4], look_at: [0, 1, 0], vertical_angle: 40}
image: {width: 32, height: 18}
materials:
  white: {diffuse: [0.7, 0.7, 0.7]}
lights:
  - spotlight: {location: [0, 3, -1], point_at: [0, 0, 0], radius: 40, falloff: 50, intensity: [10, 10, 10]}
objects:
  - quad: {corners: [[-2, 0, -2], [-2, 0, 2], [2, 0, 2], [2, 0, -2]], material: white}
  - box: {corners: [[-0.5, 0, -0.5], [0.5, 1, 0.5]], material: white}
render:
  injection: {photon: {count: 1000}}
END
}

check_file() {
    [ -f "$1" ] || fail "not installed: $1"
}

check_contents() {
    prefix=$1
    [ -x "$prefix/bin/psplat" ] || fail "not installed: $prefix/bin/psplat"
    for name in libpsplat.so libpsplat.so.0; do
        check_file "$prefix/$libdir/$name"
    done
    # Plugins export what the loader looks for alone.
    for plugin in "$prefix/$libdir"/psplat/plugins-1/*/*.so; do
        [ "$(nm -D --defined-only "$plugin" | awk '$2 ~ /[A-TV-Z]/ { print $3 }')" = psplat_module_v1 ] ||
            fail "$plugin exports more than its module"
    done
    [ -z "$(nm -D --defined-only "$prefix/bin/psplat" | awk '$2 ~ /[TDR]/ && $3 !~ /^(_|psplat_|ps_)/')" ] ||
        fail "the program exports names of its own"
    check_file "$prefix/$libdir/pkgconfig/psplat.pc"
    for header in "$PSPLAT_SOURCE"/include/psplat/*.h; do
        check_file "$prefix/include/psplat/$(basename "$header")"
    done
    for source in "$PSPLAT_SOURCE"/plugins/*/*.c; do
        kind=$(basename "$(dirname "$source")")
        [ "$kind" != examples ] || {
            check_file "$prefix/share/psplat/examples/$(basename "$source")"
            continue
        }
        check_file "$prefix/$libdir/psplat/plugins-1/$kind/$(basename "$source" .c).so"
    done
    for scene in "$PSPLAT_SOURCE"/scenes/*.psd; do
        check_file "$prefix/share/psplat/scenes/$(basename "$scene")"
    done
    for file in psplat/scenes/pictures/plate.png psplat/psd.schema.json mime/packages/psplat.xml \
        bash-completion/completions/psplat zsh/site-functions/_psplat fish/vendor_completions.d/psplat.fish vim/vimfiles/ftdetect/psplat.vim \
        doc/psplat/README.md doc/psplat/docs/method.md; do
        check_file "$prefix/share/$file"
    done
    for example in "$PSPLAT_SOURCE"/examples/*; do
        check_file "$prefix/share/psplat/examples/$(basename "$example")"
    done
    check_file "$prefix/share/psplat/blender/psplat_render.py"
    for page in "$PSPLAT_SOURCE"/man/*.[1357]; do
        [ -f "$page" ] || continue
        check_file "$prefix/share/man/man${page##*.}/$(basename "$page")"
    done
}

# What is installed must not lean on the folders it was built in.
check_independence() {
    for file in "$1/bin/psplat" "$1/$libdir/libpsplat.so" "$1/$libdir/psplat/plugins-1"/*/*.so; do
        if grep -qF "$PSPLAT_BUILD/lib" "$file"; then
            fail "$file names the build folder"
        fi
    done
}

check_rendering() {
    rm -f small.exr small.png
    "$1/bin/psplat" small.psd --quiet || fail "$1/bin/psplat renders no scene"
    for picture in small.exr small.png; do
        [ -s "$picture" ] || fail "$1/bin/psplat wrote no $picture"
    done
    "$1/bin/psplat" plugins >plugins.txt || fail "$1/bin/psplat lists no plugins"
    if grep "can't be used" plugins.txt; then
        fail "$1: a plugin can't be used"
    fi
}

# Every header compiles by itself, found by what pkg-config says.
check_building_against() {
    command -v pkg-config >/dev/null || return 0
    flags=$(PKG_CONFIG_PATH=$1/$libdir/pkgconfig pkg-config --cflags psplat) ||
        fail "pkg-config finds no psplat in $1"
    for header in "$1"/include/psplat/*.h; do
        echo "#include <psplat/$(basename "$header")>" >include.c
        # The flags are quoted for a shell; the warnings are those that plugin authors will see.
        eval "\"\$PSPLAT_CC\" -std=c11 -Wall -Wextra -Werror -fsyntax-only $flags include.c" ||
            fail "$(basename "$header") does not compile by itself"
    done
    eval "folder=$(PKG_CONFIG_PATH=$1/$libdir/pkgconfig pkg-config --variable=plugindir psplat)"
    # shellcheck disable=SC2154 # set by the line above, which undoes the quotes
    [ -d "$folder" ] || fail "psplat.pc: plugindir is '$folder', where there is nothing"
}

cmake --install "$PSPLAT_BUILD" --prefix "$scratch/installed" >"$scratch/log" 2>&1 || {
    cat "$scratch/log"
    fail "cmake --install failed"
}
mkdir "$scratch/elsewhere"
cd "$scratch/elsewhere"
write_scene small.psd
check_contents "$scratch/installed"
check_independence "$scratch/installed"
check_rendering "$scratch/installed"
check_building_against "$scratch/installed"

mkdir "$scratch/another place"
mv "$scratch/installed" "$scratch/another place/moved"
check_contents "$scratch/another place/moved"
check_rendering "$scratch/another place/moved"
check_building_against "$scratch/another place/moved"

# The system's list of what is mapped escapes a line's end; and a folder may have such an escape for a name.
for name in 'two
lines' 'two\012lines'; do
    mv "$scratch/another place" "$scratch/$name"
    check_rendering "$scratch/$name/moved"
    mv "$scratch/$name" "$scratch/another place"
done
echo "installed, rendered, moved, rendered again"
