# shellcheck shell=bash disable=SC2154 # variables are those of bench/study
# measure.sh: errors, brightness of regions, and the CSV files that hold them. Sourced by bench/study.
#
# Each file in $out begins with a line of column names; the first column is the row's id, by which the page asks for
# a number. No field holds a comma.

start_tables() {
    echo 'id,scene,method,level,paths,size,seconds,thesis_rmse,rel_rmse,bias_r,bias_g,bias_b,own_mb' >"$out/points.csv"
    echo 'id,region,render,level,ratio' >"$out/levels.csv"
    echo 'id,samples,thesis_rmse,rel_rmse' >"$out/references.csv"
    echo 'id,value' >"$out/figures.csv"
}

# row FILE FIELD...: stops at a field that could not be found or calculated.
row() {
    local field IFS=,
    for field in "${@:2}"; do
        [[ -n $field ]] || {
            echo "study: error: no value for a field of $1.csv: ${*:2}" >&2
            exit 1
        }
    done
    echo "${*:2}" >>"$out/$1.csv"
}

# calculate EXPRESSION: by awk, to six digits; 1 or 0 for a comparison.
calculate() {
    awk "BEGIN { printf \"%.6g\\n\", (${1//$'\n'/ }) }"
}

# metric NAME REFERENCE TEST [OPTION...]: the numbers of one metric of the indirect layer.
metric() {
    "$psplat" compare "$work/$2.exr" "$work/$3.exr" --layer indirect --metric "$1" "${@:4}" | cut -d' ' -f2-
}

# errors REFERENCE TEST: thesis_rmse rel_rmse bias_r bias_g bias_b, against both halves of a reference. With
# independent halves A and B, mean((I - A)(I - B)) is the squared error without the reference's noise; it is
# (|I - A|^2 + |I - B|^2 - |A - B|^2) / 2. The thesis's metric is no sum of squares: its two values are averaged.
errors() {
    local half
    for half in a b; do
        "$psplat" compare "$work/$1-$half.exr" "$work/$2.exr" --layer indirect \
            --metric thesis_rmse --metric rel_rmse --metric bias
    done | awk -v between="$(metric rel_rmse "$1-a" "$1-b")" '
        $1 == "thesis_rmse" { thesis += $2 / 2 }
        $1 == "rel_rmse" { square += $2 ^ 2 / 2 }
        $1 == "bias" { for (i = 2; i <= 4; i++) bias[i] += $i / 2 }
        END {
            square -= between ^ 2 / 2
            printf "%.3f %.5f %.4f %.4f %.4f\n", thesis, (square > 0) ? sqrt(square) : 0, bias[2], bias[3], bias[4]
        }'
}

# Noise of the mean of a reference's halves: half of their difference.
measure_reference() {
    row references "$1" "$2" "$(calculate "$(metric thesis_rmse "$1-a" "$1-b") / 2")" \
        "$(calculate "$(metric rel_rmse "$1-a" "$1-b") / 2")"
}

# noise NAME: relative RMS difference of the renders NAME-1 and NAME-2, which differ in their seeds alone.
noise() {
    metric rel_rmse "$1-1" "$1-2"
}

# seconds FILE: injection and estimate, map, bin and splat in it, and normalization.
estimate_seconds() {
    calculate "$(statistic seconds estimate "$1") + $(statistic seconds normalize "$1")"
}

# point ID REFERENCE METHOD LEVEL PATHS SIZE SCENE OPTION...: renders, measures, and adds a row to points.csv. The row is
# kept beside the render. Of what takes less than a second the quickest of three renders counts.
point() {
    local id=$1 reference=$2 seconds wrong again key
    local -a fields=("${@:3:4}")
    shift 6
    render "$id" "$@"
    key="$(cksum <"$work/$id.key")|$(cat "$work/$reference-a.key" "$work/$reference-b.key" | cksum)"
    if [[ ! -f $work/$id.row || $(head -n 1 "$work/$id.row") != "$key" ]]; then
        seconds=$(estimate_seconds "$work/$id.json")
        for again in 1 2; do
            ((quick == 0 && $(calculate "$seconds < 1"))) || break
            "$psplat" render "$1" --quiet --size "$size" --passes 1 --plugin estimator=splat --plugin denoiser=none "${@:2}" -o "$work/again.exr" --stats "$work/again.json"
            seconds=$(awk -v a="$seconds" -v b="$(estimate_seconds "$work/again.json")" 'BEGIN { print (a < b) ? a : b }')
        done
        wrong=$(errors "$reference" "$id")
        echo "$key" >"$work/part.row"
        echo "$seconds $wrong $(calculate "$(own_bytes "$work/$id.json") / 1e6")" >>"$work/part.row"
        mv "$work/part.row" "$work/$id.row"
    fi
    # The numbers are words on purpose.
    # shellcheck disable=SC2046
    row points "$id" "$reference" "${fields[@]}" $(tail -n 1 "$work/$id.row")
}

# scaled X,Y,W,H: a region stated in pixels of 1600x900, in those of this run.
scaled() {
    awk -F, -v f="$width" '{
        f /= 1600
        w = int($3 * f + 0.5)
        h = int($4 * f + 0.5)
        printf "%d,%d,%d,%d\n", int($1 * f + 0.5), int($2 * f + 0.5), (w > 2) ? w : 2, (h > 2) ? h : 2
    }' <<<"$1"
}

# brightness RENDER AMBIENT REGION: mean indirect light of a region, as multiples of even light of irradiance 1: the
# mean over channels of the ratio to the render AMBIENT.
brightness() {
    metric bias "$2" "$1" --crop "$(scaled "$3")" | awk '{ printf "%.5f\n", ($1 + $2 + $3) / 3 }'
}

# level REGION NAME AMBIENT REFERENCE RENDER...: rows of levels.csv, ids REGION/RENDER; that of the reference first.
level() {
    local region=$1 name=$2 ambient=$3 reference=$4 truth render this
    shift 4
    truth=$(brightness "$reference-a" "$ambient" "$region")
    truth=$(calculate "($truth + $(brightness "$reference-b" "$ambient" "$region")) / 2")
    row levels "$name/reference" "$name" reference "$truth" 1
    for render in "$@"; do
        this=$(brightness "$render" "$ambient" "$region")
        row levels "$name/$render" "$name" "$render" "$this" "$(calculate "$this / $truth")"
    done
}

# cell FILE ID COLUMN: a field of a CSV file.
cell() {
    awk -F, -v id="$2" -v column="$3" '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i == column) field = i }
        NR > 1 && $1 == id { print $field; found = 1 }
        END { if (!found || !field) { print "no " column " of " id > "/dev/stderr"; exit 1 } }' "$out/$1.csv"
}
