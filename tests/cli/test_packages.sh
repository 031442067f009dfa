# The Debian packages that cpack makes: what they hold and need, and lintian's errors. They are unpacked here, not
# installed: that takes root.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

for option in PSPLAT_STATIC_PLUGINS PSPLAT_SANITIZE PSPLAT_FUZZ; do
    ! is_on $option || skip "$option is on, and such a build is not for packages"
done
for tool in cpack dpkg-deb dpkg-shlibdeps file; do
    command -v $tool >/dev/null || skip "no $tool"
done

last=cpack
cpack --config "$PSPLAT_BUILD/CPackConfig.cmake" -B "$PWD/made" >log 2>&1 || {
    fail "no packages"
    tail -n 20 log
    finish
}
libdir=usr/$(build_option CMAKE_INSTALL_LIBDIR)
expected='libpsplat-dev libpsplat0 psplat psplat-doc'
[ ! -f "$PSPLAT_BUILD/lib/psplat/mpi.so" ] || expected='libpsplat-dev libpsplat0 psplat psplat-doc psplat-mpi'
made=$(for package in made/*.deb; do dpkg-deb -f "$package" Package; done | sort | tr '\n' ' ')
[ "$made" = "$expected " ] || fail "packages '$made', expected '$expected'"

# field PACKAGE NAME: of its control file.
field() {
    dpkg-deb -f made/"$1"_*.deb "$2"
}

for package in $expected; do
    last=$package
    dpkg-deb -c made/"${package}"_*.deb | awk '{ print $2, $6 }' >contents
    expect_match contents "^root/root ./usr/share/doc/$package/copyright$"
    expect_match contents "^root/root ./usr/share/doc/$package/changelog.gz$"
    expect_match contents "^root/root ./usr/share/doc/$package/changelog.Debian.gz$"
    grep -v '^root/root ./usr/' contents | grep -v ' ./$' >elsewhere
    expect_empty elsewhere
    dpkg-deb -x made/"${package}"_*.deb root
    dpkg-deb -x made/"${package}"_*.deb "only-$package"
    [ "$(field "$package" Priority)" = optional ] || fail "its priority is '$(field "$package" Priority)'"
    field "$package" Maintainer | grep -q '.<.*@.*>$' || fail "no maintainer"
    [ "$(field "$package" Description | wc -l)" -ge 3 ] || fail "no description"
done
last='sections and architectures'
sections=$(for package in libpsplat0 libpsplat-dev psplat psplat-doc; do field $package Section; done | tr '\n' ' ')
[ "$sections" = 'libs libdevel graphics doc ' ] || fail "sections '$sections'"
[ "$(field psplat-doc Architecture)" = all ] || fail "the documents are not for all machines"

# has PACKAGE PATH: the file, or link, is in that package and in no other.
has() {
    last="$1: $2"
    [ -e "only-$1/$2" ] || [ -L "only-$1/$2" ] || fail "it is not there"
    [ "$(find only-* -path "only-*/$2" | wc -l)" -eq 1 ] || fail "several packages have it"
}
has psplat usr/bin/psplat
has psplat usr/share/psplat/scenes/cornell.psd
has psplat usr/share/psplat/scenes/pictures/plate.png
has psplat usr/share/psplat/psd.schema.json
has psplat usr/share/mime/packages/psplat.xml
has psplat usr/share/bash-completion/completions/psplat
has psplat usr/share/zsh/vendor-completions/_psplat
has psplat usr/share/fish/vendor_completions.d/psplat.fish
has psplat usr/share/vim/vimfiles/ftdetect/psplat.vim
for page in "$PSPLAT_SOURCE"/man/*.[157]; do
    has psplat "usr/share/man/man${page##*.}/$(basename "$page").gz"
done
has libpsplat0 "$libdir/libpsplat.so.0"
for plugin in "$PSPLAT_SOURCE"/plugins/*/*.c; do
    kind=$(basename "$(dirname "$plugin")")
    [ "$kind" = examples ] || has libpsplat0 "$libdir/psplat/plugins-1/$kind/$(basename "$plugin" .c).so"
done
has libpsplat-dev "$libdir/libpsplat.so"
has libpsplat-dev "$libdir/pkgconfig/psplat.pc"
has libpsplat-dev usr/include/psplat/psplat.h
has libpsplat-dev usr/share/man/man3/libpsplat.3.gz
has libpsplat-dev usr/share/psplat/examples/render.c
has psplat-doc usr/share/doc/psplat/README.md
has psplat-doc usr/share/doc/psplat/docs/method.md
find root -name '*.[1-9]' -path '*/man/*' >uncompressed
expect_empty uncompressed

last=dependencies
version=$(field psplat Version)
field psplat Depends | grep -qF "libpsplat0 (= $version)" || fail "psplat: $(field psplat Depends)"
field libpsplat-dev Depends | grep -qF "libpsplat0 (= $version)" || fail "libpsplat-dev: $(field libpsplat-dev Depends)"
for library in libc6 libembree libflann libyaml; do
    field libpsplat0 Depends | grep -q $library || fail "libpsplat0 needs no $library"
done
for package in psplat libpsplat0; do
    ! field $package Depends | grep -qi mpi || fail "$package needs MPI"
done
dpkg-deb -e made/libpsplat0_*.deb control
expect_match control/shlibs '^libpsplat 0 libpsplat0 \(>= [0-9.]+\)$'
expect_match control/triggers '^activate-noawait ldconfig$'

# What was unpacked renders, and programs can be built against it.
last='render, unpacked'
root/usr/bin/psplat $small -q -o a.exr root/usr/share/psplat/scenes/cornell.psd >out 2>err || fail "$(cat err)"
expect_picture a.exr
if command -v pkg-config >/dev/null; then
    last='render.c, built and run'
    flags=$(PKG_CONFIG_PATH=root/$libdir/pkgconfig pkg-config --cflags --libs psplat)
    # shellcheck disable=SC2086
    eval "$CC -o render root/usr/share/psplat/examples/render.c $flags" || fail "it does not compile"
    LD_LIBRARY_PATH=root/$libdir ./render root/usr/share/psplat/scenes/cornell.psd b size=16x9 preview >out 2>&1 ||
        fail "$(cat out)"
    expect_picture b.exr
fi

# A .psd is a scene or a picture by what it holds.
if command -v update-mime-database >/dev/null && command -v gio >/dev/null &&
    [ -f /usr/share/mime/packages/freedesktop.org.xml ]; then
    mkdir -p data/mime/packages
    cp /usr/share/mime/packages/freedesktop.org.xml root/usr/share/mime/packages/psplat.xml data/mime/packages
    update-mime-database data/mime >log 2>&1 || fail "update-mime-database: $(cat log)"
    # type_is TYPE FILE
    type_is() {
        last="gio info $2"
        XDG_DATA_DIRS=$PWD/data XDG_DATA_HOME=$PWD/none gio info -a standard::content-type "$2" >out 2>err
        expect_text out "standard::content-type: $1"
    }
    for scene in cornell cornell-spheres street; do # with and without comments in front
        type_is application/x-psplat-scene "root/usr/share/psplat/scenes/$scene.psd"
    done
    printf '%%YAML 1.1\n---\npsd: 1\n' >directive.psd
    type_is application/x-psplat-scene directive.psd
    printf '8BPS\000\001\000\000\000\000\000\000\000\003' >picture.psd
    type_is image/vnd.adobe.photoshop picture.psd
    printf '8BPS\000\001\000\000\000\000\000\000\000\003\npsd: 1\n' >both.psd
    type_is image/vnd.adobe.photoshop both.psd
    printf 'psd: 1\n' >scene.yaml
    type_is application/x-yaml scene.yaml
else
    echo "no gio, update-mime-database or shared-mime-info: the MIME type is not tried"
fi

if [ -n "${PSPLAT_QUICK:-}" ] || ! command -v lintian >/dev/null; then
    echo "no lintian, or a quick test: the packages' form is not checked"
    finish
fi
last=lintian
lintian --fail-on error made/*.deb >out 2>err || fail "errors: $(grep '^E:' out err)"
finish
