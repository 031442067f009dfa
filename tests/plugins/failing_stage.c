/* failing_stage.c: a denoiser, a normalization, an estimator, a bloom and a tone map that fail, or
 * wait to be cancelled, after they have written into their planes. RESULT is what they return; the
 * estimator does so in its third pass. A DEAF one waits for ever.
 */
#include <psplat/plugin.h>

#ifndef RESULT
#define RESULT PS_ERROR_INVALID
#endif
#ifndef DEAF
#define DEAF 0
#endif

static void spoil(float *plane, size_t n)
{
    for (size_t i = 0; i < n; i++)
        plane[i] = 1e6f;
}

static ps_result end(const ps_host *host)
{
    if (RESULT == PS_CANCELLED)
        host->log(host, PS_LOG_INFO, "waiting");
    while (RESULT == PS_CANCELLED && (DEAF || !host->cancelled(host)))
        continue;
    return RESULT;
}

static ps_result filter(const void *state, const ps_host *host, const ps_image_view *image)
{
    (void)state;
    spoil(image->r, (size_t)image->width * image->height);
    return end(host);
}

static ps_result resolve(const void *state, const ps_host *host, const ps_film_view *film,
                         float *out_r, float *out_g, float *out_b)
{
    (void)state;
    spoil(out_r, film->pixel_count);
    spoil(out_g, film->pixel_count);
    spoil(out_b, film->pixel_count);
    return end(host);
}

static ps_result accumulate(void *state, const ps_host *host, const ps_pass *pass)
{
    (void)state;
    for (uint32_t i = 0; i < pass->tile_count; i++)
        spoil(host->tile(host, i)->irradiance_r, PS_TILE_PIXELS);
    if (pass->number < 2)
        for (uint32_t i = 0; i < pass->tile_count; i++)
            for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
                host->tile(host, i)->irradiance_r[lane] = 1.0f;
    return pass->number < 2 ? PS_OK : RESULT;
}

static ps_result show(const void *state, const ps_host *host, const ps_display_view *picture)
{
    (void)state;
    spoil(picture->r, (size_t)picture->width * picture->height);
    return end(host);
}

static const ps_bloom_vtable bloom = {.size = sizeof bloom, .spread = show};
static const ps_tonemap_vtable tonemap = {.size = sizeof tonemap, .map = show};
static const ps_denoiser_vtable denoiser = {.size = sizeof denoiser, .filter = filter};
static const ps_normalization_vtable normalization = {.size = sizeof normalization,
                                                      .resolve = resolve};
static const ps_estimator_vtable estimator = {.size = sizeof estimator, .accumulate = accumulate};

#define DESCRIPTOR(KIND, TABLE)                                                                    \
    {                                                                                              \
        .size = sizeof(ps_descriptor), .kind = KIND, .name = "failing", .version = "1.0",          \
        .summary = "fails", .paper = "none: a test", .vtable = &TABLE                              \
    }

static const ps_descriptor descriptors[] = {
    DESCRIPTOR(PS_DENOISER, denoiser), DESCRIPTOR(PS_NORMALIZATION, normalization),
    DESCRIPTOR(PS_ESTIMATOR, estimator), DESCRIPTOR(PS_BLOOM, bloom),
    DESCRIPTOR(PS_TONEMAP, tonemap)};
static const ps_descriptor *const list[] = {&descriptors[0], &descriptors[1], &descriptors[2],
                                            &descriptors[3], &descriptors[4]};

extern const ps_module psplat_module_v1;
const ps_module psplat_module_v1 = {
    .magic = PS_MODULE_MAGIC,
    .abi_major = PS_ABI_MAJOR,
    .abi_minor = PS_ABI_MINOR,
    .size = sizeof(ps_module),
    .fingerprint = PS_LAYOUT_FINGERPRINT,
    .descriptor_count = 5,
    .descriptors = list,
};
