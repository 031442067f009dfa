#include "splat/kernel.h"

#include <math.h>
#include <psplat/math.h>
#include <string.h>

uint64_t kernel_baseline(ps_tile *tile, const struct kernel_splat *splats, const uint32_t *indices,
                         size_t n, uint32_t resolution, const struct kernel_profile *profile);
#if defined(PSPLAT_KERNEL_X86)
uint64_t kernel_avx2(ps_tile *tile, const struct kernel_splat *splats, const uint32_t *indices,
                     size_t n, uint32_t resolution, const struct kernel_profile *profile);
uint64_t kernel_avx512(ps_tile *tile, const struct kernel_splat *splats, const uint32_t *indices,
                       size_t n, uint32_t resolution, const struct kernel_profile *profile);
#endif

size_t kernel_variants(struct kernel_variant variants[4])
{
    size_t count = 0;
#if defined(PSPLAT_KERNEL_X86)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw"))
        variants[count++] = (struct kernel_variant){"avx512", kernel_avx512};
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        variants[count++] = (struct kernel_variant){"avx2", kernel_avx2};
#endif
    variants[count++] = (struct kernel_variant){"baseline", kernel_baseline};
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
    return sum > 0;
}

void kernel_profile_count(struct kernel_profile *profile)
{
    for (size_t i = 0; i < KERNEL_PROFILE_SIZE; i++)
        profile->weights[i] = 1.0f;
    profile->scale = 1.0f;
    profile->counting = true;
}

struct kernel_splat kernel_prepare(const ps_splat *splat, const struct kernel_profile *profile,
                                   const float *depths)
{
    float inverse = 1.0f / splat->half_width;
    float merged = profile->counting ? 1.0f : fmaxf(splat->merged, 1.0f);
    return (struct kernel_splat){
        .centre = splat->centre,
        .u = ps_scale(splat->axis_u, inverse),
        .v = ps_scale(splat->axis_v, inverse),
        .w = splat->axis_w,
        .near_depth = splat->near_depth,
        .far_depth = splat->far_depth,
        .start_depth = splat->start_depth,
        .start_u = splat->start_slope_u * splat->half_width,
        .start_v = splat->start_slope_v * splat->half_width,
        .bias_constant = splat->bias_constant,
        .bias_slope = splat->bias_slope,
        .front = splat->two_sided ? 0.0f : INFINITY,
        .kernel_scale = profile->counting ? 1.0f : merged * profile->scale * inverse * inverse,
        .power = ps_rgb_scale(splat->power, 1.0f / merged),
        .depths = depths,
    };
}
