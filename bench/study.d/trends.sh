# shellcheck shell=bash disable=SC2154 # variables are those of bench/study
# trends.sh: what the thesis found, each as a number with a bound. Sourced by bench/study.

start_trends() {
    echo 'id,value,bound,verdict,statement' >"$out/trends.csv"
}

# trend ID VALUE RELATION BOUND STATEMENT: RELATION is <, <=, > or >=.
trend() {
    local verdict='does not hold'
    [[ $(calculate "$2 $3 $4") != 1 ]] || verdict=holds
    row trends "$1" "$2" "$3 $4" "$verdict" "$5"
}

# ratio A B
ratio() {
    calculate "$1 / $2"
}

# How much of the ceiling's contrast, bright over dim less 1, a render keeps.
contrast_kept() {
    local truth
    truth=$(ratio "$(cell levels ceiling-bright/reference level)" "$(cell levels ceiling-dim/reference level)")
    calculate "($(cell levels "ceiling-bright/$1" level) / $(cell levels "ceiling-dim/$1" level) - 1) / ($truth - 1)"
}

# Largest distance of a render's three means from the reference's.
worst_bias() {
    awk -v r="$(cell points "$1" bias_r)" -v g="$(cell points "$1" bias_g)" -v b="$(cell points "$1" bias_b)" '
        function off(x) { return x < 1 ? 1 - x : x - 1 }
        BEGIN { w = off(r); if (off(g) > w) w = off(g); if (off(b) > w) w = off(b); printf "%.4f\n", w }'
}

# Mean brightness of both shaded places over the reference's.
shade() {
    calculate "($(cell levels "shade-left/$1" ratio) + $(cell levels "shade-right/$1" ratio)) / 2"
}

# Light behind the tall block over the reference's, as a multiple of the same ratio of the whole picture, which a large
# close box makes darker: what an eye sees that takes the picture's brightness for granted.
# leak PLACE RENDER
leak() {
    calculate "3 * $(cell levels "$1/$2" ratio) /
        ($(cell points "$2" bias_r) + $(cell points "$2" bias_g) + $(cell points "$2" bias_b))"
}

judge_trends() {
    local name place
    start_trends
    for place in wall floor; do
        for name in small-weight-4 leak-large-weight small-density-4 leak-large-density own-2 leak-large-own; do
            row figures "${place}_${name//-/_}" "$(leak "$place" "$name")"
        done
    done
    trend converge "$(ratio "$(cell figures noise_large value)" "$(cell figures noise_small value)")" '<' 0.6 \
        'larger maps converge faster: noise over that of small maps at equal paths'
    trend floor "$(ratio "$(cell points small-weight-5 rel_rmse)" "$(cell points small-weight-3 rel_rmse)")" '>' 0.9 \
        'the error of weight stays: with 16 times as many paths over without'
    trend leak-weight "$(ratio "$(leak wall leak-large-weight)" "$(leak wall small-weight-4)")" '>' 1.1 \
        'larger maps leak behind the boxes (weight): relative brightness over that by small maps'
    trend leak-density "$(ratio "$(leak wall leak-large-density)" "$(leak wall small-density-4)")" '>' 1.1 \
        'larger maps leak behind the boxes (density): relative brightness over that by small maps'
    if [[ $conditions == conference* ]]; then
        trend chairs "$(ratio "$(shade chairs-full-4)" "$(shade chairs-full-32)")" '>' 1.2 \
            'maps of 4x4 lose the shadows of chairs that 32x32 keep: brightness there over that by 32x32'
        for name in full-4 full-32 close-4 close-32; do
            row figures "shade_${name/-/_}" "$(shade "chairs-$name")"
        done
    fi
    trend ceiling-weight "$(contrast_kept small-weight-4)" '<' 0.5 \
        'weight flattens the ceiling: share of its contrast that is kept'
    trend ceiling-density "$(contrast_kept small-density-5)" '>' 0.85 \
        'density does not: share of the contrast that is kept'
    trend ceiling-strata "$(contrast_kept strat-density-4)" '>' 0.8 \
        'nor does it where photons are stratified: share of the contrast that is kept'
    for name in pm-3 large-weight-5 strat-weight-4 large-density-5 own-4; do
        row figures "contrast_${name//-/_}" "$(contrast_kept "$name")"
    done
    row figures contrast_reference \
        "$(ratio "$(cell levels ceiling-bright/reference level)" "$(cell levels ceiling-dim/reference level)")"
    trend disparity "$(ratio "$(cell figures noise_merged_many value)" "$(cell figures noise_unmerged value)")" '>' 1.2 \
        'many photons a voxel make disparities: noise over that of as many photons never merged'
    trend saturation "$(ratio "$(cell figures noise_merged_many value)" "$(cell figures noise_merged_few value)")" '>' 0.5 \
        'more photons in the same voxels help little: noise with 16 times as many (0.25 without merging)'
    trend drift "$(worst_bias open-1)" '<' 0.02 'stratified with density: no drift of intensity (largest bias of a channel)'
    trend memory "$(cell points open-1 own_mb)" '<=' 5.76 'stratified with density: at most a hundredth of 576 MB (MB)'
}

# A line for each trend; fails where one does not hold.
report_trends() {
    awk -F, 'NR > 1 { printf "%-13s  %-16s %-9s (%s)  %s\n", $4, $1, $2, $3, $5; if ($4 != "holds") failed = 1 }
        END { exit failed }' "$out/trends.csv" || ((quick)) || return 1
}

# Seconds that each method takes to a relative error, on straight lines between its points in logarithms.
table_of_equal_errors() {
    awk -F, '
        function time_to(method, goal,    i, share) {
            if (wrong[method, 1] <= goal) return sprintf("%.2g or less", seconds[method, 1])
            for (i = 2; i <= count[method]; i++) {
                if (wrong[method, i] > goal) continue
                share = log(wrong[method, i - 1] / goal) / log(wrong[method, i - 1] / wrong[method, i])
                return sprintf("%.2g", exp(log(seconds[method, i - 1]) * (1 - share) + log(seconds[method, i]) * share))
            }
            return "not reached"
        }
        function title(method) {
            sub(/^pm$/, "photon mapping", method)
            sub(/^path$/, "path tracing", method)
            sub(/^own$/, "psplat", method)
            sub(/^strat-/, "stratified; ", method)
            sub(/-/, " maps; ", method)
            return method
        }
        NR > 1 && $2 == "cornell" && $3 != "open" && $3 != "leak" {
            if (!count[$3]++) order[++methods] = $3
            seconds[$3, count[$3]] = $7
            wrong[$3, count[$3]] = $9
        }
        END {
            print "id,method,20 %,10 %,7 %,5 %"
            for (i = 1; i <= methods; i++) {
                m = order[i]
                printf "%s,%s,%s,%s,%s,%s\n", m, title(m), time_to(m, 0.2), time_to(m, 0.1), time_to(m, 0.07), time_to(m, 0.05)
            }
        }' "$out/points.csv" >"$out/equal.csv"
}
