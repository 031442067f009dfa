# shellcheck shell=bash disable=SC2154 # variables are those of bench/study
# pictures.sh: the thesis's figures and graphs. Sourced by bench/study.
#
# JPEG by netpbm where it is there, PNG where not; plots by gnuplot, where it is there.

box=340,0,920,900
ceiling=420,0,760,182
corner=990,110,160,160
behind=440,320,560,480
chair_backs=500,200,1000,620

# keep_picture NAME: moves $work/NAME.png into the page, in as few bytes as there are tools for.
keep_picture() {
    rm -f "$out/$1.png" "$out/$1.jpg"
    if command -v pngtopnm >/dev/null && command -v pnmtojpeg >/dev/null; then
        pngtopnm "$work/$1.png" | pnmtojpeg -quality 85 -optimize >"$out/$1.jpg"
        rm "$work/$1.png"
    else
        mv "$work/$1.png" "$out/$1.png"
    fi
}

# picture NAME RENDER [OPTION...]: options are those of psplat view.
picture() {
    "$psplat" view "$work/$2.exr" -o "$work/$1.png" "${@:3}"
    keep_picture "$1"
}

cornell_pictures() {
    local method level
    for method in pm strat-weight small-weight large-weight; do
        picture "low-$method" "$method-1" --crop "$(scaled "$box")"
    done
    for level in pm-3 strat-weight-4 small-weight-4 large-weight-3 own-4 cornell-a; do
        picture "high-$level" "$level" --crop "$(scaled "$box")"
    done
    for level in pm-3 small-weight-4 strat-weight-4 own-4 cornell-a; do
        picture "corner-$level" "$level" --layer indirect --exposure 1 --zoom 3 --crop "$(scaled "$corner")"
    done
    for level in pm-3 strat-weight-4 small-weight-4 large-weight-5 small-density-5 own-4 cornell-a; do
        picture "ceiling-$level" "$level" --layer indirect --crop "$(scaled "$ceiling")"
    done
    for level in small-weight-4 leak-large-weight small-density-4 leak-large-density cornell-a; do
        picture "behind-$level" "$level" --layer indirect --exposure 2 --crop "$(scaled "$behind")"
    done
    for level in merged-many-1 unmerged-1; do
        picture "$level" "$level" --crop "$(scaled "$box")"
    done
}

overlap_picture() {
    set_options thesis_splats 25000 "$small_size" weight
    "$psplat" debug overlap "$cornell" --plugin estimator=splat --quiet --size "$size" --top 600 "${options[@]}" -o "$work/overlap.png" >/dev/null
    keep_picture overlap
}

conference_pictures() {
    local level
    for level in room-pm room-strat room-small room-large room-own room-a; do
        picture "$level" "$level"
    done
    for level in chairs-full-4 chairs-full-32 chairs-close-4 chairs-close-32 chairs-a; do
        picture "$level" "$level" --layer indirect --exposure 3 --crop "$(scaled "$chair_backs")"
    done
}

draw_pictures() {
    cornell_pictures
    overlap_picture
    [[ $conditions != conference* ]] || conference_pictures
}

# curve_data METHOD TITLE: seconds, thesis's metric, relative RMSE in per cent; the titles of columns are those of curves.
curve_data() {
    awk -F, -v method="$1" -v title="$2" '
        BEGIN { printf "seconds \"%s\" \"%s\"\n", title, title }
        $2 == "cornell" && $3 == method { print $7, $8, 100 * $9 }' "$out/points.csv" >"$work/$1.dat"
}

# graph NAME METHOD...
graph() {
    (cd "$work" && gnuplot -e "output='$out/$1.svg'; files='${*:2}'" "$parts/graph.gp")
}

draw_graphs() {
    local normalization
    if ! command -v gnuplot >/dev/null; then
        echo 'plots: skipped (there is no gnuplot)'
        return
    fi
    conditions+=' plots'
    curve_data pm 'photon mapping'
    for normalization in weight density; do
        curve_data "small-$normalization" "small maps, $normalization"
        curve_data "large-$normalization" "large maps, $normalization"
        curve_data "strat-$normalization" "stratified, $normalization"
    done
    curve_data own 'psplat'
    curve_data path 'path tracing'
    graph graph1 pm path
    graph graph2 small-weight small-density own path
    graph graph3 large-weight large-density own path
    graph graph4 strat-weight strat-density own path
    graph graph5 pm small-weight large-weight strat-weight small-density large-density strat-density own path
}
