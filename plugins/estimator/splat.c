/* splat.c: photon splatting: every source is carried to the surface it lights and splatted there.
 *
 * Hoet 2014, chapter 3. A source carries power Phi along w. With a kernel K (1/m^2) that integrates
 * to 1 over the disc across the beam, and visibility V of the bundle,
 *
 *     E(p) += Phi * K(p) * V(p) * max(0, -n.w)        irradiance, W/m^2
 *
 * The cosine belongs here since K lies across the beam; a photon map's gather, whose kernel lies in
 * the surface, has none. The driver multiplies by albedo / pi. Placing, depth maps, bins and the
 * inner loop are the core's (src/splat), shared by whatever splats.
 *
 * A kernel blurs what is smaller than itself: light that comes from nearer than a half-width, along creases
 * and under what stands close to a wall. There splats would have to be as small as the gaps, and would be so
 * noisy that they rule the error. So what lamps throw onto surfaces nearby is found by short rays from the
 * pixels (after Kollig and Keller 2006, "Illumination in the presence of weak singularities", who make up for
 * the clamped light of near virtual lights), and splats leave it out. The two parts meet at one distance, so
 * their sum has no seam and counts nothing twice. Light that other surfaces threw there is smooth, and caustics
 * are found by light paths alone: both are splatted all the way.
 */
#include <math.h>
#include <psplat/plugin.h>

#define BATCH 4096 /* splats placed at a time */

struct state {
    int64_t interleave;
    ps_number_or_choice near_rays;
};

static ps_result splat_batches(const ps_host *host, const ps_source *sources, size_t n,
                               ps_splat *splats)
{
    ps_result result = PS_OK;
    for (size_t first = 0; first < n && result == PS_OK; first += BATCH) {
        size_t count = n - first < BATCH ? n - first : BATCH;
        if (host->cancelled(host))
            return PS_CANCELLED;
        result = host->place_splats(host, sources + first, count, splats);
        if (result == PS_OK)
            result = host->splat(host, splats, count);
    }
    return result;
}

/* Interleaving pays where n pixels are little beside a splat; in small pictures, or small parts of
 * them, it blurs edges and adds noise. Subsets by powers of two share out paths most evenly. */
#define SIDE_PER_STEP 150.0f /* pixels of the picture's side for each step of n */

static uint32_t interleave_of(const struct state *state, const ps_pass *pass)
{
    if (state->interleave > 0)
        return (uint32_t)state->interleave;
    float side = PS_TILE_SIZE * sqrtf((float)pass->tile_count);
    uint32_t n = 1;
    while (2 * n <= PS_MOST_INTERLEAVE && (float)(2 * n) * SIDE_PER_STEP <= side)
        n *= 2;
    return n;
}

/* --- near light --------------------------------------------------------------------------------- */

/* Rays of each pixel that tell whether anything is near to the block that it lies in. Where none of the
 * block's sixteen pixels meet anything, less than half a percent of the light can come from nearby. */
#define SCOUTS 4

#define BLOCK 4 /* pixels along the side of a block */
#define BLOCKS (PS_TILE_PIXELS / (BLOCK * BLOCK))

/* Sets of random numbers: for directions, and for points on lamps. */
#define DIRECTION_SET 1u
#define LAMP_SET 2u

#define TILES_AT_A_TIME 256 /* until the user may stop */

struct near_work {
    const ps_host *host;
    const ps_pass *pass;
    ps_near_light near;
    double rays; /* of a pixel in the middle of a surface and those that it is averaged with */
    uint64_t first_tile; /* of those that are at work */
};

static uint32_t block_of(uint32_t lane)
{
    return lane / PS_TILE_SIZE / BLOCK * (PS_TILE_SIZE / BLOCK) + lane % PS_TILE_SIZE / BLOCK;
}

static uint64_t near_power_of_two(double number)
{
    uint64_t power = 1;
    while (sqrt(2) * (double)power < number)
        power *= 2;
    return power;
}

/* Rays of a pixel. Those of its window are averaged, n of them in the middle of a surface and c along its
 * rim, where a ray tells c pixels and not n: what noise is left in the picture is least with sqrt(n / c) times
 * as many there. A power of two, since these are spread most evenly. */
static uint64_t rays_of(const struct near_work *work, uint64_t tile, uint32_t lane)
{
    double averaged = work->near.averaged[tile * PS_TILE_PIXELS + lane];
    return near_power_of_two(work->rays / sqrt((double)work->near.window * averaged));
}

/* The samples of a tile's pixels, and where those of a pixel begin. */
struct near_samples {
    uint64_t most; /* rays of any pixel */
    uint64_t rays[PS_TILE_PIXELS], first[PS_TILE_PIXELS];
};

/* The sixteen pixels of a block share one run of the sequence, since what they find is averaged. */
static void share_samples(const struct near_work *work, uint64_t tile, const ps_points *points,
                          struct near_samples *samples)
{
    uint64_t most[BLOCKS] = {0};
    uint64_t before = work->pass->number * BLOCK * BLOCK * near_power_of_two(work->rays);
    samples->most = 0;
    for (size_t i = 0; i < points->count; i++) {
        uint32_t lane = points->lanes[i];
        uint64_t rays = samples->rays[lane] = rays_of(work, tile, lane);
        most[block_of(lane)] = rays > most[block_of(lane)] ? rays : most[block_of(lane)];
        samples->most = rays > samples->most ? rays : samples->most;
    }
    for (size_t i = 0; i < points->count; i++) {
        uint32_t lane = points->lanes[i], block = block_of(lane);
        uint64_t place = lane / PS_TILE_SIZE % BLOCK * BLOCK + lane % BLOCK;
        samples->first[lane] = ps_sample_block(tile, block) + before + place * most[block];
    }
}

/* Shoots one ray from each point, and moves what they meet to the front; returns how many. targets[i]: the
 * point of hit i. */
static size_t look(const struct near_work *work, const ps_points *points, const uint64_t *indices,
                   ps_ray *rays, ps_hit *hits, uint32_t *targets)
{
    float numbers[PS_TILE_PIXELS][4];
    size_t met = 0;
    work->host->samples(work->host, PS_STREAM_PATH, DIRECTION_SET, indices, points->count, numbers);
    for (uint32_t i = 0; i < points->count; i++) {
        ps_vec3 normal = points->normals[i];
        rays[i] = ps_leave_surface(points->positions[i], normal,
                                   ps_cosine_direction(normal, numbers[i][0], numbers[i][1]),
                                   work->pass->surface_offset);
        rays[i].tfar = work->near.distance;
        targets[i] = i;
    }
    work->host->intersect(work->host, rays, points->count, hits);
    ps_forget_own_surface(points, targets, points->count, work->pass->surface_offset, hits);
    for (uint32_t i = 0; i < points->count; i++) {
        if (!(hits[i].distance < INFINITY))
            continue;
        targets[met] = i;
        rays[met] = rays[i];
        hits[met] = hits[i];
        hits[met++].flags &= ~PS_HIT_SPECULAR; /* gloss is splatted */
    }
    return met;
}

/* Adds what one ray of each point finds; near[block] becomes 1 where it meets something. With directions
 * drawn by the cosine, a ray's irradiance is pi times the radiance that it finds. */
static void gather(const struct near_work *work, const struct near_samples *samples,
                   const ps_points *points, uint64_t sample, ps_rgb *irradiance, uint8_t *near)
{
    ps_ray rays[PS_TILE_PIXELS];
    ps_hit hits[PS_TILE_PIXELS];
    ps_rgb radiance[PS_TILE_PIXELS];
    uint64_t indices[PS_TILE_PIXELS];
    uint32_t targets[PS_TILE_PIXELS];
    for (size_t i = 0; i < points->count; i++)
        indices[i] = samples->first[points->lanes[i]] + sample;
    size_t met = look(work, points, indices, rays, hits, targets);
    for (size_t i = 0; i < met; i++)
        indices[i] = indices[targets[i]]; /* targets[i] >= i */
    work->host->direct_radiance(work->host, rays, hits, PS_STREAM_PATH, LAMP_SET, indices, met,
                                radiance);
    for (size_t i = 0; i < met; i++) {
        uint32_t lane = points->lanes[targets[i]];
        ps_rgb found = ps_rgb_scale(radiance[i], PS_PI / (float)samples->rays[lane]);
        irradiance[lane] = ps_rgb_add(irradiance[lane], found);
        near[block_of(lane)] = 1;
    }
}

/* Keeps the points that shoot ray `sample`: of those whose scouts are back, the ones of blocks that something
 * is near to. */
static void keep_looking(const struct near_samples *samples, uint64_t sample, const uint8_t *near,
                         ps_points *points)
{
    size_t kept = 0;
    for (size_t i = 0; i < points->count; i++) {
        uint32_t lane = points->lanes[i];
        if (sample >= samples->rays[lane] || (sample >= SCOUTS && !near[block_of(lane)]))
            continue;
        points->positions[kept] = points->positions[i];
        points->normals[kept] = points->normals[i];
        points->lanes[kept++] = lane;
    }
    points->count = kept;
}

static void gather_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct near_work *work = user;
    const ps_host *host = work->host;
    uint64_t tile = work->first_tile + index;
    ps_points points;
    struct near_samples samples;
    uint8_t near[BLOCKS] = {0};
    ps_rgb irradiance[PS_TILE_PIXELS] = {{0, 0, 0}};
    ps_collect_points(host->tile(host, (uint32_t)tile), &points);
    share_samples(work, tile, &points, &samples);
    for (uint64_t sample = 0; sample < samples.most && points.count > 0; sample++) {
        keep_looking(&samples, sample, near, &points);
        gather(work, &samples, &points, sample, irradiance, near);
    }
    host->set_near_light(host, (uint32_t)tile, irradiance);
}

/* Gathers the light that splats leave. */
static ps_result gather_near(const ps_host *host, const ps_pass *pass, const ps_near_light *near,
                             double rays)
{
    struct near_work work = {host, pass, *near, rays, 0};
    for (; work.first_tile < pass->tile_count; work.first_tile += TILES_AT_A_TIME) {
        uint64_t left = pass->tile_count - work.first_tile;
        if (host->cancelled(host))
            return PS_CANCELLED;
        host->parallel_for(host, left < TILES_AT_A_TIME ? left : TILES_AT_A_TIME, gather_tile,
                           &work);
    }
    return PS_OK;
}

/* --- the plugin --------------------------------------------------------------------------------- */

static ps_result splat_all(const ps_host *host, ps_splat *splats)
{
    const ps_source *sources;
    size_t n = 1;
    double progress;
    ps_result result = PS_OK;
    while (result == PS_OK && n > 0) {
        result = host->next_sources(host, &sources, &n, &progress);
        if (result == PS_OK)
            result = splat_batches(host, sources, n, splats);
        host->progress(host, progress);
    }
    return result;
}

static ps_result accumulate(const void *opaque, const ps_host *host, const ps_pass *pass)
{
    const struct state *state = opaque;
    uint32_t interleave = interleave_of(state, pass);
    int automatic = state->near_rays.choice >= 0;
    ps_near_light near = {.distance = 0.0f};
    ps_splat *splats = host->allocate(host, BATCH * sizeof *splats, "splats placed");
    if (!splats)
        return PS_ERROR_MEMORY;
    ps_result result = host->begin_splats(host, interleave);
    if (result == PS_OK && (automatic || state->near_rays.number > 0))
        result = host->leave_near_light(host, &near);
    if (result == PS_OK && near.distance > 0.0f)
        result = gather_near(host, pass, &near, automatic ? near.rays : state->near_rays.number);
    if (result == PS_OK)
        result = splat_all(host, splats);
    host->release(host, splats);
    return result;
}

static const char *const near_rays_choices[] = {"auto", NULL};

static const ps_param params[] = {
    PS_INT(struct state, interleave, "0", 0, PS_MOST_INTERLEAVE, "pixels",
           "n: a splat lights every n-th pixel across and down, and neighbours are averaged; 0: by "
           "the picture's size, at most 4"),
    PS_NUMBER_OR(
        struct state, near_rays, "auto", 0, 65536, 0, near_rays_choices, "rays",
        "short rays, of each pixel and those that it is averaged with, for light from nearer "
        "than a half-width, which splats would blur; 0: it is splatted, too; auto: by the "
        "number of light paths"),
};

static const ps_estimator_vtable vtable = {
    .size = sizeof vtable,
    .shares_places = 1,
    .accumulate = accumulate,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "splat",
    .version = "1.0",
    .summary = "photon splatting: bundled light rays with small shadow maps",
    .paper = "Hoet 2014, Indirect illumination using photon splatting",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, splat, &descriptor)
