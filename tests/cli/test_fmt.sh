# psplat fmt: scenes laid out evenly, with the same meaning.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

# Scenes that psplat ships are laid out already.
run 0 fmt --check "$PSPLAT_SOURCE"/scenes/*.psd "$PSPLAT_SOURCE"/scenes/library/*.psd
expect_empty out
expect_empty err
run 0 new first.psd
run 0 fmt --check first.psd

# spoil: a scene with other blanks and indentation, which means the same.
spoil() {
    sed 's/^\( *\)/\1\1/; s/^\( *\)- /\1-   /; s/$/  /; s/: {/:   { /; s/} *$/ }   /; s/, \([-0-9.]\)/ ,\1/g; /^[a-z]*: *$/s/$/\n\n\n/' "$1"
}

# digests FILE: of what the scene describes, as its film has them.
digests() {
    rm -f film.exr
    run 0 -q --size 8x8 --passes 0:1 --checkpoint film.exr -p estimator=ambient -p denoiser=none "$1"
    run 0 info film.exr
    grep '^psplat.digest' out
}

cp -r "$PSPLAT_SOURCE/scenes/library" "$PSPLAT_SOURCE/scenes/pictures" .
for scene in "$PSPLAT_SOURCE"/scenes/*.psd; do
    name=$(basename "$scene")
    spoil "$scene" >"$name"
    last="psplat fmt $name"
    cmp -s "$scene" "$name" && fail "nothing is spoilt"
    run 1 fmt --check "$name"
    [ "$(cat out)" = "$name" ] || fail "--check names '$(cat out)'"
    cp "$name" spoilt
    run 0 fmt "$name"
    expect_empty out
    expect_empty err
    # Comments, order and words: all but blanks.
    tr -d ' \n' <spoilt >a
    tr -d ' \n' <"$name" >b
    expect_same a b
    cp "$name" once
    run 0 fmt "$name"
    expect_same once "$name"
    run 0 fmt --check "$name"
    case $name in
    conference.psd | cornell-mcguire.psd) continue ;; # of meshes that are not here
    lanterns.psd | rooms.psd | street.psd) continue ;; # large
    esac
    digests "$scene" >digests_before
    digests "$name" >digests_after
    [ "$(wc -l <digests_before)" -eq 5 ] || fail "no digests"
    expect_same digests_before digests_after
done

# From standard input to standard output.
"$PSPLAT" fmt - <spoilt >out 2>err || fail "standard input"
expect_same out once
# The second finds its end at once.
"$PSPLAT" fmt - - <spoilt >out 2>err || fail "standard input, twice: $(cat err)"
"$PSPLAT" fmt --check - <once >out 2>err || fail "standard input, checked"
expect_empty out

# A fault is told, and nothing written; the other files are laid out.
printf 'a: {b:   1\n' >faulty.psd
cp faulty.psd kept
printf 'a:   1\n' >good.psd
run 2 fmt faulty.psd good.psd
expect_text err "faulty.psd:"
expect_same faulty.psd kept
[ "$(cat good.psd)" = 'a: 1' ] || fail "the other file: $(cat good.psd)"
run 2 fmt missing.psd
expect_text err missing.psd
run 2 fmt .
run 2 fmt
expect_text err "fmt: which files?"
[ -z "$(find . -name '.*.psd*')" ] || fail "temporary files stay"

# A link stays one, and a file that is laid out is not written.
printf 'a:   1\n' >target.psd
ln -s target.psd link.psd
run 0 fmt link.psd
[ -L link.psd ] || fail "the link is gone"
[ "$(cat target.psd)" = 'a: 1' ] || fail "the link's file: $(cat target.psd)"
before=$(stat -c '%i %Y' target.psd)
run 0 fmt target.psd
[ "$(stat -c '%i %Y' target.psd)" = "$before" ] || fail "it was written"
chmod 640 target.psd
printf 'a:   1\n' >target.psd
run 0 fmt target.psd
[ "$(stat -c %a target.psd)" = 640 ] || fail "its permissions are $(stat -c %a target.psd)"
# As root alone, who may give files away.
if chown 1:2 target.psd 2>chown; then
    printf 'a:   1\n' >target.psd
    run 0 fmt target.psd
    expect_empty err
    [ "$(stat -c %u:%g:%a target.psd)" = 1:2:640 ] || fail "it is now $(stat -c %u:%g:%a target.psd)"
fi

finish
