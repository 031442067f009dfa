/* irradiance_cache.c: irradiance is computed at few points, and interpolated between them.
 *
 * Ward, Rubinstein and Clear 1988: indirect irradiance changes slowly over most surfaces. Records
 * of it, each from some hundred rays, know how it changes around them by translation and rotation
 * (Ward and Heckbert 1992), and how fast that change itself changes, from which follows how far
 * they reach (Jarosz et al. 2012; Schwarzhaupt et al. 2012; irradiance_cache/record.h). A pixel
 * takes a mean of those that reach it.
 *
 * Where records go must not depend on threads. An overture asks for pixels at ever smaller
 * spacings, from 64 down to 1: those of one spacing that no record covers get one each, all at
 * once. Only then are pixels interpolated.
 *
 * Rays are paths to their ends, as path tracing has them (shared/paths.h), so that the mean is
 * right but for interpolation; light that comes from lamps by mirrors, glass and gloss alone,
 * caustics, changes fast: photons bring it, which are splatted onto the pixels.
 */
#include "irradiance_cache/cache.h"
#include "shared/caustics.h"

#define COARSEST 64u         /* pixels between candidates of the first round */
#define FEWEST_PIXELS 2.0f   /* least radius */
#define MOST_OF_HEIGHT 0.15f /* largest radius, of the picture's height */
#define BATCH 16u            /* records for each thread, between reports of progress */
#define CACHE_SHARE 0.9      /* of the time goes into records */

struct state {
    int64_t samples;
    double spacing;
    int64_t roulette;
};

struct work {
    const ps_host *host;
    const ps_pass *pass;
    struct record_setting setting;
    float pixel_angle; /* a pixel's footprint at distance 1; by parallel projection at any */
    bool parallel;
    struct irradiance_cache cache; /* owned, as what follows */
    struct record_room *rooms;
    uint8_t *wanted; /* of the candidates of a round, row by row */
};

/* --- the overture --- */

/* Candidates of a round: pixels at the same distance from each other. */
struct overture_round {
    struct work *work;
    uint32_t spacing, first_x, first_y, across, down;
    size_t first_record; /* of the batch under way */
};

/* A pixel that some surface shows in. */
static const ps_tile *candidate(const struct overture_round *round, uint32_t column, uint32_t row,
                                uint32_t *lane)
{
    const ps_host *host = round->work->host;
    uint32_t tile_index;
    if (!host->tile_of(host, round->first_x + column * round->spacing,
                       round->first_y + row * round->spacing, &tile_index, lane))
        return NULL;
    const ps_tile *tile = host->tile(host, tile_index);
    return tile->object[*lane] == PS_NO_OBJECT ? NULL : tile;
}

static void look_at_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct overture_round *round = user;
    struct work *work = round->work;
    for (uint32_t column = 0; column < round->across; column++) {
        uint32_t lane;
        const ps_tile *tile = candidate(round, column, (uint32_t)row, &lane);
        work->wanted[row * round->across + column] =
            tile &&
            !cache_covers(&work->cache, ps_tile_position(tile, lane), ps_tile_normal(tile, lane));
    }
}

static void place_record(const struct work *work, const ps_tile *tile, uint32_t lane,
                         struct record *record)
{
    record->position = ps_tile_position(tile, lane);
    record->normal = ps_tile_normal(tile, lane);
    record->footprint = work->pixel_angle * (work->parallel ? 1.0f : tile->depth[lane]);
}

/* Records of the candidates that want one, in their order. */
static ps_result place_records(const struct overture_round *round, size_t *n)
{
    struct work *work = round->work;
    size_t candidates = (size_t)round->across * round->down;
    *n = 0;
    for (size_t i = 0; i < candidates; i++)
        *n += work->wanted[i];
    if (*n == 0)
        return PS_OK;
    struct record *record = cache_add(&work->cache, *n);
    if (!record)
        return PS_ERROR_MEMORY;
    for (size_t i = 0; i < candidates; i++) {
        uint32_t lane;
        if (!work->wanted[i])
            continue;
        const ps_tile *tile =
            candidate(round, (uint32_t)(i % round->across), (uint32_t)(i / round->across), &lane);
        place_record(work, tile, lane, record++);
    }
    return PS_OK;
}

static void make_record(void *user, uint64_t index, uint32_t worker)
{
    const struct overture_round *round = user;
    const struct work *work = round->work;
    size_t number = round->first_record + index;
    uint64_t first_sample = ((uint64_t)work->pass->number << 44) + ((uint64_t)number << 17);
    record_make(&work->setting, &work->rooms[worker], first_sample, &work->cache.records[number]);
}

/* Makes the last n records; `done` and `share`: progress before, and by all of them. */
static ps_result make_records(struct overture_round *round, size_t n, double done, double share)
{
    const struct work *work = round->work;
    const ps_host *host = work->host;
    size_t batch = (size_t)BATCH * work->pass->thread_count, first = work->cache.count - n;
    for (size_t made = 0; made < n; made += batch) {
        size_t left = n - made, count = left < batch ? left : batch;
        round->first_record = first + made;
        host->parallel_for(host, count, make_record, round);
        if (host->cancelled(host))
            return PS_CANCELLED;
        host->progress(host, done + share * (double)(made + count) / (double)n);
    }
    return PS_OK;
}

/* Of each pass other pixels are asked first: R2 sequence (Roberts 2018), a generalization of the
 * golden ratio. */
static uint32_t first_pixel(uint32_t spacing, uint32_t pass, double ratio)
{
    double place = 0.5 + pass * ratio;
    return (uint32_t)((place - floor(place)) * spacing);
}

static ps_result take_round(struct work *work, uint32_t spacing, double done, double share)
{
    const ps_host *host = work->host;
    const ps_pass *pass = work->pass;
    struct overture_round round = {
        .work = work,
        .spacing = spacing,
        .first_x = first_pixel(spacing, pass->number, 0.7548776662),
        .first_y = first_pixel(spacing, pass->number, 0.5698402910),
    };
    if (round.first_x >= pass->width || round.first_y >= pass->height)
        return PS_OK;
    round.across = (pass->width - round.first_x + spacing - 1) / spacing;
    round.down = (pass->height - round.first_y + spacing - 1) / spacing;
    host->parallel_for(host, round.down, look_at_row, &round);
    size_t n;
    ps_result result = place_records(&round, &n);
    if (result == PS_OK && n > 0)
        result = make_records(&round, n, done, share);
    return result == PS_OK && n > 0 ? cache_update(&work->cache, n) : result;
}

static ps_result fill_cache(struct work *work)
{
    const ps_host *host = work->host;
    const ps_pass *pass = work->pass;
    double rounds = log2(COARSEST) + 1.0, done = 0.0;
    work->rooms = record_rooms_create(&work->setting);
    work->wanted = host->allocate(host, (size_t)pass->width * pass->height, "overture");
    ps_result result = work->rooms && work->wanted ? PS_OK : PS_ERROR_MEMORY;
    for (uint32_t spacing = COARSEST; result == PS_OK && spacing > 0; spacing /= 2) {
        result = take_round(work, spacing, done, 1.0 / rounds);
        done += 1.0 / rounds;
    }
    return result;
}

/* --- the picture --- */

static void interpolate_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    ps_tile *tile = work->host->tile(work->host, (uint32_t)index);
    ps_points points;
    ps_collect_points(tile, &points);
    for (size_t i = 0; i < points.count; i++) {
        ps_rgb irradiance;
        if (cache_interpolate(&work->cache, points.positions[i], points.normals[i], &irradiance))
            ps_add_irradiance(tile, points.lanes[i], irradiance);
    }
}

/* --- the strategy --- */

/* Strata about as wide as they are high, in the middle of the hemisphere. */
static void choose_strata(const struct state *state, struct record_setting *setting)
{
    uint32_t rings = (uint32_t)lround(sqrt((double)state->samples / (double)PS_PI));
    setting->rings = rings > 2 ? rings : 2;
    uint32_t sectors = (uint32_t)state->samples / setting->rings;
    setting->sectors = sectors > 3 ? sectors : 3;
}

static void look_through_camera(struct work *work)
{
    const ps_host *host = work->host;
    ps_camera camera = {.size = sizeof camera};
    host->camera(host, &camera);
    ps_vec3 middle =
        ps_add_scaled(ps_add_scaled(camera.corner, 0.5f * (float)camera.width, camera.across),
                      0.5f * (float)camera.height, camera.down);
    work->parallel = camera.projection == PS_ORTHOGRAPHIC;
    work->pixel_angle = ps_length(camera.across) / (work->parallel ? 1.0f : ps_length(middle));
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    const struct state *state = opaque;
    struct work work = {
        .host = host,
        .pass = pass,
        .setting = {.paths = {.host = host,
                              .pass = pass,
                              .roulette = (uint32_t)state->roulette,
                              .caustics_below = pass->specular ? PATHS_ALL_CAUSTICS : 0.0f},
                    .scale = (float)(state->spacing * state->spacing) * (float)pass->height,
                    .least = FEWEST_PIXELS,
                    .most = ps_max(MOST_OF_HEIGHT * (float)pass->height, FEWEST_PIXELS)},
    };
    ps_vec3 center;
    float radius;
    host->scene_bounds(host, &center, &radius);
    work.setting.unit = radius;
    cache_begin(host, &work.cache);
    choose_strata(state, &work.setting);
    look_through_camera(&work);
    host->progress_part(host, 0.0, CACHE_SHARE);
    ps_result result = fill_cache(&work);
    host->count(host, "irradiance records", (double)work.cache.count);
    host->progress_part(host, CACHE_SHARE, 1.0);
    if (result == PS_OK)
        result = host->for_each_tile(host, interpolate_tile, &work);
    if (result == PS_OK && pass->specular)
        result = caustics_splat(host);
    host->release(host, work.wanted);
    record_rooms_release(host, work.rooms);
    cache_release(&work.cache);
    return result;
}

static const ps_param params[] = {
    PS_ROW(struct state, samples, PS_PARAM_INT, "512", 6, 1 << 16, PS_PARAM_QUALITY, NULL, "rays",
           "rays from each record, or a few less, which fill whole rings"),
    PS_NUMBER(struct state, spacing, "0.07", 0, 10, PS_PARAM_OPEN_MIN, "",
              "how far apart records are; their number falls with its square"),
    PS_ROW(struct state, roulette, PS_PARAM_INT, "3", 1, 1000, PS_PARAM_EXPERT, NULL, "bounces",
           "bounce from which on Russian roulette may end a path"),
};

static const ps_estimator_vtable vtable = {.size = sizeof vtable, .accumulate = accumulate};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "irradiance_cache",
    .version = "1.0",
    .summary = "irradiance at few points, interpolated by its gradients",
    .paper =
        "Ward et al. 1988, A ray tracing solution for diffuse interreflection; Schwarzhaupt et "
        "al. 2012, Practical Hessian-based error control for irradiance caching",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, irradiance_cache, &descriptor)
