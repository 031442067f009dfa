/* place.c: the placement of batches of photons (src/placement), with what the render knows. */
#include "host/place.h"

#include "base/clock.h"
#include "base/parallel.h"
#include "placement/radius.h"
#include <psplat/math.h>

/* Splats that can light nothing in view are dropped before more is done for them: of a large scene little is in
 * view. Where few are dropped, asking takes longer than what it saves; then one batch in so many is asked. */
#define ASK_EVERY 16
#define ENOUGH_UNSEEN 0.125

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

struct placement_scene place_scene(const struct render *render)
{
    float radius = render->scene->radius, spread = render->photons.spread;
    uint64_t paths = render->photons.path_count;
    return (struct placement_scene){
        .radius = radius,
        .surface_offset = render->scene->surface_offset,
        .automatic_radius = radius_automatic(radius, spread, paths, render->pass.number),
        .automatic_gather_distance = radius_automatic_gather_distance(radius, spread, paths),
        .seed = render->settings->seed,
        .camera = &render->scene->camera,
        .interleave = render->has_splatter ? render->splatter.settings.interleave : 1,
        .gather_distance = render->gathered_light.distance,
    };
}

static bool may_light(const void *splatter, const struct splat *splat)
{
    return splatter_touches(splatter, splat);
}

static struct placement placement_of(struct render *render)
{
    const struct strategy *visibility = strategy_in(render, PS_VISIBILITY);
    const ps_visibility_vtable *table = &visibility->type->table.visibility;
    return (struct placement){
        .scene = place_scene(render),
        .settings = strategy_shared(visibility),
        .host = own_host(render),
        .follows_rays = table->depth_maps || table->visible,
        .has_maps = table->depth_maps,
        .may_light = render->unseen.asked ? may_light : NULL,
        .user = &render->splatter,
    };
}

struct batch {
    struct render *render;
    struct placement placement;
    const ps_photon *photons;
    size_t n;
    struct splat *splats;
};

static void place_chunk(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct batch *batch = user;
    struct render *render = batch->render;
    ps_ray rays[PS_PATH_CHUNK] = {{.tnear = 0.0f}};
    ps_hit hits[PS_PATH_CHUNK];
    size_t first = index * PS_PATH_CHUNK, left = batch->n - first;
    size_t n = left < PS_PATH_CHUNK ? left : PS_PATH_CHUNK;
    const ps_photon *photons = batch->photons + first;
    for (size_t i = 0; i < n; i++)
        rays[i] = ps_leave_surface(photons[i].position, photons[i].normal, photons[i].direction,
                                   render->scene->surface_offset);
    trace_intersect(render->trace, RAYS_INCOHERENT, rays, n, hits);
    uint32_t unseen = placement_place(&batch->placement, photons, hits, n, batch->splats + first);
    atomic_fetch_add(&render->unseen.in_batch, unseen);
}

void place_splats(struct render *render, const ps_photon *photons, size_t n, struct splat *splats)
{
    double start = clock_seconds();
    uint64_t chunks = (n + PS_PATH_CHUNK - 1) / PS_PATH_CHUNK;
    begin_batch(render);
    struct batch batch = {render, placement_of(render), photons, n, splats};
    parallel_for(render->settings->threads, chunks, place_chunk, &batch);
    end_batch(render, n);
    statistics_add_seconds(render->statistics, "place", clock_seconds() - start);
}
