# A module that was built with the headers of version 1.0 of the plugin interface runs in this psplat and does what it
# did: tests/plugins/interface-1.0 holds those headers as they were, and is not to be changed.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

old=$PSPLAT_SOURCE/tests/plugins/interface-1.0
for example in injection stratification visibility filter estimator normalization denoiser; do
    compile_module "$old" "$PSPLAT_SOURCE/plugins/examples/$example.c" "$PWD/old-$example.so"
    compile_module "$PSPLAT_SOURCE/include" "$PSPLAT_SOURCE/plugins/examples/$example.c" "$PWD/new-$example.so"
    for age in old new; do
        # shellcheck disable=SC2086
        run 0 -q $small -p "$example=./$age-$example.so" -o $age.exr "$cornell"
        expect_no_text err warning
    done
    last="$example, built with the headers of 1.0 and with today's"
    run 0 compare --fail 'max>0' old.exr new.exr
done

# What an older interface does not know, its modules do not have: parts of a picture (1.7).
# shellcheck disable=SC2086
{
    run 2 -q $small -p estimator=./old-estimator.so --crop 5,9,17,3 -o a.exr "$cornell"
    expect_text err "estimator bounce does not say that it can render a part of a picture"
    run 0 -q $small -p normalization=./old-normalization.so --crop 5,9,17,3 -o a.exr "$cornell"
    expect_text err "warning: --crop: normalization factor may go by other pixels"
    run 0 -q $small -p estimator=./new-estimator.so -p normalization=./new-normalization.so --crop 5,9,17,3 -o a.exr "$cornell"
    expect_empty err
}

# Hooks, radiance, half buffers and ids; and that calls out of place still fail.
compile_module "$old" "$PSPLAT_SOURCE/tests/plugins/witness.c" "$PWD/witness.so"
run 0 --size 48x27 --passes 3 -p estimator=./witness.so -p denoiser=./witness.so -o a.exr --stats a.json "$cornell"
expect_match a.json '"witness kept count": 3,?$'
compile_module "$old" "$PSPLAT_SOURCE/tests/plugins/abusive.c" "$PWD/abusive.so" '-DABUSE="init:next_photons"'
run 2 --size 48x27 -p estimator=./abusive.so -o a.exr "$cornell"
expect_text err "estimator abusive: it called next_photons where that is not there"

# A module that was built when structs were longer is taken with what this psplat knows of them.
cat >longer.c <<'END'
#include <psplat/plugin.h>

struct state {
    double factor;
};

static void weigh(const void *state, const float *r2, float *weights, size_t n)
{
    for (size_t i = 0; i < n; i++)
        weights[i] = 1.0f - r2[i] * (float)((const struct state *)state)->factor;
}

struct longer_row {
    ps_param row;
    uint64_t more[3];
};
static const struct longer_row params[] = {
    {PS_NUMBER(struct state, factor, "0.5", 0, 1, 0, "", "a factor"), {1, 2, 3}},
};
static const struct {
    ps_filter_vtable table;
    void (*more)(void);
} vtable = {{.size = sizeof vtable, .weigh = weigh}, NULL};
static const struct {
    ps_descriptor descriptor;
    uint64_t more;
} descriptor = {{
    .size = sizeof descriptor,
    .kind = PS_FILTER,
    .name = "longer",
    .version = "1.0",
    .summary = "has longer structs",
    .paper = "none: a test",
    .params = &params[0].row,
    .param_count = 1,
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
}, 7};
PS_MODULE(filter, longer, &descriptor.descriptor)
END
compile_module "$PSPLAT_SOURCE/include" longer.c "$PWD/longer.so"
run 0 plugins filter=./longer.so
expect_text out "number 0..1; default: 0.5"
# shellcheck disable=SC2086
run 0 -q $small -p filter=./longer.so:factor=0.25 -o a.exr "$cornell"
expect_picture a.exr

finish
