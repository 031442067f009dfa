# Includes between the modules of the source tree go one way, as tests/cli/modules.txt has them.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

# module_problems TREE: what is wrong with the includes of that tree, a line each.
module_problems() {
    (cd "$1" && grep -r --include='*.[ch]' '^#include' src parser plugins) |
        sed 's|^\([^:]*\):#include \(["<][^">]*\).*|\1 \2|' | awk '
        function module_of(path, parts, depth) {
            sub(/^src\//, "", path)
            depth = split(path, parts, "/")
            return parts[1] == "parser" && depth > 2 ? "parser/" parts[2] : parts[1]
        }
        NR == FNR {
            if (/^#/ || NF == 0) next
            name = $1
            sub(/:$/, "", name)
            if (name ~ /^</) { home[name] = $2; next }
            known[name] = 1
            for (i = 2; i <= NF; i++) {
                if (!($i in known)) print "modules.txt: " name " names " $i ", which is not above it"
                allowed[name, $i] = 1
                edges[name " " $i] = 1
            }
            next
        }
        /^[^ ]* </ {
            for (library in home)
                if (index($2, library) == 1 && substr($2, length(library) + 1, 1) !~ /[a-z]/ && index($1, home[library] "/") != 1)
                    print $1 " includes " $2 ">, which is for " home[library]
            next
        }
        {
            from = module_of($1)
            to = module_of(substr($2, 2))
            split($1, parts, "/")
            sub(/\.c$/, "", parts[3]) # plugins/KIND/NAME.c may have a folder NAME, and share plugins/KIND/shared
            if (from == "plugins" && (index($2, "\"" parts[3] "/") == 1 || index($2, "\"shared/") == 1 || (parts[4] != "" && index($2, "\"../shared/") == 1) || $2 !~ /\//)) next
            if (from == "plugins") { print $1 " includes " $2 "\": plugins include <psplat/...> and their own folder"; next }
            if (!(from in known)) print "modules.txt: no module " from
            used[from " " to] = 1
            if (from != to && !((from, to) in allowed)) print $1 " includes " $2 "\": " from " may not use " to
        }
        END { for (edge in edges) if (!(edge in used)) print "modules.txt: nothing uses " edge }
    ' "$PSPLAT_SOURCE/tests/cli/modules.txt" - | sort -u
}

module_problems "$PSPLAT_SOURCE" >problems
expect_empty problems

# It finds what is wrong.
mkdir tree
cp -r "$PSPLAT_SOURCE/src" "$PSPLAT_SOURCE/parser" "$PSPLAT_SOURCE/plugins" tree
wrong() {
    last="#include $2 in $1"
    cp "tree/$1" kept
    printf '#include %s\n' "$2" >>"tree/$1"
    module_problems tree >problems
    mv kept "tree/$1"
    [ "$(wc -l <problems)" -eq 1 ] || fail "$(wc -l <problems) problems"
    expect_text problems "$3"
}
wrong src/base/text.c '"scene/scene.h"' 'base may not use scene'
wrong src/scene/shape.c '"pipeline/render.h"' 'scene may not use pipeline'
wrong parser/yaml/node.c '"parser/sections/reader.h"' 'parser/yaml may not use parser/sections'
wrong parser/sections/value.c '"parser/psd.h"' 'parser/sections may not use parser'
wrong src/host/host.c '<embree3/rtcore.h>' 'which is for src/trace'
wrong plugins/filter/tent.c '"base/text.h"' 'plugins include <psplat/...> and their own folder'
wrong plugins/denoiser/regression/fit.c '"bilateral/fit.h"' 'plugins include <psplat/...> and their own folder'

finish
