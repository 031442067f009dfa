/* density.c: the accumulated light as it stands, averaged over the passes.
 *
 * The kernels integrate to 1 over area, so the sum already is irradiance: it converges to the right
 * answer as the splats shrink and the paths grow in number.
 */
#include <psplat/plugin.h>

static ps_result resolve(const void *state, const ps_host *host, const ps_film_view *film,
                         float *out_r, float *out_g, float *out_b)
{
    (void)state;
    (void)host;
    float scale = film->passes ? 1.0f / (float)film->passes : 0.0f;
    for (uint64_t i = 0; i < film->pixel_count; i++) {
        out_r[i] = film->color_r[i] * scale;
        out_g[i] = film->color_g[i] * scale;
        out_b[i] = film->color_b[i] * scale;
    }
    return PS_OK;
}

static const ps_normalization_vtable vtable = {
    .size = sizeof vtable,
    .resolve = resolve,
    .flags = PS_NORMALIZATION_CROPS,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_NORMALIZATION,
    .name = "density",
    .version = "1.0",
    .summary = "density estimation: radiometric, converges to the truth",
    .paper = "Jensen 1996; Herzog et al. 2007, Global illumination using photon ray splatting",
    .vtable = &vtable,
};

PS_MODULE(normalization, density, &descriptor)
