/* witness.c: an estimator and a denoiser that say what they are given: hooks, radiance, half
 * buffers and ids. */
#include <psplat/plugin.h>

/* Lasts through the render. */
struct state {
    uint32_t begun, accumulated, ended_passes;
};

static ps_result begin(void *opaque, const ps_host *host, const ps_pass *pass)
{
    struct state *state = opaque;
    state->begun++;
    host->count(host, "witness begins", 1);
    host->count(host, "witness passes announced", pass->passes);
    host->count(host, "witness tiles", pass->tile_count);
    host->count(host, "witness pixels", (double)pass->width * pass->height);
    return host->tile(host, 0) ? PS_OK : PS_ERROR_INVALID;
}

/* Irradiance 0 and radiance 0.25 + 0.5 in odd passes, on surfaces. */
static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    struct state *state = opaque;
    uint64_t paths;
    state->accumulated++;
    for (uint32_t i = 0; i < pass->tile_count; i++) {
        ps_tile *tile = host->tile(host, i);
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            tile->radiance_r[lane] += pass->number % 2 ? 0.75f : 0.25f;
            tile->radiance_b[lane] += 1.0f;
            tile->weight[lane] = 1.0f;
        }
    }
    ps_result result = host->path_count(host, &paths);
    host->count(host, "witness paths", (double)paths);
    return result;
}

static ps_result end_pass(void *opaque, const ps_host *host, const ps_pass *pass)
{
    struct state *state = opaque;
    state->ended_passes++;
    host->count(host, "witness passes", 1);
    return host->tile(host, 0)->radiance_b[0] == 1.0f && state->ended_passes == pass->number + 1
               ? PS_OK
               : PS_ERROR_INVALID;
}

static void end(void *opaque, const ps_host *host)
{
    struct state *state = opaque;
    host->count(host, "witness ends", 1);
    if (state->begun == 1 && state->accumulated == state->ended_passes)
        host->count(host, "witness kept count", state->accumulated);
}

static int is_near(float a, float b)
{
    return fabsf(a - b) < 1e-5f;
}

static float share_of(const ps_image_view *image)
{
#if PS_ABI_MINOR >= 4
    return image->odd_share;
#else
    return (float)(image->passes / 2) / (float)image->passes;
#endif
}

/* The passes' radiance, all of them together, the even and the odd ones. A pixel at an edge sees a
 * surface in some. */
static int is_whole(const ps_image_view *image, size_t i)
{
    uint32_t odd = image->passes / 2, even = image->passes - odd;
    float mean = (0.25f * (float)even + 0.75f * (float)odd) / (float)image->passes;
    if (image->coverage[i] < (float)image->passes)
        return 1;
    return is_near(image->r[i], mean) && is_near(image->b[i], 1) && is_near(image->g[i], 0) &&
           (!image->even_r ||
            (is_near(image->even_r[i], 0.25f) && is_near(image->odd_r[i], 0.75f) &&
             is_near(image->even_b[i], 1) && is_near(image->odd_g[i], 0) &&
             is_near(share_of(image), (float)odd / (float)image->passes)));
}

static ps_result filter(const void *state, const ps_host *host, const ps_image_view *image)
{
    (void)state;
    host->count(host, "witness image passes", image->passes);
    host->count(host, "witness halves", image->even_r != NULL && image->odd_b != NULL);
    for (size_t i = 0; i < (size_t)image->width * image->height; i++) {
        int surface = image->coverage[i] > 0.0f;
        if ((image->object[i] != PS_NO_OBJECT) != surface ||
            (image->material[i] != PS_NO_OBJECT) != surface)
            return host->fail(host, PS_ERROR_INVALID, "ids are not where surfaces are");
        if (image->weight[i] != image->coverage[i])
            return host->fail(host, PS_ERROR_INVALID, "weight is not one a pass");
        if (!is_whole(image, i))
            return host->fail(host, PS_ERROR_INVALID, "the passes' light is not what was added");
    }
    return PS_OK;
}

static const ps_estimator_vtable estimator = {
    .size = sizeof estimator,
    .flags = PS_ESTIMATOR_RADIANCE,
    .accumulate = accumulate,
    .begin = begin,
    .end_pass = end_pass,
    .end = end,
};
static const ps_denoiser_vtable denoiser = {
    .size = sizeof denoiser,
    .flags = PS_DENOISER_IDS | PS_DENOISER_HALVES,
    .filter = filter,
};

static const ps_descriptor descriptors[] = {
    {
        .size = sizeof(ps_descriptor),
        .kind = PS_ESTIMATOR,
        .name = "witness",
        .version = "1.0",
        .summary = "counts its calls",
        .paper = "none: a test",
        .state_size = sizeof(struct state),
        .vtable = &estimator,
    },
    {
        .size = sizeof(ps_descriptor),
        .kind = PS_DENOISER,
        .name = "witness",
        .version = "1.0",
        .summary = "shows what it is given",
        .paper = "none: a test",
        .vtable = &denoiser,
    },
};
static const ps_descriptor *const list[] = {&descriptors[0], &descriptors[1]};

extern PS_EXPORT const ps_module psplat_module_v1;
PS_EXPORT const ps_module psplat_module_v1 = {
    .magic = PS_MODULE_MAGIC,
    .abi_major = PS_ABI_MAJOR,
    .abi_minor = PS_ABI_MINOR,
    .fingerprint = PS_LAYOUT_FINGERPRINT,
    .size = sizeof(ps_module),
    .descriptor_count = 2,
    .descriptors = list,
};
