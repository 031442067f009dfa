# The manual pages agree with the program: options, kinds, strategies, parameters, statistics, layers
# and attributes, each way. tests/unit/test_schema_manual.c does the same for the scene language.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

man=$PSPLAT_SOURCE/man

# agree WHAT: the files `program` and `page` hold the same lines, in any order.
agree() {
    last=$1
    sort program >program.sorted
    sort page >page.sorted
    cmp -s program.sorted page.sorted && return
    fail "the program (-) and the manual (+) differ:"
    diff -U 0 program.sorted page.sorted | sed '1,2d; /^@@/d; s/^/    /'
}

# part PAGE HEADING: the lines of a page below a heading, up to the next one of its rank.
part() {
    awk -v heading="$2" '
        $0 == heading { rank = substr(heading, 1, 3); inside = 1; next }
        inside && (/^\.Sh/ || substr($0, 1, 3) == rank) { inside = 0 }
        inside' "$1"
}

# --- options ---

option_lines() {
    "$PSPLAT" "$@" --help | sed -n '
        s/^  -\(.\), --\([a-z-]*\) \([^ ][^ ]*\) .*/.It Fl \1 , Fl Fl \2 Ar \3/p; t
        s/^  -\(.\), --\([a-z-]*\) .*/.It Fl \1 , Fl Fl \2/p; t
        s/^      --\([a-z-]*\) \([^ ][^ ]*\) .*/.It Fl Fl \1 Ar \2/p; t
        s/^      --\([a-z-]*\) .*/.It Fl Fl \1/p'
}

commands=$("$PSPLAT" --help | sed -n '/^commands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
[ "$(echo "$commands" | wc -w)" -ge 4 ] || fail "no list of commands in the help"
echo "$commands" | sed 's/^/.Ss psplat /' >program
echo "$commands" | grep -qx explore || echo .Ss psplat explore >>program # it needs libmicrohttpd
grep '^\.Ss psplat ' "$man/psplat.1" >page
agree "commands of psplat(1)"
for command in $commands; do
    option_lines "$command" >program
    [ "$(wc -l <program)" -ge 2 ] || fail "no options in the help of $command"
    if [ -f "$man/psplat-$command.1" ]; then
        grep '^\.It Fl ' "$man/psplat-$command.1" >page
        grep -qxF ".Xr psplat-$command 1 ." "$man/psplat.1" ||
            fail "psplat(1) does not refer to psplat-$command(1)"
    else
        {
            part "$man/psplat.1" ".Sh COMMANDS" | sed '/^\.Ss/,$d'
            part "$man/psplat.1" ".Ss psplat $command"
        } | grep '^\.It Fl ' >page
    fi
    agree "options of $command"
done

# --- strategies ---

plugins=$man/psplat-plugins.7
"$PSPLAT" plugins | sed -n 's/^\([a-z]*\)  *.*\((default: .*)\)$/.It Cm \1 No \2/p' >program
part "$plugins" ".Sh KINDS" | grep '^\.It' >page
agree "kinds of psplat-plugins(7)"
"$PSPLAT" plugins | awk '/^[a-z]/ { kind = $1 } /^  / { print ".Ss " kind "=" $1 }' >program
part "$plugins" ".Sh STRATEGIES" | grep '^\.Ss' >page
agree "strategies of psplat-plugins(7)"
cp program strategies
# The text begins with the summary, and that of each parameter with its help. Those for experts stand behind a
# line of their own.
while read -r heading; do
    "$PSPLAT" plugins --expert "${heading#.Ss }" | awk '
        function sentence(text) {
            sub(/^ */, "", text)
            return toupper(substr(text, 1, 1)) substr(text, 2) "."
        }
        NR == 2 { print sentence($0) }
        /^parameters for experts:/ { level = "expert " }
        /^  [^ ]/ { name = $1; line = 0; next }
        /^      / && ++line == 1 { help = sentence($0) }
        /^      / && line == 2 { sub(/^ */, ""); print level ".It Cm " name " : No " $0 " " help }' >program
    part "$plugins" "$heading" | awk '
        NR == 1
        /^For experts:/ { level = "expert " }
        /^\.It/ { item = $0; getline; print level item " " $0 }' >page
    agree "text of ${heading#.Ss }"
done <strategies
for row in $(sed 's/^\.Ss //' strategies); do
    [ -f "$PSPLAT_SOURCE/plugins/${row%=*}/${row#*=}.c" ] || fail "$row is no plugin of psplat's"
done

# The example in the page is the one that the tests build.
part "$plugins" ".Sh EXAMPLES" | sed -n '/^\.Bd/,/^\.Ed/{/^\.Bd/d; /^\.Ed/d; s/\\e/\\/g; s/^\\&//; p;}' \
    >example.c
cmp -s example.c "$PSPLAT_SOURCE/plugins/examples/filter.c" ||
    fail "the example of psplat-plugins(7) is not plugins/examples/filter.c"

# --- statistics, layers and attributes ---

: >statistics
# gather_statistics WORD...: what a render with these options counts, of modules that keep memory too.
gather_statistics() {
    run_leaking 0 -q --size 16x9 --layers all,display "$@" -o a.exr --stats a.json "$cornell"
    awk '/^  "/ { split($0, part, "\""); table = part[2] }
         /^    "/ { split($0, key, "\""); print table ": " key[2] }' a.json >>statistics
}
splats="-p estimator=splat"
photon="$splats -p injection=photon:count=200"
gather_statistics $splats -p injection=rsm:resolution=8
gather_statistics $splats -p injection=voxel:resolution=8
gather_statistics $photon --set render.aa_samples=1 --passes 2
gather_statistics $photon --size 320x180 --time 0.001
run 0 info a.exr
sed -n 's/^\(psplat\.scaled[a-z_]*\): .*/\1/p' out >scaled
for choice in stratification=cascade estimator=splat estimator=photonmap estimator=sppm estimator=final_gather:samples=1 estimator=vpl:lights=8 estimator=lightcuts:lights=8 estimator=bdpt:samples=1 estimator=irradiance_cache:samples=6 estimator=radiosity:epsilon=1e-3 estimator=voxel_cone:resolution=8 estimator=lpv:cells=4 estimator=ssao estimator=hbao estimator=gather:samples=1 \
    denoiser=gaussian bloom=glare visibility=imperfect:points=1000; do
    gather_statistics $photon -p $choice --direct shadowmap --direct-resolution 8
done
gather_statistics -p injection=photon:count=200 -p estimator=gather:samples=8 --bounces all
for abuse in negative keep; do
    compile_module "$PSPLAT_SOURCE/include" "$PSPLAT_SOURCE/tests/plugins/abusive.c" "$PWD/abusive.so" "-DABUSE=\"$abuse\""
    gather_statistics $photon -p estimator=./abusive.so
done
sort -u statistics >program
for table in seconds counters bytes; do
    part "$man/psplat.1" ".Ss $table" | sed -n "s/^\.It Cm /$table: /p"
done >page
agree "statistics of psplat(1)"

run 0 info a.exr
sed -n 's/^channels: //p' out | tr ' ' '\n' >program
part "$man/psplat.1" ".Ss OpenEXR" | sed -n '/^\.It Cm psplat\./d; s/^\.It Cm //p' | tr -d ' ' |
    tr , '\n' >page
agree "layers of psplat(1)"
{
    echo psplat.command
    sed -n 's/^\(psplat\.[a-z_]*\): .*/\1/p' out
    cat scaled
} >program
part "$man/psplat.1" ".Ss OpenEXR" | sed -n 's/^\.It Cm \(psplat\..*\)/\1/p' >page
agree "attributes of psplat(1)"

# Those of a film beyond.
cp page picture
run 0 -q --size 16x9 --passes 0:1 --checkpoint film.exr "$cornell"
run 0 info film.exr
sed -n 's/^\(psplat\.[a-z_.]*\): .*/\1/p' out | grep -vxF -f picture >program
part "$man/psplat-film.5" ".Ss Attributes" | sed -n 's/^\.It Cm \(psplat\..*\)/\1/p' >page
agree "attributes of psplat-film(5)"
cp out films
run 0 -q --size 16x9 --passes 0:1 --checkpoint spheres.exr "$PSPLAT_SOURCE/scenes/cornell-spheres.psd"
run 0 info spheres.exr
cat out >>films
sed -n 's/^channels: //p' films | tr ' ' '\n' | sed -n 's/^sum\.//p' | grep -v '^odd\.\|^half\.' | sort -u >program
part "$man/psplat-film.5" ".Ss Sums" | sed -n 's/^\.It Cm //p' | tr -d ' ' | tr , '\n' |
    grep -v '^odd\.\|^half\.\|^hard' >page
agree "channels of psplat-film(5)"

# --- examples of scenes are scenes ---

awk '/^\.Bd/ { count++; inside = 1; next } /^\.Ed/ { inside = 0 }
     inside { print > ("example" count ".psd") }' "$man/psd.5"
scenes=0
for example in example*.psd; do
    grep -qx 'psd: 1' "$example" || continue
    scenes=$((scenes + 1))
    run 0 check "$example"
    expect_empty err
done
[ $scenes -ge 2 ] || fail "$scenes whole scenes in psd(5), expected 2"

# --- the pages are sound ---

if command -v mandoc >/dev/null; then
    for page in "$man"/*.[1-9]; do
        last="mandoc -T lint $page"
        mandoc -T lint -W warning "$page" >out 2>&1 || fail "mandoc complains"
        [ ! -s out ] || sed 's/^/    /' out
    done
else
    echo "no mandoc: the pages' form is not checked"
fi

finish
