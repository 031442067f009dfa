# What may stand next on a command line: psplat complete, and bash, zsh and fish, which ask it.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

completions=$PSPLAT_SOURCE/packaging/completions

# offers TEXT... -- WORD...: for the last of the words these are offered, and no others.
offers() {
    : >expected
    while [ "$1" != -- ]; do
        echo "$1" >>expected
        shift
    done
    shift
    run 0 complete -- "$@"
    expect_empty err
    cut -f 1 out | sort >offered
    sort -o expected expected
    cmp -s offered expected && return
    fail "offered (+), expected (-):"
    diff -U 0 expected offered | sed '1,2d; /^@@/d; s/^/    /'
}

cat >scene.psd <<'END'
psd: 1
parameters: {lamp: {default: 1, help: how bright}, lid: {default: 2}, mesh: {default: 3}}
cameras:
  front: {location: [0, 0, 1], look_at: [0, 0, 0]}
  side: {location: [1, 0, 0], look_at: [0, 0, 0]}
END

offers render resolve :files -- re
offers :files -- render scene
offers --param --passes --plugin --preview --progress -- render --p
offers --plugin -- view --plu
offers visibility= -- --plugin vis
offers estimator=gather -- --plugin estimator=gath
offers --plugin=estimator=gather -- --plugin=estimator=gath
offers estimator=gather:samples= estimator=gather:surfels= -- -p estimator=gather:s
offers -pestimator=gather:samples=4,surfels= -- -pestimator=gather:samples=4,s
offers estimator=gather:adaptive=yes estimator=gather:adaptive=no -- -p estimator=gather:adaptive=
offers visibility=shadowmap:radius=auto -- -p visibility=shadowmap:radius=
offers bloom= tonemap= -- view -p ''
offers normalization= denoiser= bloom= tonemap= -- resolve -p ''
offers -- view -p estimator=
offers -- -p ./no/plugin.so:
offers -- -p nonsense=
offers estimator=gather -- plugins estimator=ga
offers draft normal high final -- --quality ''
offers rays -- --direct r
offers all -- --bounces ''
offers direct,indirect -- --layers direct,in
offers none -- --layers no
offers front side -- scene.psd --camera ''
cat >hostile.psd <<'END'
psd: 1
cameras:
  "a $(touch ran)": {location: [0, 0, 1], look_at: [0, 0, 0]}
  "b\n:files": {location: [1, 0, 0], look_at: [0, 0, 0]}
parameters:
  p: {default: 1, help: "two\nq=\t+\tlines"}
END
offers 'a $(touch ran)' -- hostile.psd --camera ''
offers p= -- hostile.psd --param ''
offers lamp= lid= -- scene.psd --param l
offers -- --param l
offers -- no.psd --camera ''
offers gbuffer:normal -- debug gbuffer:n
offers :files -- debug photons ''
offers :files -- diff a.exr ''
offers -- diff a.exr b.exr ''
offers :files -- info a b c ''
offers :files -- merge a b ''
offers -- schema ''
offers :folders -- --restrict ''
offers :files -- -- --pl
offers :files -- --output=pic
offers -- --nonsense=
offers -- --quiet=
run 2 complete
expect_text err "complete: which words?"
run 0 complete -- render ''
expect_match out '^:files	-	 .psd .obj .*\.glb'
run 0 complete -- plugins estimator=gather
expect_match out '^estimator=gather	-	[a-z]'
run 0 complete -- -p estimator=gather
expect_match out '^estimator=gather	[+]	[a-z]'

# Each command's options are offered, and no others.
for command in $("$PSPLAT" --help | sed -n '/^commands:/,/^$/s/^  \([a-z]*\) .*/\1/p'); do
    "$PSPLAT" "$command" --help | sed -n 's/^  ....--\([a-z-]*\) .*/--\1/p' >options
    # shellcheck disable=SC2046
    offers $(cat options) -- "$command" --
    # Where an option takes a name, some are offered.
    "$PSPLAT" "$command" --help | sed -n 's/^  ....--\([a-z-]*\) NAME.*/\1/p' >named
    while read -r option; do
        case $option in param | camera) continue ;; esac
        run 0 complete -- "$command" "--$option" ''
        [ -s out ] || fail "nothing is offered for --$option"
    done <named
done

# Values that are offered are taken.
for option in quality compression progress layers isa; do
    run 0 complete -- "--$option" ''
    cut -f 1 out >values
    while read -r value; do
        last="--$option $value"
        "$PSPLAT" "--$option" "$value" missing.psd >out 2>err </dev/null
        case $(cat err) in
        *missing.psd* | *"this processor"*) ;;
        *) fail "not taken: $(cat err)" ;;
        esac
    done <values
done

# --- the shells ---

command -v python3 >/dev/null || {
    echo "no python3: the shells are not tried"
    finish
}
python3 -c 'import pty; pty.openpty()' 2>/dev/null || {
    echo "no pseudo-terminals: the shells are not tried"
    finish
}
cat >type.py <<'END'
"""type.py TEXT SHELL...: types TEXT and a tab into an interactive shell, and prints the line that this makes."""
import os, pty, re, select, sys, time


def read(descriptor, until):
    end, got = time.monotonic() + 30, b""
    while not re.search(until, got) and time.monotonic() < end:
        if select.select([descriptor], [], [], 0.1)[0]:
            try:
                got += os.read(descriptor, 65536)
            except OSError:
                break
    return got


pid, descriptor = pty.fork()
if pid == 0:
    os.environ.update(TERM="dumb", COLUMNS="400")
    os.execvp(sys.argv[2], sys.argv[2:])
read(descriptor, b"ready>")
# '#' shows where completion stopped. The line is not run, but printed.
os.write(descriptor, sys.argv[1].encode() + b"\t#\x01printf 'line[%s]\\n' '\x05'\r")
got = read(descriptor, rb"\nline\[.*\]")
os.close(descriptor) # hangs up
print(got.decode().rpartition("line[")[2].rpartition("]")[0])
os.waitpid(pid, 0)
END

mkdir bin zsh 'a folder'
ln -s "$PSPLAT" bin/psplat
PATH=$PWD/bin:$PATH
touch picture.exr 'two words.psd'

# try LINE TEXT: TEXT and a tab make that line in $shell.
try() {
    case $shell in
    bash) line=$(timeout 60 python3 type.py "$2" bash --noprofile --rcfile bashrc -i) ;;
    zsh) line=$(ZDOTDIR=$PWD/zsh timeout 60 python3 type.py "$2" zsh -i) ;;
    esac
    last="$shell: $2 and a tab"
    [ "$line" = "$1" ] || fail "the line is '$line', expected '$1'"
}

try_all() {
    try 'psplat render #' 'psplat rend'
    try 'psplat --plugin estimator=gather#' 'psplat --plugin estimator=gath'
    try 'psplat --plugin=estimator=gather:surfels=#' 'psplat --plugin=estimator=gather:surf'
    try 'psplat --layers direct,indirect #' 'psplat --layers direct,indir'
    try 'psplat info picture.exr #' 'psplat info p'
    try 'psplat --output=picture.exr #' 'psplat --output=p'
    try 'psplat two\ words.psd #' 'psplat two'
    try 'psplat scene.psd --camera side #' 'psplat scene.psd --camera s'
    try 'psplat hostile.psd --camera a\ \$\(touch\ ran\) #' 'psplat hostile.psd --camera a'
    try 'psplat --restrict a\ folder/#' 'psplat --restrict a'
}

if command -v bash >/dev/null; then
    shell=bash
    echo "PS1='ready>'; . '$completions/psplat.bash'; bind 'set enable-bracketed-paste off'" >bashrc
    try_all
fi
if command -v zsh >/dev/null; then
    shell=zsh
    cat >zsh/.zshrc <<END
PS1='ready>'
fpath=('$completions' \$fpath)
autoload -U compinit
compinit -u -D
END
    try_all
fi

# fish_offers LINE TEXT
fish_offers() {
    last="fish: $2"
    HOME=$PWD timeout 60 fish --no-config -c "source '$completions/psplat.fish'; complete -C '$2'" >out 2>err
    cut -f 1 out | tr '\n' ' ' >words
    [ "$(cat words)" = "$1 " ] || fail "it offers '$(cat words)', expected '$1'"
    expect_empty err
}
if command -v fish >/dev/null; then
    fish_offers 'render' 'psplat rend'
    fish_offers 'estimator=gather' 'psplat --plugin estimator=gath'
    fish_offers '--plugin=estimator=gather:surfels=' 'psplat --plugin=estimator=gather:surf'
    fish_offers 'direct,indirect' 'psplat --layers direct,indir'
    fish_offers 'picture.exr' 'psplat info pi'
    fish_offers '--output=picture.exr' 'psplat --output=pi'
    fish_offers 'two words.psd' 'psplat two'
    fish_offers 'side' 'psplat scene.psd --camera s'
    fish_offers 'a folder/' 'psplat --restrict a'
fi

finish
