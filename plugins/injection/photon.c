/* photon.c: sources by photon tracing.
 *
 * Light paths start at the lights with a share Phi / N of their power. At every surface a path leaves
 * a source in a direction that the surface scatters to, with the power that it scatters (at a diffuse
 * one, power * albedo), and goes on along that very direction: the source's bundled ray is the path's
 * next segment. So the first bounce needs no special case, and `bounces: 1` is the thesis's single
 * bounce. Sources on mirrors and glass make caustics; these surfaces do not count as bounces.
 * Russian roulette (Arvo and Kirk 1990) ends paths at diffuse surfaces with the albedo's complement
 * and divides the survivors' power, which keeps the mean.
 *
 * Emission and first direction share one four-dimensional Sobol point: low discrepancy over (light
 * direction, bounce direction) together.
 */
#include <psplat/plugin.h>

#include <string.h>

struct state {
    int64_t count;
    int64_t bounces;
    int64_t roulette;
};

struct path {
    ps_ray ray;
    ps_rgb power;
    uint64_t index;   /* over all passes */
    float numbers[4]; /* for the next surface: two for the direction, roulette, choice of lobe */
    uint32_t bounces; /* diffuse surfaces met */
    uint32_t chain;   /* others since the last one */
    uint8_t specular; /* 1: it met others at all */
};

static uint64_t path_count(const void *state)
{
    return (uint64_t)((const struct state *)state)->count;
}

static void start_paths(const struct state *state, const ps_host *host, const ps_pass *pass,
                        uint64_t first, size_t n, struct path *paths)
{
    uint64_t indices[PS_PATH_CHUNK] = {0};
    float shared[PS_PATH_CHUNK][4], other[PS_PATH_CHUNK][4], emission[PS_PATH_CHUNK][4];
    ps_ray rays[PS_PATH_CHUNK];
    ps_rgb power[PS_PATH_CHUNK];
    for (size_t i = 0; i < n; i++)
        indices[i] = (uint64_t)pass->number * (uint64_t)state->count + first + i;
    host->samples(host, PS_STREAM_EMISSION, 0, indices, n, shared);
    host->samples(host, PS_STREAM_EMISSION, 1, indices, n, other);
    for (size_t i = 0; i < n; i++) {
        emission[i][0] = shared[i][0];
        emission[i][1] = shared[i][1];
        emission[i][2] = other[i][0];
        emission[i][3] = other[i][1];
    }
    host->emit_light(host, (const float(*)[4])emission, n, rays, power);
    for (size_t i = 0; i < n; i++)
        paths[i] = (struct path){
            .ray = rays[i],
            .power = ps_rgb_scale(power[i], 1.0f / (float)state->count),
            .index = indices[i],
            .numbers = {shared[i][2], shared[i][3], other[i][2], other[i][3]},
        };
}

/* Random numbers for the surfaces that the paths meet at the end of segment `segment` > 0. */
static void draw_surface(const ps_host *host, uint32_t segment, struct path *paths, size_t n)
{
    uint64_t indices[PS_PATH_CHUNK] = {0};
    float points[PS_PATH_CHUNK][4];
    for (size_t i = 0; i < n; i++)
        indices[i] = paths[i].index;
    host->samples(host, PS_STREAM_BOUNCE, segment + 1, indices, n, points);
    for (size_t i = 0; i < n; i++)
        memcpy(paths[i].numbers, points[i], sizeof points[i]);
}

/* Whether a path goes on after a surface that scatters like this; its power is then what is left. */
static int goes_on(const struct state *state, const ps_scatter *scattered, struct path *path)
{
    path->power = ps_rgb_multiply(path->power, scattered->weight);
    if (!(ps_rgb_maximum(path->power) > 0.0f))
        return 0;
    if (scattered->lobe != PS_DIFFUSE) {
        path->specular = 1;
        return ++path->chain <= PS_LONGEST_CHAIN;
    }
    path->chain = 0;
    path->bounces++;
    if (state->bounces && path->bounces > (uint32_t)state->bounces)
        return 0;
    return !state->roulette || path->bounces < (uint32_t)state->roulette ||
           ps_survives(ps_rgb_maximum(scattered->weight), path->numbers[2], &path->power);
}

static ps_source source_of(const struct path *path, const ps_hit *hit, const ps_scatter *scattered)
{
    return (ps_source){
        .position = hit->position,
        .normal = scattered->normal,
        .direction = scattered->direction,
        .power = path->power,
        .bounce = (uint16_t)path->bounces,
        .lobe = (uint8_t)scattered->lobe,
        .specular = path->specular,
        .merged = 1.0f,
        .path = path->index,
    };
}

/* Traces the paths, and keeps those that meet something, moved to the front with their hits. */
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

/* Whether a path that left a source may leave another: past the last diffuse bounce only mirrors and
 * glass can make one. */
static int may_go_on(const struct state *state, const ps_pass *pass, const struct path *path)
{
    return pass->specular || !state->bounces || path->bounces < (uint32_t)state->bounces;
}

/* Carries all paths to their next surface, where they leave `count` sources; returns how many go on,
 * moved to the front. */
static size_t extend_paths(const struct state *state, const ps_host *host, const ps_pass *pass,
                           uint32_t segment, struct path *paths, size_t n, ps_source *sources,
                           size_t *count)
{
    ps_ray rays[PS_PATH_CHUNK];
    ps_hit hits[PS_PATH_CHUNK];
    ps_scatter scattered[PS_PATH_CHUNK];
    float numbers[PS_PATH_CHUNK][4];
    n = trace_paths(host, paths, n, rays, hits);
    if (segment > 0)
        draw_surface(host, segment, paths, n);
    for (size_t i = 0; i < n; i++)
        memcpy(numbers[i], paths[i].numbers, sizeof numbers[i]);
    host->scatter(host, PS_FROM_LIGHT, rays, hits, (const float(*)[4])numbers, n, scattered);
    size_t alive = 0;
    *count = 0;
    for (size_t i = 0; i < n; i++) {
        struct path path = paths[i];
        if (!goes_on(state, &scattered[i], &path))
            continue;
        sources[(*count)++] = source_of(&path, &hits[i], &scattered[i]);
        path.ray = ps_leave_surface(hits[i].position, scattered[i].normal, scattered[i].direction,
                                    pass->surface_offset);
        if (may_go_on(state, pass, &path))
            paths[alive++] = path;
    }
    return alive;
}

static ps_result emit(const void *opaque, const ps_host *host, const ps_pass *pass, uint64_t first,
                      size_t n, const ps_source_sink *sink)
{
    const struct state *state = opaque;
    struct path paths[PS_PATH_CHUNK];
    ps_source sources[PS_PATH_CHUNK];
    start_paths(state, host, pass, first, n, paths);
    ps_result result = PS_OK;
    for (uint32_t segment = 0; n > 0 && result == PS_OK; segment++) {
        size_t count;
        n = extend_paths(state, host, pass, segment, paths, n, sources, &count);
        result = sink->append(sink->core, sources, count);
    }
    return result;
}

static int32_t init(void *opaque, const ps_host *host, char *message, size_t size)
{
    (void)host;
    const struct state *state = opaque;
    return ps_check_bounces(state->bounces, state->roulette, message, size);
}

static const ps_param params[] = {
    PS_INT(struct state, count, "100000", 1, 2000000000, "paths", "light paths in each pass"),
    PS_INT(struct state, bounces, "1", 0, 1000, "bounces",
           "diffuse surfaces at which a path leaves a source; 0: unlimited"),
    PS_INT(struct state, roulette, "2", 0, 1000, "bounces",
           "bounce from which on Russian roulette may end a path; 0: never"),
};

static const ps_injection_vtable vtable = {
    .size = sizeof vtable,
    .path_count = path_count,
    .emit = emit,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_INJECTION,
    .name = "photon",
    .version = "1.0",
    .summary = "traces photons from the lights; each diffuse surface they meet becomes a source",
    .paper = "Jensen 1996, Global illumination using photon maps; Hoet 2014, section 3.2",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .init = init,
    .vtable = &vtable,
};

PS_MODULE(injection, photon, &descriptor)
