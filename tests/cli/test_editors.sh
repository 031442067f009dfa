# What editors are given: Vim's files, and settings in docs/editors.md.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

# The settings are JSON, and the pattern of the task finds what `check` prints.
if command -v python3 >/dev/null; then
    printf 'psd: 1\nimgae: {width: 5}\n' >wrong.psd
    run 2 check wrong.psd
    cat >settings.py <<'END'
import json, re, sys

parts = re.findall(r"```json\n(.*?)```", open(sys.argv[1]).read(), re.DOTALL)
settings, tasks = (json.loads(part) for part in parts)
assert settings["files.associations"] == {"*.psd": "yaml"}
assert [path.rpartition("/")[2] for path in settings["yaml.schemas"]] == ["psd.schema.json"]
pattern = tasks["tasks"][0]["problemMatcher"]["pattern"]
found = [re.match(pattern["regexp"], line) for line in open("err")]
print([match.group(pattern["file"], pattern["line"], pattern["severity"]) for match in found if match])
END
    last='settings of docs/editors.md'
    python3 settings.py "$PSPLAT_SOURCE/docs/editors.md" >out 2>log || fail "$(tail -n 1 log)"
    expect_text out "('wrong.psd', '2', 'error')"
fi

command -v vim >/dev/null || {
    echo "no vim: its files are not tried"
    finish
}
vim --version | grep -q '[+]eval' || {
    echo "this vim has no scripts: its files are not tried"
    finish
}

mkdir bin
ln -s "$PSPLAT" bin/psplat
PATH=$PWD/bin:$PATH
cp "$cornell" scene.psd
printf 'psd: 1\nimgae:   {width: 5}\n' >wrong.psd
printf '8BPS\001\n' >picture.psd
printf 'a: 1\n# vim: filetype=yaml\n' >modeline.txt
printf 'psd: 1\nimage: {width:   5\n' >broken.psd
cat >try.vim <<'END'
filetype plugin on
set modeline
let lines = []
for file in ['scene.psd', 'new.psd', 'picture.psd', 'modeline.txt']
  execute 'edit!' file
  call add(lines, file . ' ' . &filetype)
endfor
edit wrong.psd
silent make!
call extend(lines, map(getqflist(), 'v:val.lnum . ":" . v:val.col . v:val.type . " " . v:val.text'))
silent normal! gqq
call extend(lines, getline(1, '$'))
edit! broken.psd
silent! normal! gqq
call add(lines, 'broken: ' . join(getline(1, '$'), '|'))
call writefile(lines, 'log')
qall!
END
last=vim
timeout 60 vim -es -N -u NONE -i NONE --cmd "set runtimepath^=$PSPLAT_SOURCE/packaging/vim" -S try.vim >out 2>&1 </dev/null
expect_text log 'broken: psd: 1|image: {width:   5'
expect_match log '^scene.psd yaml$'
expect_match log '^new.psd yaml$'
expect_match log '^picture.psd $'
expect_match log '^modeline.txt yaml$'
expect_match log "^2:1e unknown key 'imgae' in scene"
expect_match log '^imgae: \{width: 5\}$'

finish
