# psplat.fish: completion of psplat's command lines in fish; psplat itself knows what may stand where.

function __psplat_complete
    set -l words (commandline -opc) (commandline -ct)
    set -l typed $words[-1]
    # What stands before a file in the same word: --output=
    set -l before (string match -r -- '^--[^=]*=' $typed)
    for line in (command $words[1] complete -- $words[2..] 2>/dev/null)
        set -l fields (string split \t -- $line)
        switch $fields[1]
            case :folders
                printf "$before%s\n" (__fish_complete_directories (string replace -- "$before" '' $typed))
            case :files
                set -l suffixes (string split -n ' ' -- $fields[3])
                for file in (complete -C "'' "(string escape -n -- (string replace -- "$before" '' $typed)))
                    set -l name (string split \t -- $file)[1]
                    if test -z "$suffixes"; or string match -q -- '*/' $name; or contains -- (string match -r -- '\.[^.]*$' $name) $suffixes
                        echo "$before$name"
                    end
                end
            case '*'
                printf '%s\t%s\n' $fields[1] $fields[3]
        end
    end
end

complete -c psplat -f -a '(__psplat_complete)'
