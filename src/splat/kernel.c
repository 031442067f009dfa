#include "splat/kernel.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define KERNEL_DECLARE(name)                                                                       \
    struct kernel_count kernel_accumulate_##name(                                                  \
        struct interleaved_tile *tile, const struct kernel_splat *splats, const uint32_t *indices, \
        size_t n, uint32_t resolution, const struct kernel_profile *profile);                      \
    uint32_t kernel_weigh_##name(                                                                  \
        const struct interleaved_tile *tile, const struct kernel_splat *splat,                     \
        const struct kernel_profile *profile, struct kernel_weighed *weighed);                     \
    uint32_t kernel_touch_##name(const struct bounds *bounds, const struct kernel_splat *splat);   \
    static const struct kernel_variant name = {#name, kernel_accumulate_##name,                    \
                                               kernel_weigh_##name, kernel_touch_##name};

KERNEL_DECLARE(baseline)
#if defined(PSPLAT_KERNEL_X86)
KERNEL_DECLARE(avx2)
KERNEL_DECLARE(avx512)
#endif

size_t kernel_variants(struct kernel_variant variants[4])
{
    size_t count = 0;
#if defined(PSPLAT_KERNEL_X86)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw"))
        variants[count++] = avx512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        variants[count++] = avx2;
#endif
    variants[count++] = baseline;
    return count;
}

bool kernel_choose(const char *name, struct kernel_variant *variant)
{
    struct kernel_variant variants[4];
    size_t count = kernel_variants(variants);
    for (size_t i = 0; i < count; i++)
        if (!name || strcmp(variants[i].name, name) == 0) {
            *variant = variants[i];
            return true;
        }
    return false;
}

float kernel_profile_radius2(size_t i)
{
    return ((float)i + 0.5f) / (float)KERNEL_PROFILE_SIZE;
}

/* The part of the kernel beyond a straight border at `distance` from its middle: of the ring of
 * radius r, acos(distance / r) / pi. */
static double part_beyond(const struct kernel_profile *profile, double sum, double distance)
{
    double part = 0;
    for (size_t i = 0; i < KERNEL_PROFILE_SIZE; i++) {
        double radius = sqrt((double)kernel_profile_radius2(i));
        double share = radius > distance ? acos(distance / radius) / 3.14159265358979323846 : 0;
        part += share * (double)profile->weights[i];
    }
    return part / sum;
}

int kernel_profile_normalize(struct kernel_profile *profile)
{
    /* The integral over the unit disc is pi times the mean over r^2 in [0, 1). */
    double sum = 0;
    profile->counting = false;
    for (size_t i = 0; i < KERNEL_PROFILE_SIZE; i++) {
        if (!(profile->weights[i] >= 0.0f && profile->weights[i] < INFINITY))
            return 0;
        sum += profile->weights[i];
    }
    profile->scale = sum > 0 ? (float)(KERNEL_PROFILE_SIZE / (3.14159265358979323846 * sum)) : 0;
    if (!(sum > 0))
        return 0;
    for (size_t i = 0; i < KERNEL_BOUNDARY_SIZE; i++)
        profile->beyond[i] =
            (float)part_beyond(profile, sum, (double)i / (KERNEL_BOUNDARY_SIZE - 1));
    return 1;
}

void kernel_profile_count(struct kernel_profile *profile)
{
    for (size_t i = 0; i < KERNEL_PROFILE_SIZE; i++)
        profile->weights[i] = 1.0f;
    profile->scale = 1.0f;
    profile->counting = true;
}

static float boundaries_likeness(const struct splat *splat)
{
    const ps_boundary *boundaries = splat->bundle.boundaries;
    if (splat->bundle.boundary_count < 2)
        return 0.0f;
    float cosine = boundaries[0].normal_u * boundaries[1].normal_u +
                   boundaries[0].normal_v * boundaries[1].normal_v;
    return 2.0f / PS_PI * asinf(ps_max(ps_min(cosine, 1.0f), -1.0f));
}

/* 1 / 0 would make NaN of what is not lit. */
#define LEAST_WIDTH 1e-3f

/* One width for all pixels, but for full bundles that follow the distance. Pixels that would take
 * more than the box holds all take part, with the weight of a wider disc. */
static struct bandwidth prepare_width(const struct splat *splat)
{
    float inverse = 1.0f / splat->bundle.radius;
    float narrowest = ps_max(splat->narrowest * inverse, LEAST_WIDTH);
    if (!(splat->bandwidth_scale > 0.0f))
        return (struct bandwidth){.narrowest = 1.0f, .widest = 1.0f};
    return (struct bandwidth){
        .by_distance = splat->bandwidth_scale * inverse,
        .spread = splat->bandwidth_scale * splat->bundle.radius,
        .tilt_u = splat->bandwidth_scale * splat->bundle.start_slope_u,
        .tilt_v = splat->bandwidth_scale * splat->bundle.start_slope_v,
        .narrowest = narrowest,
        .widest = ps_max(splat->widest * inverse, narrowest),
    };
}

struct kernel_splat kernel_prepare(const struct splat *splat, const struct kernel_profile *profile,
                                   const float *depths)
{
    assert(splat->bundle.boundary_count <= PS_MOST_BOUNDARIES);
    assert(splat->bundle.radius > 0.0f && isfinite(splat->bundle.radius));
    float inverse = 1.0f / splat->bundle.radius;
    float merged = profile->counting ? 1.0f : ps_max(splat->merged, 1.0f);
    return (struct kernel_splat){
        .centre = splat->bundle.centre,
        .u = ps_scale(splat->bundle.axis_u, inverse),
        .v = ps_scale(splat->bundle.axis_v, inverse),
        .w = splat->bundle.axis_w,
        .near_depth = splat->near_depth,
        .far_depth = splat->bundle.far_depth,
        .start_u = splat->bundle.start_slope_u * splat->bundle.radius,
        .start_v = splat->bundle.start_slope_v * splat->bundle.radius,
        .photon_depth =
            splat->bandwidth_scale > 0.0f ? splat->photon_depth : splat->bundle.start_depth,
        .clearance = splat->bandwidth_scale > 0.0f
                         ? ps_max(splat->bundle.start_depth - splat->photon_depth, 0.0f)
                         : 0.0f,
        .near = gather_share_until(splat->bandwidth_scale > 0.0f ? splat->blend_distance : 0.0f),
        .width = prepare_width(splat),
        .bias_constant = splat->bias_constant,
        .bias_slope = splat->bias_slope,
        .by_width = profile->counting ? 0.0f : 1.0f,
        .kernel_scale = profile->counting ? 1.0f : merged * profile->scale * inverse * inverse,
        .power = ps_rgb_scale(splat->power, 1.0f / merged),
        .depths = depths,
        .boundary_count = profile->counting ? 0 : splat->bundle.boundary_count,
        .boundaries = {splat->bundle.boundaries[0], splat->bundle.boundaries[1]},
        .boundaries_likeness = boundaries_likeness(splat),
    };
}
