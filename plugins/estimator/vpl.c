/* vpl.c: instant radiosity: photons as point lights over their hemispheres
 * (shared/virtual_lights.h).
 *
 * Keller 1997. What a light reaches comes from a few rays of each light (vpl/hemisphere_map.h), or
 * from a shadow ray for each light and pixel. Without either it is splatting indirect illumination
 * (Dachsbacher and Stamminger 2006), and the left half of figure 5 in Hoet 2014. What corners lose
 * by the clamp comes by short rays (shared/compensation.h).
 *
 * Cost is lights times pixels, so only `lights` photons, drawn at random from all, are used, with
 * the power of all.
 */
#include "shared/compensation.h"
#include "shared/virtual_lights.h"
#include "vpl/hemisphere_map.h"

#include <stdbool.h>

/* Of the maps of a batch of lights; one takes 24 MiB at most. */
#define MAP_BYTES ((size_t)256 << 20)

enum { VISIBILITY_MAP, VISIBILITY_RAYS, VISIBILITY_NONE };

static const char *const visibility_choices[] = {"map", "rays", "none", NULL};

struct state {
    int64_t lights;
    int32_t visibility;
    ps_number_or_choice clamp;
    int64_t compensation;
    int64_t resolution;
};

struct work {
    const ps_host *host;
    const ps_pass *pass;
    struct virtual_lights chosen; /* owned, as what follows */
    struct hemisphere_map *maps;  /* of the lights from `first` on */
    struct hemisphere_hit *cells;
    size_t first, end; /* lights of a batch */
    uint32_t resolution;
    int visibility;
    struct compensation compensation;
};

/* The pixels of a tile, as points just above their surfaces. */
struct receivers {
    _Alignas(64) float x[PS_TILE_PIXELS], y[PS_TILE_PIXELS], z[PS_TILE_PIXELS];
    float normal_x[PS_TILE_PIXELS], normal_y[PS_TILE_PIXELS],
        normal_z[PS_TILE_PIXELS]; /* 0 where nothing is seen */
};

/* Those of a tile and one light. */
struct connections {
    _Alignas(64) float x[PS_TILE_PIXELS], y[PS_TILE_PIXELS],
        z[PS_TILE_PIXELS];          /* from the light to the receiver */
    float geometry[PS_TILE_PIXELS]; /* G * V */
};

/* Irradiance of the pixels. */
struct sums {
    _Alignas(64) float r[PS_TILE_PIXELS], g[PS_TILE_PIXELS], b[PS_TILE_PIXELS];
};

static void find_receivers(const ps_tile *tile, float offset, struct receivers *receivers)
{
    for (int i = 0; i < PS_TILE_PIXELS; i++) {
        receivers->normal_x[i] = tile->normal_x[i];
        receivers->normal_y[i] = tile->normal_y[i];
        receivers->normal_z[i] = tile->normal_z[i];
        receivers->x[i] = tile->position_x[i] + offset * tile->normal_x[i];
        receivers->y[i] = tile->position_y[i] + offset * tile->normal_y[i];
        receivers->z[i] = tile->position_z[i] + offset * tile->normal_z[i];
    }
}

static void connect(const ps_photon *light, ps_vec3 origin, float nearest,
                    const struct receivers *restrict receivers,
                    struct connections *restrict connections)
{
    const ps_vec3 normal = light->normal;
#pragma omp simd
    for (int i = 0; i < PS_TILE_PIXELS; i++) {
        float x = receivers->x[i] - origin.x, y = receivers->y[i] - origin.y,
              z = receivers->z[i] - origin.z;
        float distance2 = x * x + y * y + z * z;
        float photon = x * normal.x + y * normal.y + z * normal.z;
        float receiver =
            x * receivers->normal_x[i] + y * receivers->normal_y[i] + z * receivers->normal_z[i];
        float cosines = ps_max(photon, 0.0f) * ps_max(-receiver, 0.0f) / distance2;
        float geometry = cosines / ps_max(distance2, nearest * nearest);
        connections->x[i] = x;
        connections->y[i] = y;
        connections->z[i] = z;
        connections->geometry[i] = cosines > 0.0f ? geometry : 0.0f;
    }
}

/* By a shadow ray from each receiver that the light faces. */
static void cast_shadow_rays(const struct work *work, const struct receivers *receivers,
                             struct connections *connections)
{
    ps_ray rays[PS_TILE_PIXELS];
    uint8_t blocked[PS_TILE_PIXELS];
    size_t targets[PS_TILE_PIXELS], count = 0;
    for (size_t i = 0; i < PS_TILE_PIXELS; i++) {
        ps_vec3 between = {-connections->x[i], -connections->y[i], -connections->z[i]};
        ps_vec3 origin = {receivers->x[i], receivers->y[i], receivers->z[i]};
        float distance = ps_length(between);
        targets[count] = i;
        rays[count] = (ps_ray){origin, 0.0f, ps_scale(between, 1.0f / distance), distance};
        count += connections->geometry[i] > 0.0f;
    }
    work->host->occluded(work->host, rays, count, blocked);
    for (size_t i = 0; i < count; i++)
        if (blocked[i])
            connections->geometry[targets[i]] = 0.0f;
}

/* Adds what a light's connections carry. */
static void add_irradiance(const ps_photon *light, const struct connections *restrict connections,
                           struct sums *restrict sums)
{
    const ps_rgb intensity = ps_rgb_scale(light->power, 1.0f / PS_PI);
#pragma omp simd
    for (int i = 0; i < PS_TILE_PIXELS; i++) {
        float geometry = connections->geometry[i];
        sums->r[i] += intensity.r * geometry;
        sums->g[i] += intensity.g * geometry;
        sums->b[i] += intensity.b * geometry;
    }
}

static void add_lights(const struct work *work, const ps_tile *tile, struct sums *sums)
{
    struct receivers receivers;
    struct connections connections;
    const struct hemisphere_points points = {
        connections.x,      connections.y,      connections.z,
        receivers.normal_x, receivers.normal_y, receivers.normal_z,
    };
    find_receivers(tile, work->pass->surface_offset, &receivers);
    for (size_t i = work->first; i < work->end; i++) {
        const ps_photon *light = &work->chosen.lights[i];
        connect(light, virtual_light_origin(work->pass, light), work->compensation.clamp,
                &receivers, &connections);
        if (work->visibility == VISIBILITY_RAYS)
            cast_shadow_rays(work, &receivers, &connections);
        else if (work->visibility == VISIBILITY_MAP)
            hemisphere_map_occlude(&work->maps[i - work->first], &points, connections.geometry);
        add_irradiance(light, &connections, sums);
    }
}

static void light_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    ps_tile *tile = work->host->tile(work->host, (uint32_t)index);
    struct sums sums = {{0}, {0}, {0}};
    ps_rgb close[PS_TILE_PIXELS] = {{0, 0, 0}};
    ps_points points;
    ps_collect_points(tile, &points);
    add_lights(work, tile, &sums);
    for (size_t i = 0; i < points.count; i++) {
        uint32_t lane = points.lanes[i];
        tile->irradiance_r[lane] += sums.r[lane];
        tile->irradiance_g[lane] += sums.g[lane];
        tile->irradiance_b[lane] += sums.b[lane];
    }
    if (work->end < work->chosen.count)
        return;
    compensation_add(&work->compensation, index, &points, close);
    for (size_t i = 0; i < points.count; i++)
        ps_add_irradiance(tile, points.lanes[i], close[i]);
}

/* What the light of that number in the batch sees. */
static void cast_map(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    const ps_photon *light = &work->chosen.lights[work->first + index];
    struct hemisphere_map *map = &work->maps[index];
    float numbers[1][4];
    uint64_t sample = (uint64_t)work->pass->number << 40 | (work->first + index);
    work->host->samples(work->host, PS_STREAM_ESTIMATOR, VIRTUAL_LIGHTS_SETS, &sample, 1, numbers);
    map->resolution = work->resolution;
    map->cells = work->cells + index * work->resolution * work->resolution;
    hemisphere_map_cast(work->host, virtual_light_origin(work->pass, light), light->normal,
                        numbers[0][0], map);
}

/* Lights with maps go in batches, since maps are large. */
static ps_result light_in_batches(struct work *work)
{
    const ps_host *host = work->host;
    size_t cells = (size_t)work->resolution * work->resolution;
    size_t count = work->chosen.count, most = MAP_BYTES / (cells * sizeof *work->cells);
    bool maps = work->visibility == VISIBILITY_MAP && count > 0;
    ps_result result;
    if (!maps || most > count)
        most = count;
    if (maps) {
        work->maps = host->allocate(host, most * sizeof *work->maps, "virtual lights");
        work->cells = host->allocate(host, most * cells * sizeof *work->cells, "virtual lights");
        if (!work->maps || !work->cells)
            return PS_ERROR_MEMORY;
    }
    do {
        work->first = work->end;
        work->end = count - work->first < most ? count : work->first + most;
        if (maps)
            host->parallel_for(host, work->end - work->first, cast_map, work);
        result = host->for_each_tile(host, light_tile, work);
    } while (result == PS_OK && work->end < count);
    return result;
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    const struct state *state = opaque;
    struct work work = {
        .host = host,
        .pass = pass,
        .resolution = (uint32_t)state->resolution,
        .visibility = state->visibility,
        .compensation = {{host, pass, COMPENSATION_ROULETTE, false, false},
                         (uint64_t)state->compensation,
                         virtual_lights_clamp(host, state->clamp)},
    };
    ps_result result = virtual_lights_choose(host, pass, (size_t)state->lights, &work.chosen);
    if (result == PS_OK)
        result = light_in_batches(&work);
    host->release(host, work.cells);
    host->release(host, work.maps);
    virtual_lights_release(&work.chosen);
    return result;
}

static const ps_param params[] = {
    PS_INT(struct state, lights, "256", 1, 10000000, "lights",
           "photons used as point lights; they are drawn from all and get the power of all"),
    PS_CHOICE(
        struct state, visibility, "map", visibility_choices,
        "what a light reaches, by: map: rays over its hemisphere; rays: a shadow ray for each "
        "pixel; none: nothing is in the way"),
    VIRTUAL_LIGHTS_CLAMP(struct state),
    COMPENSATION_RAYS(struct state),
    PS_ROW(struct state, resolution, PS_PARAM_INT, "32", 1, 1024, PS_PARAM_EXPERT, NULL, "rays",
           "side of the square of rays of a map"),
};

static const ps_estimator_vtable vtable = {
    .size = sizeof vtable,
    .flags = PS_ESTIMATOR_CROPS,
    .accumulate = accumulate,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "vpl",
    .version = "1.0",
    .summary = "instant radiosity: photons as point lights over the hemisphere",
    .paper =
        "Keller 1997, Instant radiosity; Kollig and Keller 2006, Illumination in the presence of "
        "weak singularities",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, vpl, &descriptor)
