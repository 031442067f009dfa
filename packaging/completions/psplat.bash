# psplat.bash: completion of psplat's command lines in bash; psplat itself knows what may stand where.

_psplat() {
    local word lead i typed candidate tail break='' help more IFS=$' \t\n'
    local rest=${COMP_LINE:0:COMP_POINT} words=() files=()
    # Bash cuts words at '=' and ':' too; what no blank separates is one word to psplat.
    for ((i = 0; i <= COMP_CWORD; i++)); do
        lead=${rest%%[![:space:]]*}
        rest=${rest#"$lead"}
        word=${COMP_WORDS[i]}
        ((i < COMP_CWORD)) || word=$rest
        rest=${rest#"$word"}
        if ((i > 0)) && [[ -z $lead ]]; then
            words[${#words[@]} - 1]+=$word
        else
            words+=("$word")
        fi
    done
    typed=${words[${#words[@]} - 1]}
    # Bash replaces what follows the last place at which it cut.
    for ((i = 0; i < ${#typed}; i++)); do
        [[ ${typed:i:1} != [=:] || $COMP_WORDBREAKS != *"${typed:i:1}"* ]] || break=${typed:0:i+1}
    done
    tail=${typed#"$break"}
    COMPREPLY=()
    while IFS=$'\t' read -r candidate more help; do
        case $candidate in
        :files | :folders)
            compopt -o filenames
            mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -d -- "$tail")
            [[ $candidate == :folders ]] || read -ra files <<<"$help"
            [[ $candidate == :folders || ${#files[@]} -gt 0 ]] || files=('')
            ;;
        *)
            candidate=${candidate#"$break"}
            # Names of a scene may hold anything, and what stands here is run.
            [[ $candidate != *[!A-Za-z0-9_.,:=+/@%-]* ]] || printf -v candidate %q "$candidate"
            COMPREPLY+=("$candidate")
            [[ $more == - ]] || compopt -o nospace
            ;;
        esac
    done < <("${words[0]/#\~/$HOME}" complete -- "${words[@]:1}" 2>/dev/null)
    for word in "${files[@]}"; do
        mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -X "!*$word" -- "$tail")
    done
}

complete -F _psplat psplat
