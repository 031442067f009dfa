# shellcheck shell=bash disable=SC2154 # variables are those of bench/study
# cornell.sh: the thesis's Cornell box: the points of its graphs, and what its figures show. Sourced by bench/study.

# Regions in pixels of 1600x900. Ceiling: over the middle of the box, and near its back edge. Behind the tall block: the
# back wall at its upper right edge, and the floor between it and the red wall.
ceiling_bright=720,80,160,56
ceiling_dim=560,160,80,20
behind_wall=824,380,64,48
behind_floor=556,748,28,24

# curve METHOD LEVEL PATHS SIZE OPTIONS-FUNCTION ARGUMENT...: one point.
curve() {
    local method=$1 level=$2 n=$3 half_width=$4
    shift 4
    set_options "$@"
    point "$method-$level" cornell "$method" "$level" "$(paths "$n")" "$half_width" "$cornell" "${options[@]}"
}

study_cornell() {
    local samples=2048
    ((quick)) && samples=64
    reference cornell "$cornell" "$samples"
    measure_reference cornell "$samples"
    render ambient "$cornell" --plugin estimator=ambient:irradiance=1
    cornell_curves
    cornell_open_end
    cornell_noise
    cornell_disparity
    cornell_regions
    table_of_memory
}

# From low to high parameters. The thesis's own high quality: pm-3, small-4, large-3, strat-4.
cornell_curves() {
    local i n
    local -a near=(25 50 100 200 300) cells=(32 64 128 256) half_widths=(90 60 40 30 17 10)
    i=0
    for n in 3000 12000 50000 200000 800000; do
        curve pm $((i + 1)) "$n" - photon_map "$n" "${near[i]}"
        i=$((i + 1))
    done
    for normalization in weight density; do
        i=0
        for n in 400 1600 6400 25000 100000; do
            i=$((i + 1))
            curve "small-$normalization" "$i" "$n" "$small_size" thesis_splats "$n" "$small_size" "$normalization"
        done
        i=0
        for n in 100 400 2500 10000 40000; do
            i=$((i + 1))
            curve "large-$normalization" "$i" "$n" "$large_size" thesis_splats "$n" "$large_size" "$normalization"
        done
        i=0
        for n in 1600 6400 25000 100000; do
            curve "strat-$normalization" $((i + 1)) "$n" "$small_size" \
                thesis_strata "$n" "$small_size" "$normalization" "${cells[i]}"
            i=$((i + 1))
        done
    done
    i=0
    for n in 6400 25000 100000 400000 1600000 6400000; do
        curve own $((i + 1)) "$n" "${half_widths[i]}" own_splats "$n" "${half_widths[i]}"
        i=$((i + 1))
    done
    i=0
    for n in 4 16 64 256; do
        i=$((i + 1))
        set_options path_trace "$n"
        point "path-$i" cornell path "$i" "$n" - "$cornell" "${options[@]}"
    done
}

# Stratified splatting without drift of intensity: many passes of few paths, whose photons alone are held at a time.
cornell_open_end() {
    local passes=32 each=20000 half_width=12
    ((quick)) && passes=8
    point open-1 cornell open 1 "$((passes * each))" "$half_width" "$cornell" --passes "$passes" \
        --plugin injection=photon:count="$each" --plugin stratification=grid:resolution=256 \
        --plugin visibility=shadowmap:radius="$half_width",resolution="$resolution" --plugin normalization=density
    row figures open_passes "$passes"
    row figures open_paths "$each"
}

# twice NAME OPTION...: NAME-1 and NAME-2, of different seeds.
twice() {
    local seed
    for seed in 1 2; do
        render "$1-$seed" "$cornell" --seed "$seed" "${@:2}"
    done
}

# How much two renders with the same few paths differ: noise alone.
cornell_noise() {
    set_options thesis_splats 2500 "$small_size" weight
    twice noise-small "${options[@]}"
    set_options thesis_splats 2500 "$large_size" weight
    twice noise-large "${options[@]}"
    row figures noise_small "$(noise noise-small)"
    row figures noise_large "$(noise noise-large)"
    row figures noise_paths "$(paths 2500)"
}

# Merged photons at few and at many paths in the same cells, and as many photons as the latter that were never
# merged. No growth: all splats have one size.
cornell_disparity() {
    local many kept injected equal
    many=$(paths 400000)
    set_options thesis_strata 25000 "$small_size" weight 128 1
    twice merged-few "${options[@]}"
    set_options thesis_strata 400000 "$small_size" weight 128 1
    twice merged-many "${options[@]}"
    kept=$(statistic counters photons "$work/merged-many-1.json")
    injected=$(statistic counters 'photons injected' "$work/merged-many-1.json")
    equal=$(awk -v kept="$kept" -v injected="$injected" -v paths="$many" 'BEGIN { printf "%d", kept * paths / injected }')
    twice unmerged --plugin injection=photon:count="$equal" --plugin "$(thesis_box "$small_size")" --plugin filter=gaussian \
        --plugin normalization=weight
    row figures merged_few_paths "$(paths 25000)"
    row figures merged_many_paths "$many"
    row figures merged_photons "$kept"
    row figures noise_merged_few "$(noise merged-few)"
    row figures noise_merged_many "$(noise merged-many)"
    row figures noise_unmerged "$(noise unmerged)"
}

cornell_regions() {
    local normalization
    local -a leaks=(small-weight-4 leak-large-weight small-density-4 leak-large-density own-2 leak-large-own)
    local -a ceiling=(pm-3 small-weight-4 large-weight-5 strat-weight-4 small-density-5 large-density-5 strat-density-4 own-4)
    level "$ceiling_bright" ceiling-bright ambient cornell "${ceiling[@]}"
    level "$ceiling_dim" ceiling-dim ambient cornell "${ceiling[@]}"
    for normalization in weight density; do
        set_options thesis_splats 25000 "$large_size" "$normalization"
        point "leak-large-$normalization" cornell leak 1 "$(paths 25000)" "$large_size" "$cornell" "${options[@]}"
    done
    set_options own_splats 25000 "$large_size"
    point leak-large-own cornell leak 1 "$(paths 25000)" "$large_size" "$cornell" "${options[@]}"
    level "$behind_wall" wall ambient cornell "${leaks[@]}"
    level "$behind_floor" floor ambient cornell "${leaks[@]}"
}

# data_megabytes RENDER: photons, strata and the photon map: what the thesis's table counts.
data_megabytes() {
    local purpose bytes=0
    for purpose in photons strata 'photon map'; do
        bytes="$bytes + $(statistic bytes "$purpose" "$work/$1.json")"
        bytes=${bytes% + }
    done
    calculate "($bytes) / 1e6"
}

# memory_row ID METHOD THESIS-STRUCTURE THESIS-MB RENDER
memory_row() {
    row memory "$1" "$2" "$3" "$4" "$(cell points "$5" paths)" "$(data_megabytes "$5")" "$(cell points "$5" own_mb)"
}

# Table 1. The thesis counts photons or voxels alone; psplat's last column is all that the method allocates.
table_of_memory() {
    echo 'id,method,thesis: structure,thesis: MB,psplat: paths,psplat: photons (MB),psplat: all (MB)' \
        >"$out/memory.csv"
    memory_row pm 'photon mapping' '50000 photons of 36 bytes' 1.71 pm-3
    memory_row small 'splatting; small maps' '25000 photons of 36 bytes' 0.85 small-weight-4
    memory_row large 'splatting; large maps' '2500 photons of 36 bytes' 0.08 large-weight-3
    memory_row strat 'splatting; stratified' '256^3 voxels of 40 bytes' 576 strat-weight-4
    memory_row open 'splatting; stratified; density' '256^3 voxels of 40 bytes' 576 open-1
}
