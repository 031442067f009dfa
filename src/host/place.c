/* place.c: carries photons to the surfaces that they light, and puts the footprints of splats there. */
#include "host/place.h"

#include "base/clock.h"
#include "base/parallel.h"
#include "splat/boundary.h"
#include "splat/extent.h"
#include <math.h>
#include <psplat/math.h>
#include <string.h>

/* Splats that can light nothing in view are dropped before more is done for them: of a large scene little is in
 * view. Where few are dropped, asking takes longer than what it saves; then one batch in so many is asked. */
#define ASK_EVERY 16
#define ENOUGH_UNSEEN 0.125

/* What lies past the first hit counts, since part of a bundle may pass beside it. */
static void drop_unseen(struct render *render, struct splat *splats, size_t n)
{
    uint64_t unseen = 0;
    for (size_t i = 0; i < n; i++) {
        struct splat open = splats[i];
        open.bundle.far_depth = INFINITY;
        if (splatter_touches(&render->splatter, &open))
            continue;
        splats[i].bundle.radius = 0.0f;
        unseen++;
    }
    atomic_fetch_add(&render->unseen.in_batch, unseen);
}

void place_begin(struct render *render)
{
    render->unseen.many = false;
    render->unseen.batches = 0;
}

static void begin_batch(struct render *render)
{
    struct unseen *unseen = &render->unseen;
    unseen->asked = render->splatting && (unseen->many || unseen->batches % ASK_EVERY == 0);
    unseen->batches++;
    atomic_store(&unseen->in_batch, 0);
}

static void end_batch(struct render *render, size_t n)
{
    struct unseen *unseen = &render->unseen;
    if (unseen->asked)
        unseen->many = (double)atomic_load(&unseen->in_batch) > ENOUGH_UNSEEN * (double)n;
}

struct footprint_scene place_scene(const struct render *render)
{
    float radius = render->scene->radius, spread = render->photons.spread;
    uint64_t paths = render->photons.path_count;
    return (struct footprint_scene){
        .radius = radius,
        .surface_offset = render->scene->surface_offset,
        .automatic_size = footprint_automatic_size(radius, spread, paths, render->pass.number),
        .automatic_near = footprint_automatic_near(radius, spread, paths),
        .seed = render->settings->seed,
        .camera = &render->scene->camera,
        .interleave = render->has_splatter ? render->splatter.settings.interleave : 1,
        .gather_distance = render->gathered_light.distance,
    };
}

/* What places up to PS_PATH_CHUNK boxes. */
struct placing {
    struct render *render;
    struct footprint_scene scene;
    const struct footprint_params *settings;
    const ps_photon *photons;
    size_t n;
    ps_hit *hits;
    float *half_widths; /* 0: no box */
};

static void place(const struct placing *placing, struct splat *splats)
{
    footprint_place(&placing->scene, placing->settings, placing->photons, placing->hits,
                    placing->half_widths, placing->n, splats);
}

/* The widest that bundles may be shows whether they are seen at all. */
static void drop_unseen_full(const struct placing *placing, struct splat *splats)
{
    ps_hit stand_ins[PS_PATH_CHUNK];
    memcpy(stand_ins, placing->hits, placing->n * sizeof *stand_ins);
    for (size_t i = 0; i < placing->n; i++)
        if (!(placing->hits[i].distance < INFINITY))
            footprint_stand_in(&placing->photons[i], placing->half_widths[i], &stand_ins[i]);
    footprint_place(&placing->scene, placing->settings, placing->photons, stand_ins,
                    placing->half_widths, placing->n, splats);
    drop_unseen(placing->render, splats, placing->n);
    for (size_t i = 0; i < placing->n; i++)
        placing->half_widths[i] = splats[i].bundle.radius;
}

/* Bundles that start at their photons. */
static void place_full(const struct placing *placing, struct splat *splats)
{
    const ps_host *host = own_host(placing->render);
    for (size_t i = 0; i < placing->n; i++)
        placing->half_widths[i] =
            footprint_widest(&placing->scene, placing->settings, &placing->photons[i]);
    if (placing->render->unseen.asked)
        drop_unseen_full(placing, splats);
    extent_find(host, &placing->scene, placing->settings, placing->photons, placing->n,
                placing->hits, placing->half_widths);
    place(placing, splats);
    if (placing->settings->boundary_correction)
        boundary_find(host, placing->scene.surface_offset, placing->photons, placing->n, splats);
}

static void place_others(const struct placing *placing, struct splat *splats)
{
    for (size_t i = 0; i < placing->n; i++)
        placing->half_widths[i] = footprint_half_width(
            &placing->scene, placing->settings, &placing->photons[i], placing->hits[i].distance);
    place(placing, splats);
    if (placing->render->unseen.asked)
        drop_unseen(placing->render, splats, placing->n);
}

/* At most PS_PATH_CHUNK. Uses up the hits. */
static void place_some(struct render *render, const ps_photon *photons, ps_hit *hits, size_t n,
                       struct splat *splats)
{
    float half_widths[PS_PATH_CHUNK];
    const struct strategy *visibility = strategy_in(render, PS_VISIBILITY);
    const ps_visibility_vtable *table = &visibility->type->table.visibility;
    const struct footprint_params *settings = strategy_shared(visibility);
    const struct placing placing = {
        render, place_scene(render), settings, photons, n, hits, half_widths,
    };
    if (settings->step_back.choice == STEP_BACK_FULL)
        place_full(&placing, splats);
    else
        place_others(&placing, splats);
    if (table->depth_maps || table->visible)
        footprint_open(settings, splats, n);
    if (table->depth_maps)
        footprint_set_bias(settings, splats, n);
}

struct placement {
    struct render *render;
    const ps_photon *photons;
    size_t n;
    struct splat *splats;
};

static void place_chunk(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct placement *placement = user;
    struct render *render = placement->render;
    ps_ray rays[PS_PATH_CHUNK] = {{.tnear = 0.0f}};
    ps_hit hits[PS_PATH_CHUNK];
    size_t first = index * PS_PATH_CHUNK, left = placement->n - first;
    size_t n = left < PS_PATH_CHUNK ? left : PS_PATH_CHUNK;
    const ps_photon *photons = placement->photons + first;
    for (size_t i = 0; i < n; i++)
        rays[i] = ps_leave_surface(photons[i].position, photons[i].normal, photons[i].direction,
                                   render->scene->surface_offset);
    trace_intersect(render->trace, RAYS_INCOHERENT, rays, n, hits);
    place_some(render, photons, hits, n, placement->splats + first);
}

void place_splats(struct render *render, const ps_photon *photons, size_t n, struct splat *splats)
{
    struct placement placement = {render, photons, n, splats};
    double start = clock_seconds();
    uint64_t chunks = (n + PS_PATH_CHUNK - 1) / PS_PATH_CHUNK;
    begin_batch(render);
    parallel_for(render->settings->threads, chunks, place_chunk, &placement);
    end_batch(render, n);
    statistics_add_seconds(render->statistics, "place", clock_seconds() - start);
}
