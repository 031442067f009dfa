/* rsm.c: photons by reflective shadow maps (Dachsbacher and Stamminger 2005).
 *
 * A map is the scene as a light sees it. Each of its pixels is a candidate: a place on a surface,
 * and the flux that the light sends there,
 *
 *     intensity * solid angle of the pixel        point lights and spotlights
 *     irradiance * area of the pixel              suns
 *
 * Of all candidates `count` are chosen with probabilities p in proportion to the flux that they
 * reflect (importance sampling as in Dachsbacher and Stamminger 2006, "Splatting indirect
 * illumination"; Hoet 2014, section 4.2), by an alias table. Each choice leaves one photon, in a
 * direction that the surface scatters to, with the power flux * reflectance / (p * count). That is
 * the same for all photons but for colour, so none stands out.
 *
 * A spotlight's map is a perspective one, as wide as its cone; wide cones and point lights have the
 * six faces of a cube. A sun's pixels share out the disc across its light that holds the scene, in
 * equal areas. Area lights and skies have no one place to look from: each of their pixels is a ray
 * of its own, from a place on the light in a direction of its own.
 *
 * Rays are traced rather than triangles rasterized, so a candidate needs no memory but its weight:
 * the ray of a chosen one is traced again. In each pass the rays go through another place of their
 * pixels.
 *
 * A map sees one bounce. Mirrors and glass do not count as one, as in `photon`: what they send on
 * makes photons too, before and after the diffuse surface. Where two diffuse surfaces follow each
 * other, light ends.
 */
#include <psplat/plugin.h>
#include <stdio.h>

#include <string.h>

#define STREAM_PIXEL PS_STREAM_PLUGIN     /* the place in the pixels; index: the pass */
#define STREAM_RAY (PS_STREAM_PLUGIN + 1) /* rays without a common origin; set: the map */

#define MEMORY "shadow maps"

struct map {
    uint32_t light;
    uint32_t kind;      /* ps_light_kind */
    ps_light_view view; /* PS_LIGHT_POINT */
};

struct state {
    int64_t count, resolution;
    struct map *maps;
    uint32_t map_count, pixels; /* pixels of a map */
    uint32_t candidates;        /* of all maps */
    float *weights;             /* of each candidate: the flux that it reflects, W */
    const ps_alias_service *alias;
    ps_alias *table;
    uint32_t *order;
    /* Of the pass that is prepared: */
    double total;    /* of the weights */
    float jitter[4]; /* 0 and 1: where in its pixel each ray goes */
};

struct path {
    ps_ray ray;
    ps_rgb power;
    uint64_t index;   /* over all passes */
    float numbers[4]; /* for the next surface */
    uint16_t bounces; /* diffuse surfaces met */
    uint8_t specular; /* ps_gloss */
};

/* --- the maps of the lights
 * ------------------------------------------------------------------------ */

static uint32_t maps_of_light(const ps_light *light)
{
    if (light->kind == PS_LIGHT_POINT)
        return ps_light_view_count(light);
    return ps_rgb_maximum(light->power) > 0.0f;
}

static struct map map_of_light(uint32_t index, const ps_light *light, uint32_t face)
{
    struct map map = {.light = index, .kind = light->kind};
    if (light->kind == PS_LIGHT_POINT)
        map.view = ps_light_view_of(light, face);
    return map;
}

static int32_t create_maps(struct state *state, const ps_host *host)
{
    uint32_t lights = host->light_count(host);
    state->maps = host->allocate(host, (6 * (size_t)lights + 1) * sizeof *state->maps, MEMORY);
    if (!state->maps)
        return 1;
    for (uint32_t i = 0; i < lights; i++) {
        ps_light light = {.size = sizeof light};
        host->light(host, i, &light);
        for (uint32_t face = 0; face < maps_of_light(&light); face++)
            state->maps[state->map_count++] = map_of_light(i, &light, face);
    }
    return 0;
}

/* --- candidates
 * -------------------------------------------------------------------------------------- */

/* Where pixel `pixel` of a map lies in the unit square, in this pass. */
static void place_pixel(const struct state *state, uint32_t pixel, float place[2])
{
    uint32_t side = (uint32_t)state->resolution, column = pixel % side, row = pixel / side;
    place[0] = fminf(((float)column + state->jitter[0]) / (float)side, 0x1.fffffep-1f);
    place[1] = fminf(((float)row + state->jitter[1]) / (float)side, 0x1.fffffep-1f);
}

/* Rays through pixels of a perspective map. The solid angle of a pixel is its area on the plane at
 * distance 1, times cos^3. */
static void look_through(const struct state *state, const ps_host *host, const ps_pass *pass,
                         const struct map *map, const uint32_t *pixels, size_t n, ps_ray *rays,
                         ps_rgb *power)
{
    ps_vec3 directions[PS_PATH_CHUNK] = {{0, 0, 0}};
    float step = 2.0f * map->view.radius / (float)state->resolution;
    for (size_t i = 0; i < n; i++) {
        float place[2];
        place_pixel(state, pixels[i], place);
        rays[i] = ps_light_view_ray(&map->view, place[0], place[1], pass->surface_offset);
        directions[i] = rays[i].direction;
    }
    host->light_intensity(host, map->light, directions, n, power);
    for (size_t i = 0; i < n; i++) {
        float cosine = ps_dot(directions[i], map->view.axis);
        power[i] = ps_rgb_scale(power[i], step * step * cosine * cosine * cosine);
    }
}

/* Rays of a light that has no one origin; those of a sun lie on a grid. */
static void look_from_all_over(const struct state *state, const ps_host *host, const ps_pass *pass,
                               const struct map *map, const uint32_t *pixels, size_t n,
                               ps_ray *rays, ps_rgb *power)
{
    uint64_t indices[PS_PATH_CHUNK] = {0};
    float numbers[PS_PATH_CHUNK][4];
    for (size_t i = 0; i < n; i++)
        indices[i] = (uint64_t)pass->number * state->pixels + pixels[i];
    host->samples(host, STREAM_RAY, (uint32_t)(map - state->maps), indices, n, numbers);
    for (size_t i = 0; i < n && map->kind == PS_LIGHT_SUN; i++)
        place_pixel(state, pixels[i], &numbers[i][2]);
    host->emit_from(host, map->light, (const float(*)[4])numbers, n, rays, power);
    for (size_t i = 0; i < n; i++)
        power[i] = ps_rgb_scale(power[i], 1.0f / (float)state->pixels);
}

/* The rays of at most PS_PATH_CHUNK pixels of a map, and the flux that each stands for. */
static void look(const struct state *state, const ps_host *host, const ps_pass *pass,
                 const struct map *map, const uint32_t *pixels, size_t n, ps_ray *rays,
                 ps_rgb *power)
{
    if (map->kind == PS_LIGHT_POINT)
        look_through(state, host, pass, map, pixels, n, rays, power);
    else
        look_from_all_over(state, host, pass, map, pixels, n, rays, power);
}

/* What decides how often a candidate is chosen: the flux that it reflects, all three colours
 * counting alike, lest one be noisier than the others. Of mirrors and glass it is the most that
 * they could, so that nothing is left out. */
static float weigh(const ps_hit *hit, ps_rgb power)
{
    if (!(hit->distance < INFINITY))
        return 0.0f;
    if (!(hit->flags & PS_HIT_SPECULAR))
        power = ps_rgb_multiply(power, hit->albedo);
    return power.r + power.g + power.b;
}

struct preparation {
    struct state *state;
    const ps_host *host;
    const ps_pass *pass;
};

static uint32_t chunks_of_map(const struct state *state)
{
    return (state->pixels + PS_PATH_CHUNK - 1) / PS_PATH_CHUNK;
}

static void weigh_chunk(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct preparation *preparation = user;
    struct state *state = preparation->state;
    const ps_host *host = preparation->host;
    uint32_t pixels[PS_PATH_CHUNK], n = 0, lit = 0;
    ps_ray rays[PS_PATH_CHUNK];
    ps_rgb power[PS_PATH_CHUNK];
    ps_hit hits[PS_PATH_CHUNK];
    uint32_t map = (uint32_t)(index / chunks_of_map(state));
    uint32_t first = (uint32_t)(index % chunks_of_map(state)) * PS_PATH_CHUNK;
    for (uint32_t i = first; i < state->pixels && n < PS_PATH_CHUNK; i++)
        pixels[n++] = i;
    if (host->cancelled(host))
        return;
    look(state, host, preparation->pass, &state->maps[map], pixels, n, rays, power);
    float *weights = &state->weights[(size_t)map * state->pixels];
    for (uint32_t i = 0; i < n; i++) {
        weights[pixels[i]] = 0.0f;
        if (!(ps_rgb_maximum(power[i]) > 0.0f))
            continue;
        pixels[lit] = pixels[i];
        rays[lit] = rays[i];
        power[lit++] = power[i];
    }
    host->intersect(host, rays, lit, hits);
    for (uint32_t i = 0; i < lit; i++)
        weights[pixels[i]] = weigh(&hits[i], power[i]);
}

static ps_result prepare(void *opaque, const ps_host *host, const ps_pass *pass)
{
    struct state *state = opaque;
    ps_warn_of_single_bounce(host, pass, "injection rsm makes indirect light of one bounce alone");
    struct preparation preparation = {state, host, pass};
    uint64_t index = pass->number;
    host->samples(host, STREAM_PIXEL, 0, &index, 1, &state->jitter);
    host->parallel_for(host, (uint64_t)state->map_count * chunks_of_map(state), weigh_chunk,
                       &preparation);
    if (host->cancelled(host))
        return PS_CANCELLED;
    state->total =
        state->alias->build(state->weights, state->candidates, state->table, state->order);
    uint32_t lit = 0;
    for (uint32_t i = 0; i < state->candidates; i++)
        lit += state->weights[i] > 0.0f;
    host->count(host, "candidates", lit);
    return PS_OK;
}

/* --- photons
 * ------------------------------------------------------------------------------------------- */

/* None where no light meets anything. */
static uint64_t path_count(const void *opaque)
{
    const struct state *state = opaque;
    return state->total > 0.0 ? (uint64_t)state->count : 0;
}

/* The ray of a candidate, with the share of the flux that one of `count` choices of it carries. */
static void start_path(const struct state *state, const ps_host *host, const ps_pass *pass,
                       uint32_t candidate, struct path *path)
{
    uint32_t pixel = candidate % state->pixels;
    look(state, host, pass, &state->maps[candidate / state->pixels], &pixel, 1, &path->ray,
         &path->power);
    double choices = (double)state->weights[candidate] / state->total * (double)state->count;
    path->power = ps_rgb_scale(path->power, (float)(1.0 / choices));
}

/* Choice and direction share one four-dimensional point. The number that chooses among the cells of
 * the alias table gets 24 more bits: there may be more cells than a float in [0,1) has values. */
static void start_paths(const struct state *state, const ps_host *host, const ps_pass *pass,
                        uint64_t first, size_t n, struct path *paths)
{
    uint64_t indices[PS_PATH_CHUNK] = {0};
    float shared[PS_PATH_CHUNK][4], other[PS_PATH_CHUNK][4];
    for (size_t i = 0; i < n; i++)
        indices[i] = (uint64_t)pass->number * (uint64_t)state->count + first + i;
    host->samples(host, PS_STREAM_EMISSION, 0, indices, n, shared);
    host->samples(host, PS_STREAM_EMISSION, 1, indices, n, other);
    for (size_t i = 0; i < n; i++) {
        double place = ((double)shared[i][0] + (double)other[i][0] * 0x1p-24) * state->candidates;
        uint32_t chosen =
            state->alias->choose(state->table, state->candidates, place, shared[i][1]);
        paths[i] = (struct path){
            .index = indices[i],
            .numbers = {shared[i][2], shared[i][3], other[i][1], other[i][2]},
        };
        start_path(state, host, pass, chosen, &paths[i]);
    }
}

/* The paths that meet something, moved to the front with their rays and hits. */
static size_t trace_paths(const ps_host *host, struct path *paths, size_t n, ps_ray *rays,
                          ps_hit *hits)
{
    for (size_t i = 0; i < n; i++)
        rays[i] = paths[i].ray;
    size_t kept[PS_PATH_CHUNK];
    size_t met = ps_trace_kept(host, rays, n, hits, kept);
    for (size_t i = 0; i < met; i++)
        paths[i] = paths[kept[i]];
    return met;
}

static void scatter_paths(const ps_host *host, uint32_t segment, const struct path *paths, size_t n,
                          const ps_ray *rays, const ps_hit *hits, ps_bsdf_sample *scattered)
{
    uint64_t indices[PS_PATH_CHUNK] = {0};
    float numbers[PS_PATH_CHUNK][4];
    for (size_t i = 0; i < n; i++) {
        indices[i] = paths[i].index;
        memcpy(numbers[i], paths[i].numbers, sizeof numbers[i]);
    }
    if (segment > 0)
        host->samples(host, PS_STREAM_BOUNCE, segment + 1, indices, n, numbers);
    host->sample_bsdf(host, PS_FROM_LIGHT, rays, hits, (const float(*)[4])numbers, n, scattered);
}

/* Leaves photons where the paths meet something, but on a second diffuse surface. Paths that may
 * yet leave another are moved to the front. */
static size_t extend_paths(const ps_host *host, const ps_pass *pass, uint32_t segment,
                           struct path *paths, size_t n, ps_photon *photons, size_t *count)
{
    ps_ray rays[PS_PATH_CHUNK];
    ps_hit hits[PS_PATH_CHUNK];
    ps_bsdf_sample scattered[PS_PATH_CHUNK];
    size_t alive = 0;
    *count = 0;
    n = trace_paths(host, paths, n, rays, hits);
    scatter_paths(host, segment, paths, n, rays, hits, scattered);
    for (size_t i = 0; i < n; i++) {
        struct path path = paths[i];
        path.power = ps_rgb_multiply(path.power, scattered[i].weight);
        path.bounces += scattered[i].lobe == PS_DIFFUSE;
        if (scattered[i].lobe != PS_DIFFUSE)
            path.specular = ps_gloss_after(path.specular, hits[i].roughness);
        if (!(ps_rgb_maximum(path.power) > 0.0f) || path.bounces > 1)
            continue;
        photons[(*count)++] = (ps_photon){
            .position = hits[i].position,
            .normal = scattered[i].normal,
            .direction = scattered[i].direction,
            .power = path.power,
            .bounce = path.bounces,
            .lobe = (uint8_t)scattered[i].lobe,
            .specular = path.specular,
            .merged = 1.0f,
            .path = path.index,
        };
        path.ray = ps_leave_surface(hits[i].position, scattered[i].normal, scattered[i].direction,
                                    pass->surface_offset);
        if (segment < PS_LONGEST_CHAIN && (pass->specular || path.bounces == 0))
            paths[alive++] = path;
    }
    return alive;
}

static ps_result emit(const void *opaque, const ps_host *host, const ps_pass *pass, uint64_t first,
                      size_t n, const ps_photon_sink *sink)
{
    struct path paths[PS_PATH_CHUNK];
    ps_photon photons[PS_PATH_CHUNK];
    start_paths(opaque, host, pass, first, n, paths);
    ps_result result = PS_OK;
    for (uint32_t segment = 0; n > 0 && result == PS_OK; segment++) {
        size_t count;
        n = extend_paths(host, pass, segment, paths, n, photons, &count);
        result = sink->append(sink->core, photons, count);
    }
    return result;
}

/* --- the plugin
 * ------------------------------------------------------------------------------------------ */

static void destroy(void *opaque, const ps_host *host)
{
    struct state *state = opaque;
    host->release(host, state->maps);
    host->release(host, state->weights);
    host->release(host, state->table);
    host->release(host, state->order);
}

static ps_result create(struct state *state, const ps_host *host)
{
    char why[100];
    if (create_maps(state, host) != 0)
        return PS_ERROR_MEMORY;
    state->pixels = (uint32_t)(state->resolution * state->resolution);
    uint64_t candidates = (uint64_t)state->map_count * state->pixels;
    if (candidates > UINT32_MAX) {
        snprintf(why, sizeof why, "%u maps of %u pixels are too many; lower the resolution",
                 (unsigned)state->map_count, (unsigned)state->pixels);
        return host->fail(host, PS_ERROR_INVALID, why);
    }
    state->candidates = (uint32_t)candidates;
    state->weights = host->allocate(host, candidates * sizeof *state->weights, MEMORY);
    state->table = host->allocate(host, candidates * sizeof *state->table, MEMORY);
    state->order = host->allocate(host, candidates * sizeof *state->order, MEMORY);
    if (state->weights && state->table && state->order)
        return PS_OK;
    snprintf(why, sizeof why, "out of memory for %u maps of %u pixels", (unsigned)state->map_count,
             (unsigned)state->pixels);
    return host->fail(host, PS_ERROR_MEMORY, why);
}

static ps_result init(void *opaque, const ps_host *host)
{
    struct state *state = opaque;
    state->alias = host->extension(host, PS_ALIAS_EXTENSION);
    ps_result result = create(state, host);
    if (result != PS_OK)
        destroy(state, host);
    return result;
}

static const ps_param params[] = {
    PS_INT(struct state, count, "100000", 1, 2000000000, "photons",
           "pixels chosen in each pass; each becomes a photon"),
    PS_INT(struct state, resolution, "256", 1, 8192, "pixels", "pixels along the side of each map"),
};

static const ps_injection_vtable vtable = {
    .size = sizeof vtable,
    .path_count = path_count,
    .emit = emit,
    .prepare = prepare,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_INJECTION,
    .name = "rsm",
    .version = "1.0",
    .summary =
        "reflective shadow maps: pixels of maps from the lights become photons, chosen by flux",
    .paper = "Dachsbacher and Stamminger 2005, Reflective shadow maps; Hoet 2014, section 4.2",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .init = init,
    .destroy = destroy,
    .vtable = &vtable,
};

PS_MODULE(injection, rsm, &descriptor)
