/* photons.c: the services for photons: they are handed out, placed and splatted in batches. */
#include "host/photons.h"

#include "base/clock.h"
#include "base/parallel.h"
#include "host/host.h"
#include "host/splats.h"
#include "placement/radius.h"
#include "short_range/short_range_gather.h"
#include <psplat/math.h>

/* --- placing
 * ---------------------------------------------------------------------------------------- */

/* Splats that can light nothing in view are dropped before more is done for them: of a large scene
 * little is in view. Where few are dropped, asking takes longer than what it saves; then one batch
 * in so many is asked. */
#define ASK_EVERY 16
#define ENOUGH_UNSEEN 0.125

static void begin_batch(struct unseen *unseen)
{
    unseen->asked = unseen->many || unseen->batches % ASK_EVERY == 0;
    unseen->batches++;
    atomic_store(&unseen->in_batch, 0);
}

static void end_batch(struct unseen *unseen, size_t n)
{
    if (unseen->asked)
        unseen->many = (double)atomic_load(&unseen->in_batch) > ENOUGH_UNSEEN * (double)n;
}

/* Light paths that land where the picture may see it. */
static uint64_t near_paths(const struct render *render)
{
    return (uint64_t)((double)render->photons.path_count * render->photons.near_share + 0.5);
}

struct placement_scene place_scene(const struct render *render)
{
    float radius = render->scene->radius, spread = render->photons.spread;
    float seen = render->importance.radius > 0.0f ? render->importance.radius : radius;
    uint64_t paths = near_paths(render);
    return (struct placement_scene){
        .radius = radius,
        .surface_offset = render->scene->surface_offset,
        .automatic_radius = radius_automatic(seen, spread, paths, render->pass.number),
        .automatic_gather_distance = radius_automatic_gather_distance(seen, spread, paths),
        .seed = render->settings->seed,
        .camera = &render->scene->camera,
    };
}

static bool may_light(const void *splatter, const struct splat *splat)
{
    return splatter_touches(splatter, splat);
}

/* `onto`: what will be lit; NULL: nothing is known of it. */
static struct placement placement_of(struct render *render, const struct splatter *onto)
{
    const struct strategy *visibility = strategy_in(render, PS_VISIBILITY);
    const ps_visibility_vtable *table = &visibility->type->table.visibility;
    return (struct placement){
        .settings = strategy_shared(visibility),
        .host = own_host(render),
        .follows_rays = table->depth_maps || table->visible,
        .has_maps = table->depth_maps,
        .may_light = onto && onto->unseen.asked ? may_light : NULL,
        .user = onto,
    };
}

struct batch {
    struct render *render;
    struct placement placement;
    const ps_photon *photons;
    size_t n;
    struct splat *splats;
    struct unseen *unseen;
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
    trace_intersect(render->trace, RAYS_INCOHERENT, rays, NULL, n, hits);
    uint32_t unseen = placement_place(&batch->placement, photons, hits, n, batch->splats + first);
    if (batch->unseen)
        atomic_fetch_add(&batch->unseen->in_batch, unseen);
}

/* The splats of n photons, for what `onto` lights; NULL: nothing is known of it. `scene`: all but
 * the caustics. */
static void place(struct render *render, struct splatter *onto, struct placement_scene scene,
                  const ps_photon *photons, size_t n, struct splat *splats)
{
    double start = clock_seconds();
    const struct photon_stream *stream = &render->photons;
    const struct caustics caustics = {
        .landings = stream->caustics,
        .count = stream->caustic_count,
        .scale = caustics_scale(stream->photons_per_caustic, render->pass.number),
    };
    scene.caustics = &caustics;
    if (onto)
        begin_batch(&onto->unseen);
    struct batch batch = {render, placement_of(render, onto), photons, n,
                          splats, onto ? &onto->unseen : NULL};
    batch.placement.scene = scene;
    parallel_for(render->settings->workers, (n + PS_PATH_CHUNK - 1) / PS_PATH_CHUNK, place_chunk,
                 &batch);
    if (onto)
        end_batch(&onto->unseen, n);
    statistics_add_seconds(render->statistics, "place", clock_seconds() - start);
}

void photons_place(struct render *render, const ps_photon *photons, size_t n, struct splat *splats)
{
    struct placement_scene scene = place_scene(render);
    scene.interleave = render->has_splatter ? render->splatter.lit.interleave : 1;
    scene.gather_distance = render->gathered_light.distance;
    place(render, render->splatting ? &render->splatter : NULL, scene, photons, n, splats);
}

/* For points, whose light is averaged before it is seen: no pixel's size limits the radius, and no
 * light from nearby is left to gather rays. */
static void place_for_points(struct render *render, const ps_photon *photons, size_t n,
                             struct splat *splats)
{
    place(render, &render->points, place_scene(render), photons, n, splats);
}

/* --- services
 * --------------------------------------------------------------------------------------- */

static ps_result host_begin_splats(const ps_host *host, uint32_t n)
{
    struct render *render = render_of(host);
    struct error error;
    if (!host_in_place(host, render->estimating, "begin_splats"))
        return PS_ERROR_INVALID;
    return render_pass_on(render, splats_begin(render, n, &error), &error);
}

typedef void (*placer)(struct render *render, const ps_photon *photons, size_t n,
                       struct splat *splats);

static ps_result splat_in_parts(struct render *render, struct splatter *onto, placer place_part,
                                const ps_photon *photons, size_t n)
{
    struct error error;
    ps_result result = PS_OK;
    for (size_t first = 0; first < n && result == PS_OK; first += SPLATS_PLACED) {
        size_t count = n - first < SPLATS_PLACED ? n - first : SPLATS_PLACED;
        if (host_is_cancelled(render))
            return PS_CANCELLED;
        place_part(render, photons + first, count, render->placed);
        result = splatter_add(onto, render->placed, count, &error);
    }
    statistics_set_bytes(render->statistics, "splats", (double)splatter_bytes(onto));
    return render_pass_on(render, result, &error);
}

static ps_result host_splat(const ps_host *host, const ps_photon *photons, size_t n)
{
    struct render *render = render_of(host);
    if (!host_in_place(host, render->estimating && render->splatting, "splat"))
        return PS_ERROR_INVALID;
    return splat_in_parts(render, &render->splatter, photons_place, photons, n);
}

static ps_result host_begin_points(const ps_host *host, const ps_vec3 *positions,
                                   const ps_vec3 *normals, size_t n)
{
    struct render *render = render_of(host);
    struct error error;
    if (!host_in_place(host, render->estimating && !render->has_points, "begin_points"))
        return PS_ERROR_INVALID;
    if (n == 0)
        return host->fail(host, PS_ERROR_INVALID, "it called begin_points without points");
    return render_pass_on(render, splats_begin_points(render, positions, normals, n, &error),
                          &error);
}

static ps_result host_splat_points(const ps_host *host, const ps_photon *photons, size_t n)
{
    struct render *render = render_of(host);
    if (!host_in_place(host, render->estimating && render->has_points, "splat_points"))
        return PS_ERROR_INVALID;
    return splat_in_parts(render, &render->points, place_for_points, photons, n);
}

static ps_result host_end_points(const ps_host *host, ps_rgb *irradiance)
{
    struct render *render = render_of(host);
    if (!host_in_place(host, render->estimating && render->has_points, "end_points"))
        return PS_ERROR_INVALID;
    splats_end_points(render, irradiance);
    return PS_OK;
}

static ps_result host_path_count(const ps_host *host, uint64_t *paths)
{
    struct render *render = render_of(host);
    struct error error;
    *paths = 0;
    if (!host_in_place(host, render->estimating, "path_count"))
        return PS_ERROR_INVALID;
    ps_result result = photon_stream_prepare(&render->photons, &error);
    *paths = render->photons.path_count;
    return render_pass_on(render, result, &error);
}

static ps_result host_next_photons(const ps_host *host, const ps_photon **photons, size_t *n,
                                   double *progress)
{
    struct render *render = render_of(host);
    struct error error;
    *n = 0;
    *progress = 0.0;
    if (!host_in_place(host, render->estimating, "next_photons"))
        return PS_ERROR_INVALID;
    if (host_is_cancelled(render))
        return PS_CANCELLED;
    ps_result result = photon_stream_next(&render->photons, photons, n, &error);
    *progress = photon_stream_progress(&render->photons);
    return render_pass_on(render, result, &error);
}

static float gather_distance(const struct render *render)
{
    const struct footprint_params *settings = strategy_shared(strategy_in(render, PS_VISIBILITY));
    struct placement_scene scene = place_scene(render);
    return radius_gather_distance(&scene, settings, render->photons.path_count);
}

static ps_result host_gather_short_range(const ps_host *host, double rays)
{
    struct render *render = render_of(host);
    struct gathered_light *near = &render->gathered_light;
    struct error error;
    if (!host_in_place(host, render->estimating && render->splatting, "gather_short_range"))
        return PS_ERROR_INVALID;
    float distance = gather_distance(render);
    if (!(distance > 0.0f))
        return PS_OK;
    double start = clock_seconds();
    statistics_set_bytes(render->statistics, "short-range light",
                         (double)gathered_light_bytes(&render->gbuffer));
    ps_result result =
        gathered_light_begin(near, &render->gbuffer, distance, render->gather_interleave,
                             render->settings->workers, &error);
    if (result != PS_OK)
        return render_pass_on(render, result, &error);
    result =
        short_range_gather(own_host(render), &render->pass, near,
                           rays > 0.0 ? rays : gathered_light_rays(render->photons.path_count));
    statistics_add_seconds(render->statistics, "gather", clock_seconds() - start);
    return result;
}

void host_add_photons(ps_host *host)
{
    host->path_count = host_path_count;
    host->next_photons = host_next_photons;
    host->begin_splats = host_begin_splats;
    host->splat = host_splat;
    host->gather_short_range = host_gather_short_range;
    host->begin_points = host_begin_points;
    host->splat_points = host_splat_points;
    host->end_points = host_end_points;
}
