/* splat.c: photon splatting: every source is carried to the surface it lights and splatted there.
 *
 * Hoet 2014, chapter 3. A source carries power Phi along w. With a kernel K (1/m^2) that integrates
 * to 1 over the disc across the beam, and visibility V of the bundle,
 *
 *     E(p) += Phi * K(p) * V(p) * max(0, -n.w)        irradiance, W/m^2
 *
 * The cosine belongs here since K lies across the beam; a photon map's gather, whose kernel lies in
 * the surface, has none. The driver multiplies by albedo / pi. Placing, depth maps, bins and the
 * inner loop are the core's (src/splat), shared by whatever splats.
 */
#include <psplat/plugin.h>

#define BATCH 4096 /* splats placed at a time */

static ps_result splat_batches(const ps_host *host, const ps_source *sources, size_t n,
                               ps_splat *splats)
{
    ps_result result = PS_OK;
    for (size_t first = 0; first < n && result == PS_OK; first += BATCH) {
        size_t count = n - first < BATCH ? n - first : BATCH;
        if (host->cancelled(host))
            return PS_CANCELLED;
        result = host->place_splats(host, sources + first, count, splats);
        if (result == PS_OK)
            result = host->splat(host, splats, count);
    }
    return result;
}

static ps_result accumulate(const void *state, const ps_host *host, const ps_pass *pass)
{
    (void)state;
    (void)pass;
    ps_splat *splats = host->allocate(host, BATCH * sizeof *splats, "splats placed");
    if (!splats)
        return PS_ERROR_MEMORY;
    const ps_source *sources;
    size_t n;
    double progress;
    ps_result result;
    do {
        result = host->next_sources(host, &sources, &n, &progress);
        if (result == PS_OK)
            result = splat_batches(host, sources, n, splats);
        host->progress(host, progress);
    } while (result == PS_OK && n > 0);
    host->release(host, splats);
    return result;
}

static const ps_estimator_vtable vtable = {.size = sizeof vtable, .accumulate = accumulate};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "splat",
    .version = "1.0",
    .summary = "photon splatting: bundled light rays with small shadow maps",
    .paper = "Hoet 2014, Indirect illumination using photon splatting",
    .vtable = &vtable,
};

PS_MODULE(estimator, splat, &descriptor)
