# lib.sh: walks scenes.txt. The pictures are small, so that they can lie in the repository.

golden_folder=$PSPLAT_SOURCE/tests/golden
golden_size=64x36

trim() {
    printf '%s' "$1" | sed 's/^ *//; s/ *$//'
}

# Calls "$1 NAME SCENE OPTIONS" for every line of scenes.txt.
for_each_golden() {
    while IFS='|' read -r name scene options description; do
        case $name in '#'* | '') continue ;; esac
        [ -n "$description" ] || { echo "scenes.txt: $name lacks its description"; return 1; }
        "$1" "$(trim "$name")" "$(trim "$scene")" "$options" || return 1
    done <"$golden_folder/scenes.txt"
}

# render_golden SCENE OPTIONS FILE
render_golden() {
    # shellcheck disable=SC2086 # options are several words
    (cd "$PSPLAT_SOURCE" && "$PSPLAT" render "$1" --quiet --size $golden_size $2 -o "$3")
}
