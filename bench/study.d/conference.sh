# shellcheck shell=bash disable=SC2154 # variables are those of bench/study
# conference.sh: the conference room under the thesis's evening light. Sourced by bench/study.

conference_small=0.1 conference_large=0.3 # metres, in the model's scale

# Regions in pixels of 1600x900 of the camera `chairs`: the wall between the backs of the chairs, which shade it.
shade_left=817,267,100,117
shade_right=1283,267,83,200

# room ID METHOD PATHS SIZE OPTION...
room() {
    local id=$1 method=$2 n=$3 half_width=$4
    shift 4
    point "$id" room "$method" 1 "$n" "$half_width" "$conference_scene" --param mesh="$conference" "$@"
}

study_conference() {
    local room_samples=512 chairs_samples=256
    conference=$(cd "$(dirname "$conference")" && pwd)/$(basename "$conference")
    ((quick)) && room_samples=64 chairs_samples=64
    reference room "$conference_scene" "$room_samples" --param mesh="$conference"
    measure_reference room "$room_samples"
    reference chairs "$conference_scene" "$chairs_samples" --param mesh="$conference" --camera chairs
    measure_reference chairs "$chairs_samples"
    conference_methods
    conference_chairs
}

# Figure 12. Half of the paths miss the windows; the room has sixty times the surface of the Cornell box in units of a
# splat, and so needs more of them.
conference_methods() {
    set_options photon_map 400000 100
    room room-pm pm "$(paths 400000)" - "${options[@]}"
    set_options thesis_splats 400000 "$conference_small" weight
    room room-small small-weight "$(paths 400000)" "$conference_small" "${options[@]}"
    set_options thesis_splats 40000 "$conference_large" weight
    room room-large large-weight "$(paths 40000)" "$conference_large" "${options[@]}"
    set_options thesis_strata 400000 "$conference_small" weight 256
    room room-strat strat-weight "$(paths 400000)" "$conference_small" "${options[@]}"
    set_options own_splats 1600000 0.06
    room room-own own "$(paths 1600000)" 0.06 "${options[@]}"
    set_options path_trace 16
    room room-path path 16 - "${options[@]}"
}

# Figure 19: the same large splats with maps of 4x4 and of 32x32 texels. With psplat's full beams, whose maps see all
# that lies between photon and surface; the thesis's close box is measured too.
conference_chairs() {
    local texels box n
    n=$(paths 200000)
    render chairs-ambient "$conference_scene" --param mesh="$conference" --camera chairs \
        --plugin estimator=ambient:irradiance=1
    for texels in 4 32; do
        render "chairs-full-$texels" "$conference_scene" --param mesh="$conference" --camera chairs \
            --plugin injection=photon:count="$n" --plugin visibility=shadowmap:radius="$conference_large",resolution="$texels"
        box=$(thesis_box "$conference_large" 1 "$texels")
        render "chairs-close-$texels" "$conference_scene" --param mesh="$conference" --camera chairs \
            --plugin injection=photon:count="$n" --plugin "$box" --plugin normalization=weight
    done
    level "$shade_left" shade-left chairs-ambient chairs chairs-full-4 chairs-full-32 chairs-close-4 chairs-close-32
    level "$shade_right" shade-right chairs-ambient chairs chairs-full-4 chairs-full-32 chairs-close-4 chairs-close-32
}
