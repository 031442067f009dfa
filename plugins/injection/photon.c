/* photon.c: sources by photon tracing.
 *
 * Light paths start at the lights with a share Phi / N of their power. At every diffuse surface a
 * path leaves a source that carries power * albedo in a cosine-distributed direction, and goes on
 * along that very direction: the source's bundled ray is the path's next segment. So the first
 * bounce needs no special case, and `bounces: 1` is the thesis's single bounce. Russian roulette
 * (Arvo and Kirk 1990) ends paths with the albedo's complement and divides the survivors' power,
 * which keeps the mean.
 *
 * Emission and first direction share one four-dimensional Sobol point: low discrepancy over (light
 * direction, bounce direction) together.
 */
#include <psplat/plugin.h>

struct state {
    int64_t count;
    int64_t bounces;
    int64_t roulette;
};

struct path {
    ps_ray ray;
    ps_rgb power;
    uint64_t index;               /* over all passes */
    float direction[2], roulette; /* random numbers of the next surface */
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
            .direction = {shared[i][2], shared[i][3]},
            .roulette = other[i][2],
        };
}

/* Random numbers for the surfaces that the paths meet at bounce `bounce` > 1. */
static void draw_bounce(const ps_host *host, uint32_t bounce, struct path *paths, size_t n)
{
    uint64_t indices[PS_PATH_CHUNK] = {0};
    float points[PS_PATH_CHUNK][4];
    for (size_t i = 0; i < n; i++)
        indices[i] = paths[i].index;
    host->samples(host, PS_STREAM_BOUNCE, bounce, indices, n, points);
    for (size_t i = 0; i < n; i++) {
        paths[i].direction[0] = points[i][0];
        paths[i].direction[1] = points[i][1];
        paths[i].roulette = points[i][2];
    }
}

/* Reflects a path at its hit; 0 when it ends there. */
static int reflect(const struct state *state, uint32_t bounce, const ps_hit *hit, float offset,
                   struct path *path)
{
    if (!(hit->distance < INFINITY))
        return 0;
    path->power = ps_rgb_multiply(path->power, hit->albedo);
    float likelihood = ps_rgb_maximum(hit->albedo);
    if (state->roulette && bounce >= (uint32_t)state->roulette &&
        !ps_survives(likelihood, path->roulette, &path->power))
        return 0;
    if (!(ps_rgb_maximum(path->power) > 0.0f))
        return 0;
    ps_vec3 direction = ps_cosine_direction(hit->normal, path->direction[0], path->direction[1]);
    path->ray = ps_leave_surface(hit->position, hit->normal, direction, offset);
    return 1;
}

static ps_source source_of(const struct path *path, const ps_hit *hit, uint32_t bounce)
{
    return (ps_source){
        .position = hit->position,
        .normal = hit->normal,
        .direction = path->ray.direction,
        .power = path->power,
        .bounce = bounce,
        .merged = 1.0f,
        .path = path->index,
    };
}

/* Carries all paths to their next surface; returns how many go on, moved to the front. */
static size_t bounce_paths(const struct state *state, const ps_host *host, const ps_pass *pass,
                           uint32_t bounce, struct path *paths, size_t n, ps_source *sources)
{
    ps_ray rays[PS_PATH_CHUNK];
    ps_hit hits[PS_PATH_CHUNK];
    for (size_t i = 0; i < n; i++)
        rays[i] = paths[i].ray;
    host->intersect(host, rays, n, hits);
    if (bounce > 1)
        draw_bounce(host, bounce, paths, n);
    size_t alive = 0;
    for (size_t i = 0; i < n; i++) {
        struct path path = paths[i];
        if (!reflect(state, bounce, &hits[i], pass->surface_offset, &path))
            continue;
        sources[alive] = source_of(&path, &hits[i], bounce);
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
    for (uint32_t bounce = 1; n > 0 && result == PS_OK; bounce++) {
        if (state->bounces && bounce > (uint32_t)state->bounces)
            break;
        n = bounce_paths(state, host, pass, bounce, paths, n, sources);
        result = sink->append(sink->core, sources, n);
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
