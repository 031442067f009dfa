/* photon.c: photons by photon tracing.
 *
 * Light paths start at the lights with a share Phi / N of their power. At every surface a path
 * leaves a photon in a direction that the surface scatters to, with the power that it scatters (at
 * a diffuse one, power * albedo), and goes on along that very direction: the photon's bundled ray
 * is the path's next segment. So the first bounce needs no special case, and one bounce is the
 * thesis's single one. Photons on mirrors and glass make caustics; these surfaces do not count as
 * bounces. Russian roulette (Arvo and Kirk 1990) ends paths at diffuse surfaces with the albedo's
 * complement and divides the survivors' power, which keeps the mean.
 *
 * Emission and first direction share one four-dimensional Sobol point: low discrepancy over (light
 * direction, bounce direction) together.
 *
 * Splitting (Arvo and Kirk 1990): `split` light paths in a row share a walk. At every diffuse
 * surface it leaves a photon for each of them, into directions of a lattice that the walk's own
 * numbers shift, and goes on along the first. A pixel sees splats that come from all over, few of
 * them from one place, so their noise is nearly that of as many walks; but the walk is traced, and
 * the walls around the place are looked for, once for all. Each path keeps its own share Phi / N,
 * so the mean is the same whatever `split` is.
 *
 * Caustics are seen directly, where other photons' blotches are averaged over many of them, and few
 * paths make them; so they have walks of their own, as in Jensen 1996: `caustics` for each path,
 * which end at their first diffuse surface.
 */
#include <psplat/plugin.h>
#include <stdbool.h>
#include <string.h>

struct state {
    int64_t count;
    int64_t roulette;
    ps_number_or_choice split;
    int64_t caustics;
};

#define MOST_SPLIT 64
#define CAUSTIC_SETS 0x10000u /* of random numbers: from here on those of walks for caustics */

/* What the light paths [path, path + count) share. */
struct walk {
    ps_ray ray;
    ps_rgb power;   /* of each path */
    uint64_t index; /* over all passes, as are those of paths */
    uint64_t path;
    uint32_t count;
    uint32_t skipped; /* paths of this walk that came before, and are left out */
    float numbers[4]; /* for the next surface: two for the direction, roulette, choice of lobe */
    uint32_t bounces; /* diffuse surfaces met */
    uint32_t chain;   /* others since the last one */
    uint8_t specular; /* ps_gloss */
    uint8_t caustic;  /* 1: it ends at the first diffuse surface */
};

/* A walk that an earlier run began sends out its own direction besides those of its paths. */
#define MOST_DIRECTIONS (PS_PATH_CHUNK + 1)

/* All directions that walks send light to where they arrived, those of each walk in a row. */
struct fan {
    ps_ray rays[MOST_DIRECTIONS]; /* by which the walks came */
    ps_hit hits[MOST_DIRECTIONS];
    float numbers[MOST_DIRECTIONS][4];
    ps_bsdf_sample scattered[MOST_DIRECTIONS];
    size_t count;
    size_t first[PS_PATH_CHUNK]; /* of each walk: that in which it goes on */
};

static uint64_t path_count(const void *state)
{
    return (uint64_t)((const struct state *)state)->count;
}

/* Where there is more than one bounce. Light of a single bounce gains more from the even spread of
 * separate walks than they cost. */
#define AUTOMATIC_SPLIT 4

static uint32_t split_of(const struct state *state, const ps_pass *pass)
{
    if (state->split.choice < 0)
        return (uint32_t)state->split.number;
    return !pass->shares_places || pass->specular || pass->bounces == 1 ? 1 : AUTOMATIC_SPLIT;
}

/* The walks of the paths [first, first + n) of the pass; returns how many. */
static size_t share_out(const struct state *state, const ps_pass *pass, uint64_t first, size_t n,
                        struct walk *walks)
{
    uint32_t split = split_of(state, pass);
    uint64_t count = (uint64_t)state->count, end = first + n;
    uint64_t walks_before = pass->number * ((count + split - 1) / split);
    size_t shared = 0;
    for (uint64_t path = first, next; path < end; path = next) {
        next = (path / split + 1) * split;
        next = next < end ? next : end;
        walks[shared++] = (struct walk){
            .index = walks_before + path / split,
            .path = pass->number * count + path,
            .count = (uint32_t)(next - path),
            .skipped = (uint32_t)(path % split),
        };
    }
    return shared;
}

/* Walks of n paths that share theirs with no others, for caustics alone; `round` numbers those of
 * each path. */
static void share_out_caustics(const struct state *state, const ps_pass *pass, uint64_t first,
                               size_t n, uint64_t round, struct walk *walks)
{
    uint64_t rounds = (uint64_t)state->caustics;
    for (size_t i = 0; i < n; i++) {
        uint64_t path = pass->number * (uint64_t)state->count + first + i;
        walks[i] =
            (struct walk){.index = path * rounds + round, .path = path, .count = 1, .caustic = 1};
    }
}

/* `set`: the first of their random numbers. */
static void start_walks(const struct state *state, const ps_host *host, uint32_t set,
                        struct walk *walks, size_t n)
{
    uint64_t indices[PS_PATH_CHUNK] = {0};
    float shared[PS_PATH_CHUNK][4], other[PS_PATH_CHUNK][4], emission[PS_PATH_CHUNK][4];
    ps_ray rays[PS_PATH_CHUNK];
    ps_rgb power[PS_PATH_CHUNK];
    for (size_t i = 0; i < n; i++)
        indices[i] = walks[i].index;
    host->samples(host, PS_STREAM_EMISSION, set, indices, n, shared);
    host->samples(host, PS_STREAM_EMISSION, set + 1, indices, n, other);
    for (size_t i = 0; i < n; i++) {
        emission[i][0] = shared[i][0];
        emission[i][1] = shared[i][1];
        emission[i][2] = other[i][0];
        emission[i][3] = other[i][1];
    }
    host->emit_light(host, (const float(*)[4])emission, n, rays, power);
    for (size_t i = 0; i < n; i++) {
        const float numbers[4] = {shared[i][2], shared[i][3], other[i][2], other[i][3]};
        walks[i].ray = rays[i];
        int64_t walks_in_all = walks[i].caustic ? state->count * state->caustics : state->count;
        walks[i].power = ps_rgb_scale(power[i], 1.0f / (float)walks_in_all);
        memcpy(walks[i].numbers, numbers, sizeof numbers);
    }
}

/* Random numbers of that set for the surfaces that the walks will meet. */
static void draw_surface(const ps_host *host, uint32_t set, struct walk *walks, size_t n)
{
    uint64_t indices[PS_PATH_CHUNK] = {0};
    float points[PS_PATH_CHUNK][4];
    for (size_t i = 0; i < n; i++)
        indices[i] = walks[i].index;
    host->samples(host, PS_STREAM_BOUNCE, set, indices, n, points);
    for (size_t i = 0; i < n; i++)
        memcpy(walks[i].numbers, points[i], sizeof points[i]);
}

/* The largest weight, of any colour, that a walk has in any of its directions. */
static float largest_weight(const struct fan *fan, size_t walk, size_t walks)
{
    size_t end = walk + 1 < walks ? fan->first[walk + 1] : fan->count;
    float largest = 0.0f;
    for (size_t i = fan->first[walk]; i < end; i++)
        largest = ps_max(largest, ps_rgb_maximum(fan->scattered[i].weight));
    return largest;
}

/* Whether a walk leaves photons at a surface that scatters like this in the direction in which the
 * walk goes on, and has such a weight at most in any. `arriving` is then the power with which it
 * came, but for roulette. */
static int leaves_photons(const struct state *state, const ps_pass *pass, const ps_hit *hit,
                          const ps_bsdf_sample *scattered, float weight, struct walk *walk,
                          ps_rgb *arriving)
{
    *arriving = walk->power;
    if (!(weight > 0.0f && ps_rgb_maximum(walk->power) > 0.0f))
        return 0;
    if (scattered->lobe != PS_DIFFUSE) {
        walk->specular = ps_gloss_after(walk->specular, hit->roughness);
        return ++walk->chain <= PS_LONGEST_CHAIN;
    }
    if (walk->caustic)
        return 0;
    walk->chain = 0;
    walk->bounces++;
    if (walk->bounces > pass->bounces)
        return 0;
    return walk->bounces < (uint32_t)state->roulette ||
           ps_russian_roulette(weight, walk->numbers[2], arriving);
}

/* Traces the walks, all for caustics or none, and keeps those that meet something, moved to the
 * front with their hits: for caustics, something that is not diffuse alone. */
static size_t trace_walks(const ps_host *host, struct walk *walks, size_t n, ps_ray *rays,
                          ps_hit *hits)
{
    for (size_t i = 0; i < n; i++)
        rays[i] = walks[i].ray;
    size_t kept[PS_PATH_CHUNK];
    if (walks[0].caustic)
        host->intersect_specular(host, rays, n, hits);
    else
        host->intersect(host, rays, n, hits);
    size_t met = ps_keep_hits(rays, n, hits, kept);
    for (size_t i = 0; i < met; i++)
        walks[i] = walks[kept[i]];
    return met;
}

/* The numbers of a walk for its direction `number`, moved by that point of the (0, 2)-sequence of
 * Sobol: digit by digit, so that they stay as evenly spread. */
static void move_numbers(uint32_t number, float numbers[4])
{
    uint32_t x = 0, y = 0, column = 1u << 31;
    for (uint32_t bit = 0; number >> bit; bit++, column ^= column >> 1)
        if (number >> bit & 1) {
            x ^= 1u << (31 - bit);
            y ^= column;
        }
    numbers[0] = (float)((uint32_t)(numbers[0] * 0x1p24f) ^ x >> 8) * 0x1p-24f;
    numbers[1] = (float)((uint32_t)(numbers[1] * 0x1p24f) ^ y >> 8) * 0x1p-24f;
}

/* One more direction of a walk. */
static void add_direction(struct fan *fan, const struct walk *walk, const ps_ray *ray,
                          const ps_hit *hit, uint32_t number)
{
    float *numbers = fan->numbers[fan->count];
    memcpy(numbers, walk->numbers, sizeof walk->numbers);
    move_numbers(number, numbers);
    fan->rays[fan->count] = *ray;
    fan->hits[fan->count++] = *hit;
}

static void fan_out(const ps_host *host, const struct walk *walks, const ps_ray *rays,
                    const ps_hit *hits, size_t n, struct fan *fan)
{
    fan->count = 0;
    for (size_t i = 0; i < n; i++) {
        const struct walk *walk = &walks[i];
        fan->first[i] = fan->count;
        if (walk->skipped > 0)
            add_direction(fan, walk, &rays[i], &hits[i], 0);
        for (uint32_t path = 0; path < walk->count; path++)
            add_direction(fan, walk, &rays[i], &hits[i], walk->skipped + path);
    }
    host->sample_bsdf(host, PS_FROM_LIGHT, fan->rays, fan->hits, (const float(*)[4])fan->numbers,
                      fan->count, fan->scattered);
}

static ps_photon photon_of(const struct walk *walk, const ps_hit *hit,
                           const ps_bsdf_sample *scattered, ps_rgb arriving)
{
    return (ps_photon){
        .position = hit->position,
        .normal = scattered->normal,
        .direction = scattered->direction,
        .power = ps_rgb_multiply(arriving, scattered->weight),
        .bounce = (uint16_t)walk->bounces,
        .lobe = (uint8_t)scattered->lobe,
        .specular = walk->specular,
        .merged = 1.0f,
        .path = walk->path,
    };
}

/* The photons of all paths of a walk; returns how many. A mirror sends all paths the same way: one
 * photon has the power of all. */
static size_t leave_photons(const struct walk *walk, const ps_hit *hit,
                            const ps_bsdf_sample *scattered, ps_rgb arriving, ps_photon *photons)
{
    size_t left = 0;
    if (scattered->lobe != PS_DIFFUSE) {
        if (walk->bounces == 0 && !walk->caustic)
            return 0;
        photons[left] = photon_of(walk, hit, scattered, arriving);
        photons[left].power = ps_rgb_scale(photons[left].power, (float)walk->count);
        return 1;
    }
    scattered += walk->skipped > 0;
    for (uint32_t i = 0; i < walk->count; i++) {
        photons[left] = photon_of(walk, hit, &scattered[i], arriving);
        photons[left].path += i;
        left += ps_rgb_maximum(photons[left].power) > 0.0f;
    }
    return left;
}

/* Whether a walk that left photons may leave others: past the last diffuse bounce only mirrors and
 * glass can make one. */
static int may_go_on(const ps_pass *pass, const struct walk *walk)
{
    return ps_rgb_maximum(walk->power) > 0.0f && (pass->specular || walk->bounces < pass->bounces);
}

/* Carries all walks to their next surface, where they leave `count` photons; returns how many go
 * on, moved to the front. */
static size_t extend_walks(const struct state *state, const ps_host *host, const ps_pass *pass,
                           struct walk *walks, size_t n, ps_photon *photons, size_t *count)
{
    ps_ray rays[PS_PATH_CHUNK];
    ps_hit hits[PS_PATH_CHUNK];
    struct fan fan;
    n = trace_walks(host, walks, n, rays, hits);
    fan_out(host, walks, rays, hits, n, &fan);
    size_t alive = 0;
    *count = 0;
    for (size_t i = 0; i < n; i++) {
        struct walk walk = walks[i];
        const ps_bsdf_sample *scattered = &fan.scattered[fan.first[i]];
        ps_rgb arriving;
        float weight = largest_weight(&fan, i, n);
        if (!leaves_photons(state, pass, &hits[i], scattered, weight, &walk, &arriving))
            continue;
        *count += leave_photons(&walk, &hits[i], scattered, arriving, photons + *count);
        walk.power = ps_rgb_multiply(arriving, scattered->weight);
        walk.ray = ps_leave_surface(hits[i].position, scattered->normal, scattered->direction,
                                    pass->surface_offset);
        if (may_go_on(pass, &walk))
            walks[alive++] = walk;
    }
    return alive;
}

static ps_result trace_all(const struct state *state, const ps_host *host, const ps_pass *pass,
                           uint32_t set, struct walk *walks, size_t n, const ps_photon_sink *sink)
{
    ps_photon photons[PS_PATH_CHUNK];
    ps_result result = PS_OK;
    start_walks(state, host, set, walks, n);
    for (uint32_t segment = 0; n > 0 && result == PS_OK; segment++) {
        size_t count;
        n = extend_walks(state, host, pass, walks, n, photons, &count);
        draw_surface(host, set + segment + 2, walks, n);
        result = sink->append(sink->core, photons, count);
    }
    return result;
}

static ps_result emit(const void *opaque, const ps_host *host, const ps_pass *pass, uint64_t first,
                      size_t n, const ps_photon_sink *sink)
{
    const struct state *state = opaque;
    uint64_t rounds = pass->specular ? (uint64_t)state->caustics : 0;
    struct walk walks[PS_PATH_CHUNK];
    size_t shared = share_out(state, pass, first, n, walks);
    ps_result result = trace_all(state, host, pass, 0, walks, shared, sink);
    for (uint64_t round = 0; round < rounds && result == PS_OK; round++) {
        share_out_caustics(state, pass, first, n, round, walks);
        result = trace_all(state, host, pass, CAUSTIC_SETS, walks, n, sink);
    }
    return result;
}

static const char *const split_choices[] = {"auto", NULL};

static const ps_param params[] = {
    PS_ROW(struct state, count, PS_PARAM_INT, "25000", 1, 2000000000, PS_PARAM_QUALITY, NULL,
           "paths", "light paths in each pass"),
    PS_ROW(struct state, roulette, PS_PARAM_INT, "2", 1, 1000, PS_PARAM_EXPERT, NULL, "bounces",
           "bounce from which on Russian roulette may end a path"),
    PS_NUMBER_OR(struct state, split, "auto", 1, MOST_SPLIT, PS_PARAM_EXPERT | PS_PARAM_WHOLE,
                 split_choices, "paths",
                 "light paths that share a walk and leave its surfaces in different directions; "
                 "auto: 4, or 1 where that is noisy"),
    PS_ROW(struct state, caustics, PS_PARAM_INT, "8", 1, 1000, PS_PARAM_EXPERT, NULL, "paths",
           "paths for caustics, for each light path, where something mirrors or refracts"),
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
    .summary = "traces light paths, which leave a photon at each diffuse surface that they meet",
    .paper = "Jensen 1996, Global illumination using photon maps; Hoet 2014, section 3.2",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(injection, photon, &descriptor)
