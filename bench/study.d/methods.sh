# shellcheck shell=bash disable=SC2154 # variables are those of bench/study
# methods.sh: the thesis's methods and psplat's own as options. Sourced by bench/study.
#
# What the thesis does not state is chosen here. Size: 25,000 splats of a half-width of 60 mm overlap in the Cornell
# box within the range of its Figure 18; its large maps are three times as large (Figure 17). Its box begins a fixed
# distance before the hit and compares depths with a fixed tolerance: one size, and one texel, by which most of the
# surfaces that a box meets stay inside of it. Merged photons may grow to the large size (section 4.3).

small_size=60 large_size=180 # Cornell box, mm
resolution=8

# thesis_box SIZE [GROW [RESOLUTION]]: the close box of a fixed depth.
thesis_box() {
    local texels=${3:-$resolution}
    echo "visibility=shadowmap:radius=$1,step_back=$1,depth=$1,bias=$(calculate "2 * $1 / $texels"),bandwidth_scale=0,max_merge_scale=${2:-1},resolution=$texels"
}

# Each prints one option a line; set_options reads them into the array `options`.
photon_map() { # PATHS NEIGHBOURS
    printf -- '--plugin\n%s\n' "injection=photon:count=$(paths "$1")" "estimator=photonmap:neighbours=$2"
}

thesis_splats() { # PATHS SIZE NORMALIZATION [GROW]
    printf -- '--plugin\n%s\n' "injection=photon:count=$(paths "$1")" "$(thesis_box "$2" "${4:-1}")" filter=gaussian \
        "normalization=$3"
}

thesis_strata() { # PATHS SIZE NORMALIZATION CELLS [GROW]
    thesis_splats "$1" "$2" "$3" "${5:-3}"
    printf -- '--plugin\n%s\n' "stratification=grid:resolution=$4,threshold=2,levels=1,normal_angle=180"
}

own_splats() { # PATHS SIZE
    printf -- '--plugin\n%s\n' "injection=photon:count=$(paths "$1")" \
        "visibility=shadowmap:radius=$2,resolution=$resolution" normalization=density
}

path_trace() { # SAMPLES
    printf -- '--plugin\n%s\n' "estimator=pathtrace:samples=$1"
}

# set_options METHOD ARGUMENT...
set_options() {
    mapfile -t options < <("$@")
}
