/* lightcuts.c: as many virtual point lights as there are photons, of which each pixel asks a few.
 *
 * Walter et al. 2005, "Lightcuts: a scalable approach to illumination". Lights are gathered in a
 * tree (lightcuts/light_tree.h); each pixel refines its own cut through it until no cluster could
 * be off by more than a share of the light, or there are too many (lightcuts/cut.h). Cost grows far
 * slower than the number of lights.
 *
 * What clamping takes away comes by short rays, as in vpl (shared/compensation.h). Gloss that a
 * pixel sees is followed by the camera's own paths, so a pixel's point is diffuse, and needs
 * irradiance alone.
 */
#include "lightcuts/cut.h"
#include "shared/compensation.h"

#include <string.h>

struct state {
    int64_t lights;
    double error;
    int64_t most_clusters;
    ps_number_or_choice clamp;
    int64_t compensation;
};

struct work {
    struct cut_setting cut;
    struct compensation compensation;
    struct virtual_lights lights; /* owned, as what follows */
    struct light_tree tree;
    struct cut_entry *room; /* for each worker */
    uint64_t *clusters;     /* in the cuts of each tile of the picture */
};

static void light_tile(void *user, uint64_t index, uint32_t worker)
{
    const struct work *work = user;
    const ps_host *host = work->cut.host;
    ps_tile *tile = host->tile(host, (uint32_t)index);
    ps_points points;
    ps_rgb irradiance[PS_TILE_PIXELS] = {{0, 0, 0}};
    ps_collect_points(tile, &points);
    if (work->lights.count > 0)
        work->clusters[index] = cut_light_points(
            &work->cut, &points, work->room + (size_t)worker * PS_TILE_PIXELS * work->cut.most,
            irradiance);
    compensation_add(&work->compensation, index, &points, irradiance);
    for (size_t i = 0; i < points.count; i++)
        ps_add_irradiance(tile, points.lanes[i], irradiance[i]);
}

static ps_result light_tiles(struct work *work)
{
    const ps_host *host = work->cut.host;
    const ps_pass *pass = work->cut.pass;
    size_t entries = (size_t)pass->thread_count * PS_TILE_PIXELS * work->cut.most;
    uint64_t total = 0;
    work->room = host->allocate(host, entries * sizeof *work->room, "light cuts");
    work->clusters = host->allocate(host, pass->tile_count * sizeof *work->clusters, "light cuts");
    if (!work->room || !work->clusters)
        return PS_ERROR_MEMORY;
    memset(work->clusters, 0, pass->tile_count * sizeof *work->clusters);
    ps_result result = host->for_each_tile(host, light_tile, work);
    for (uint32_t i = 0; result == PS_OK && i < pass->tile_count; i++)
        total += work->clusters[i];
    host->count(host, "light cut clusters", (double)total);
    return result;
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    const struct state *state = opaque;
    float clamp = virtual_lights_clamp(host, state->clamp);
    struct work work = {
        .cut = {host, pass, &work.tree, clamp, (float)state->error, (uint32_t)state->most_clusters},
        .compensation = {{host, pass, COMPENSATION_ROULETTE, false, false},
                         (uint64_t)state->compensation,
                         clamp},
        .tree = {.host = host},
    };
    ps_result result = virtual_lights_choose(host, pass, (size_t)state->lights, &work.lights);
    if (work.lights.count < work.cut.most) /* a cut of all lights */
        work.cut.most = work.lights.count > 0 ? (uint32_t)work.lights.count : 1;
    if (result == PS_OK && work.lights.count > 0)
        result = light_tree_build(host, pass, &work.lights, &work.tree);
    if (result == PS_OK)
        result = light_tiles(&work);
    host->release(host, work.clusters);
    host->release(host, work.room);
    light_tree_release(&work.tree);
    virtual_lights_release(&work.lights);
    return result;
}

static const ps_param params[] = {
    PS_INT(
        struct state, lights, "100000", 1, 10000000, "lights",
        "photons used as point lights; more than these are drawn from, and get the power of all"),
    PS_NUMBER(struct state, error, "0.02", 0, 1, 0, "",
              "share of a pixel's luminance that the error of no cluster of lights may exceed"),
    PS_ROW(struct state, most_clusters, PS_PARAM_INT, "1000", 1, 1000000, PS_PARAM_EXPERT, NULL,
           "clusters", "clusters that a pixel is lit by at most, whatever their error"),
    VIRTUAL_LIGHTS_CLAMP(struct state),
    COMPENSATION_RAYS(struct state),
};

static const ps_estimator_vtable vtable = {
    .size = sizeof vtable,
    .flags = PS_ESTIMATOR_CROPS,
    .accumulate = accumulate,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "lightcuts",
    .version = "1.0",
    .summary = "many photons as point lights, of which each pixel asks as few as its error allows",
    .paper = "Walter et al. 2005, Lightcuts: a scalable approach to illumination",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, lightcuts, &descriptor)
