/* splat.c: photon splatting: every photon is carried to the surface it lights and splatted there.
 *
 * Hoet 2014, chapter 3. A photon carries power Phi along w. With a kernel K (1/m^2) that integrates
 * to 1 over the disc across the bundle, and visibility V of the bundle,
 *
 *     E(p) += Phi * K(p) * V(p) * max(0, -n.w)        irradiance, W/m^2
 *
 * The cosine belongs here since K lies across the bundle; a photon map's gather, whose kernel lies
 * in the surface, has none. The driver multiplies by albedo / pi. Placing, depth maps, bins and the
 * inner loop are the core's (src/splat), shared by whatever splats.
 *
 * A kernel blurs what is smaller than itself, so part of the light from nearby is left out of
 * splats and found by short rays (host->gather_short_range).
 */
#include <psplat/plugin.h>

struct state {
    ps_number_or_choice interleave;
    ps_number_or_choice gather_rays;
};

static ps_result splat_all(const ps_host *host)
{
    const ps_photon *photons;
    size_t n = 1;
    double progress;
    ps_result result = PS_OK;
    while (result == PS_OK && n > 0) {
        result = host->next_photons(host, &photons, &n, &progress);
        if (result == PS_OK)
            result = host->splat(host, photons, n);
        host->progress(host, progress);
    }
    return result;
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    (void)pass;
    const struct state *state = opaque;
    int automatic = state->gather_rays.choice >= 0;
    uint32_t n = state->interleave.choice >= 0 ? 0 : (uint32_t)state->interleave.number;
    ps_result result = host->begin_splats(host, n);
    if (result == PS_OK && (automatic || state->gather_rays.number > 0))
        result = host->gather_short_range(host, automatic ? 0.0 : state->gather_rays.number);
    return result == PS_OK ? splat_all(host) : result;
}

static const char *const automatic_choice[] = {"auto", NULL};

static const ps_param params[] = {
    PS_NUMBER_OR(struct state, interleave, "auto", 1, PS_MOST_INTERLEAVE,
                 PS_PARAM_EXPERT | PS_PARAM_WHOLE, automatic_choice, "pixels",
                 "n: a splat lights every n-th pixel across and down, and neighbours are averaged; "
                 "auto: by the size of the picture and the number of light paths"),
    PS_NUMBER_OR(struct state, gather_rays, "auto", 0, 65536, PS_PARAM_EXPERT, automatic_choice,
                 "rays",
                 "rays of the short-range final gather, for a pixel and those that it is averaged "
                 "with; auto: by the number of light paths; 0: none"),
};

static const ps_estimator_vtable vtable = {
    .size = sizeof vtable,
    .flags = PS_ESTIMATOR_SHARES_PLACES | PS_ESTIMATOR_CROPS | PS_ESTIMATOR_SPLATS,
    .accumulate = accumulate,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "splat",
    .version = "1.0",
    .summary = "photon splatting: bundled light rays with small shadow maps",
    .paper = "Hoet 2014, Indirect illumination using photon splatting",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, splat, &descriptor)
