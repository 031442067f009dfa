# What a strategy must not do is an error that names it, or is counted and left out; it never ends the program.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

# abuse WHAT KIND...: a picture with the strategies of those kinds from a module that does that.
abuse() {
    what=$1
    shift
    compile_module "$PSPLAT_SOURCE/include" "$PSPLAT_SOURCE/tests/plugins/abusive.c" "$PWD/abusive.so" "-DABUSE=\"$what\""
    words='-p estimator=splat -p denoiser=none'
    for kind; do
        words="$words -p $kind=./abusive.so"
    done
    rm -f a.exr
}

# refused TEXT: it fails with that message, and there is no picture.
refused() {
    # shellcheck disable=SC2086
    run 2 --size 48x27 $words -o a.exr "$cornell"
    expect_text err "psplat: error: $1"
    [ ! -e a.exr ] || fail "a picture in spite of the error"
}

# warned TEXT: it is said, and there is a picture of numbers.
warned() {
    # shellcheck disable=SC2086
    run 0 --size 48x27 $words -o a.exr --stats a.json "$cornell"
    expect_match err "^psplat: warning: $1"
    expect_picture a.exr
    expect_match a.json '"refused": [1-9]'
}

# As it stands, it works.
abuse '' estimator injection stratification normalization denoiser
# shellcheck disable=SC2086
run 0 --size 48x27 $words -o a.exr "$cornell"
expect_no_text err warning

# --- calls out of place ---

for service in tile pixel tile_of tile_hits next_photons path_count begin_splats splat gather_short_range for_each_tile \
    for_each_picture_tile tile_surfaces begin_points splat_points end_points; do
    abuse "init:$service" estimator
    refused "estimator abusive: it called $service where that is not there"
    run 2 check -p estimator=./abusive.so "$cornell"
    expect_text err "estimator abusive: it called $service where that is not there"
done
for service in splat gather_short_range splat_points end_points; do
    abuse $service estimator
    refused "estimator abusive: it called $service where that is not there"
done
abuse begin_twice estimator
refused "estimator abusive: it called begin_points where that is not there"
abuse no_points estimator
refused "estimator abusive: it called begin_points without points"
abuse points_left estimator # what it leaves is forgotten when its pass ends
run 0 --size 48x27 $words --passes 2 -o a.exr "$cornell"
abuse nested estimator
refused "estimator abusive: it called parallel_for where that is not there"
abuse tile estimator
refused "estimator abusive: it called tile with index 6 of 6"
abuse tile_surfaces estimator
refused "estimator abusive: it called tile_surfaces with index 6 of 6"
abuse light estimator
refused "estimator abusive: it called light with index 99 of 1"
abuse emit_from estimator
refused "estimator abusive: it called emit_from with index 99 of 1"
for service in light_of_object is_shown; do
    abuse $service estimator
    refused "estimator abusive: it called $service with index 9999 of "
done
abuse surface_points estimator
refused "estimator abusive: it called surface_points with index 9999 of "
abuse surface_triangle estimator
refused "estimator abusive: it called surface_points with index 9999 of "
abuse size estimator
refused "estimator abusive: it called light with a struct whose size is not set"

# --- reasons ---

abuse init:fail estimator
refused "estimator abusive: it does not want to"
abuse fail estimator
refused "estimator abusive: the estimator is out of sorts"
abuse 'fail and go on' estimator
refused "estimator abusive: the estimator is out of sorts"
abuse emit:fail injection
refused "injection abusive: the lamps are out"
abuse resolve:fail normalization
# shellcheck disable=SC2086
run 2 --size 48x27 $words -o a.exr "$cornell"
expect_text err "psplat: warning: normalization abusive: it is not normal; the picture is normalized by density"
expect_picture a.exr

# --- what is no number, or negative ---

numbers='values of pixels that are no numbers or negative; they are 0$'
for what in nan infinite; do
    abuse $what estimator
    warned "estimator abusive made 1 $numbers"
done
abuse negative estimator
warned "estimator abusive made 2 $numbers"
abuse rays estimator
warned 'estimator abusive made 7 rays that are no numbers; they meet nothing$'
abuse keep estimator
# shellcheck disable=SC2086
run_leaking 0 --size 48x27 $words -o a.exr --stats a.json "$cornell"
expect_text err "psplat: warning: estimator abusive kept 2 blocks of memory"
expect_match a.json '"kept blocks": 2,?$'
photons='photons that are no numbers or have negative power; they are left out$'
for what in nan direction negative infinite; do
    abuse emit:$what injection
    warned "injection abusive made 4 $photons"
done
abuse strata:nan stratification
warned "stratification abusive made [0-9]+ $photons"
for what in index count starts; do
    abuse strata:$what stratification
    refused "stratification abusive: it made strata of photons that are not there"
done
abuse resolve:nan normalization
warned "normalization abusive made [0-9]+ $numbers"
for what in nan negative; do
    abuse filter:$what denoiser
    warned "denoiser abusive made 1 $numbers"
done

finish
