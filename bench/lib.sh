# lib.sh: what the measurements in bench/ share; sourced, not run. POSIX sh.

# no_options "$@": a script that knows arguments alone prints its head for --help, and refuses what else begins with "-".
no_options() {
    case ${1-} in
    -h | --help)
        awk 'NR > 1 && !/^#/ { exit } NR > 1 { sub(/^# ?/, ""); print }' "$0"
        exit 0
        ;;
    -*)
        echo "$(basename "$0"): there is no option $1; --help says what there is" >&2
        exit 2
        ;;
    esac
}

# statistic SECTION NAME FILE: a number of a --stats file. The section is seconds, counters or bytes: a counter
# may have the name of a purpose of memory. Prints nothing where there is no such number.
statistic() {
    awk -v section="\"$1\":" -v name="\"$2\":" '
        $1 ~ /^"/ && $NF == "{" { inside = ($1 == section) }
        inside && index($0, name) {
            number = substr($0, index($0, name) + length(name))
            gsub(/[ ,]/, "", number)
            print number
        }' "$3"
}

# own_bytes FILE: the memory that belongs to the estimator of that --stats file: sources, strata, splats, maps, bins,
# photons and their tree. The scene, the film and the G-buffer with its copy for splats, which go by the picture, do not count.
own_bytes() {
    awk '
        $1 ~ /^"/ && $NF == "{" { inside = ($1 == "\"bytes\":") }
        /"photon tree bytes":/ || (inside && /": / && !/"ray tracer":|"G-buffer":|"film":|"splatted pixels":/) {
            gsub(/,/, "", $NF)
            sum += $NF
        }
        END { printf "%.0f\n", sum }' "$1"
}
