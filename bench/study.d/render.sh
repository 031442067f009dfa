# shellcheck shell=bash disable=SC2154 # variables are those of bench/study
# render.sh: renders that are made once. Sourced by bench/study.
#
# A render NAME is $work/NAME.exr, its statistics $work/NAME.json, and $work/NAME.key, written last, what they were
# made of. What is timed is made anew when the program changes; references, which take longest, are not: remove the
# work folder when path tracing itself has changed.

cornell=$here/scenes/cornell.psd
conference_scene=$parts/conference.psd

# Checksum of the program and its plugins.
program_sum() {
    local folder
    folder=$(dirname "$psplat")/../lib/psplat
    {
        cat "$psplat"
        [[ ! -d $folder ]] || find "$folder" -name '*.so' -print0 | sort -z | xargs -0 cat
    } | cksum
}
program=$(program_sum)

# render_key SCENE OPTION...
render_key() {
    echo "$program|$size|$(cksum <"$1")|${*:2}"
}

# render NAME SCENE OPTION...
render() {
    local name=$1 scene=$2 key
    shift 2
    key=$(render_key "$scene" "$@")
    [[ -f $work/$name.exr && -f $work/$name.key && $(<"$work/$name.key") == "$key" ]] || {
        rm -f "$work/$name.key"
        render_now "$name" "$scene" "$@"
        echo "$key" >"$work/$name.key"
    }
}

render_now() {
    local name=$1 scene=$2
    shift 2
    echo "rendering $name"
    "$psplat" render "$scene" --quiet --size "$size" --passes 1 --plugin estimator=splat --plugin denoiser=none "$@" -o "$work/part.exr" --stats "$work/part.json"
    mv "$work/part.exr" "$work/$name.exr"
    mv "$work/part.json" "$work/$name.json"
}

# reference NAME SCENE SAMPLES OPTION...: two independent halves, NAME-a and NAME-b.
reference() {
    local name=$1 scene=$2 samples=$3 program=any
    shift 3
    ((quick)) && samples=64
    render "$name-a" "$scene" --seed 7 --plugin estimator=pathtrace:samples="$samples" "$@"
    render "$name-b" "$scene" --seed 8 --plugin estimator=pathtrace:samples="$samples" "$@"
}

# paths N: so many light paths, or fewer in a quick run.
paths() {
    local n=$1
    if ((quick)); then
        n=$((n / 32 > 50 ? n / 32 : 50))
    fi
    echo "$n"
}
