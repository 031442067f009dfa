#include "surfels.h"
#include "../shared/paths.h"
#include "../shared/sampled_tiles.h"

#include <stdbool.h>
#include <string.h>

#define LARGEST 0.25f   /* side of the table's largest cubes, in radii of the scene */
#define GROUPS_AROUND 4 /* to each side, in the order of surfels */

/* --- finding --- */

struct finding {
    struct surfels *surfels;
    const ps_pass *pass;
    uint32_t rays;
    uint32_t *places; /* of the tiles' rays, in tiles; or NO_PLACE */
};

#define NO_PLACE UINT32_MAX

/* One ray from each of some points of a tile, chosen by lot. */
static void start_rays(const struct finding *work, const ps_points *points, const uint64_t *indices,
                       ps_points *chosen, struct paths *paths, struct paths_segment *segment)
{
    const ps_host *host = work->surfels->host;
    host->samples(host, PS_STREAM_PLUGIN, 0, indices, work->rays, segment->numbers);
    paths->count = 0;
    chosen->count = work->rays;
    for (uint32_t i = 0; i < work->rays; i++) {
        const float *numbers = segment->numbers[i];
        size_t point = (size_t)(numbers[2] * (float)points->count);
        ps_vec3 position = points->positions[point], normal = points->normals[point];
        ps_vec3 direction = ps_cosine_direction(normal, numbers[0], numbers[1]);
        chosen->positions[i] = position;
        chosen->normals[i] = normal;
        paths_add(paths, i,
                  ps_leave_surface(position, normal, direction, work->pass->surface_offset), PS_PI);
    }
}

/* Whether rays that lie side by side still do after a surface of that roughness that scatters like
 * this: a mirror, glass or smooth gloss. */
static bool is_sharp(const ps_bsdf_sample *scattered, float roughness)
{
    return scattered->lobe == PS_SPECULAR ||
           (scattered->lobe == PS_GLOSSY && roughness < PS_ROUGH_GLOSS);
}

/* Surfels where rays are to be scattered widely; the others go on. */
static void land_rays(const struct finding *work, const struct paths_setting *setting, size_t first,
                      struct paths *paths, struct paths_segment *segment)
{
    struct surfels *surfels = work->surfels;
    ps_bsdf_sample scattered[PS_TILE_PIXELS];
    size_t alive = 0;
    setting->host->sample_bsdf(setting->host, PS_FROM_CAMERA, paths->rays, segment->hits,
                               (const float(*)[4])segment->numbers, paths->count, scattered);
    for (size_t i = 0; i < paths->count; i++) {
        const ps_hit *hit = &segment->hits[i];
        size_t place = first + paths->pixels[i];
        if (is_sharp(&scattered[i], hit->roughness)) {
            if (paths_scatter(setting, &scattered[i], segment, paths, i))
                paths_move(paths, i, alive++);
        } else if (ps_rgb_maximum(hit->albedo) > 0.0f) {
            surfels->positions[place] = hit->position;
            surfels->normals[place] = hit->normal;
            surfels->lengths[place] =
                surfel_length(paths->lengths[i] + hit->distance, paths->lengths[i] > 0.0f);
        }
    }
    paths->count = alive;
}

/* Surfels where rays from a tile land, some of them by way of mirrors, glass and smooth gloss.
 * Lengths of 0 are no surfels. */
static void find_in_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct finding *work = user;
    struct surfels *surfels = work->surfels;
    const ps_host *host = surfels->host;
    if (work->places[index] == NO_PLACE)
        return;
    const struct paths_setting setting = {.host = host, .pass = work->pass};
    size_t first = (size_t)work->places[index] * work->rays;
    ps_tile tile;
    ps_points points, chosen;
    uint64_t indices[PS_TILE_PIXELS];
    struct paths paths;
    struct paths_segment segment;
    memset(surfels->lengths + first, 0, work->rays * sizeof *surfels->lengths);
    host->tile_surfaces(host, (uint32_t)index, sizeof tile, &tile);
    ps_collect_points(&tile, &points);
    if (points.count == 0)
        return;
    for (uint32_t i = 0; i < work->rays; i++)
        indices[i] = (index << 32) + (uint64_t)work->pass->number * work->rays + i;
    start_rays(work, &points, indices, &chosen, &paths, &segment);
    for (uint32_t number = 1; paths.count > 0; number++) {
        paths_intersect(&setting, &chosen, number, &paths, &segment);
        paths_drop_lost(&paths, &segment);
        paths_find_indices(indices, &paths, &segment);
        host->samples(host, PS_STREAM_PLUGIN, number, segment.indices, paths.count,
                      segment.numbers);
        land_rays(work, &setting, first, &paths, &segment);
    }
}

/* By place, so that splats cull well, and without the rays that met nothing. */
static ps_result sort(struct surfels *surfels, size_t n)
{
    const ps_host *host = surfels->host;
    const ps_cells *cells = surfels->extension;
    ps_key_entry *entries = host->allocate(host, 2 * n * sizeof *entries, "surfels sorted");
    ps_vec3 *copies = host->allocate(host, 2 * n * sizeof *copies, "surfels sorted");
    float *lengths = host->allocate(host, n * sizeof *lengths, "surfels sorted");
    if (entries && copies && lengths) {
        ps_lattice lattice = cells->lattice(host, surfels->origin, (double)surfels->largest / 512);
        for (size_t i = 0; i < n; i++) {
            if (!(surfels->lengths[i] > 0.0f))
                continue;
            uint64_t key =
                cells->key(&lattice, surfel_facing(surfels->normals[i]), surfels->positions[i]);
            entries[surfels->count++] = (ps_key_entry){key, i};
        }
        memcpy(copies, surfels->positions, n * sizeof *copies);
        memcpy(copies + n, surfels->normals, n * sizeof *copies);
        memcpy(lengths, surfels->lengths, n * sizeof *lengths);
        const ps_key_entry *sorted = cells->sort(entries, entries + n, surfels->count);
        for (size_t i = 0; i < surfels->count; i++) {
            surfels->positions[i] = copies[sorted[i].index];
            surfels->normals[i] = copies[n + sorted[i].index];
            surfels->lengths[i] = lengths[sorted[i].index];
        }
    }
    bool failed = !entries || !copies || !lengths;
    host->release(host, entries);
    host->release(host, copies);
    host->release(host, lengths);
    return failed ? PS_ERROR_MEMORY : PS_OK;
}

/* Gives places to the tiles whose rays find surfels; returns how many. */
static size_t choose_tiles(const struct finding *work)
{
    uint32_t tiles = work->pass->tile_count, chosen = 0;
    for (uint32_t i = 0; i < tiles; i++)
        work->places[i] =
            tile_is_sampled(i, tiles, MOST_SURFELS / work->rays) ? chosen++ : NO_PLACE;
    return chosen;
}

static ps_result find(struct finding *work)
{
    struct surfels *surfels = work->surfels;
    const ps_host *host = surfels->host;
    size_t n = choose_tiles(work) * work->rays;
    surfels->positions = host->allocate(host, n * sizeof(ps_vec3), "surfels");
    surfels->normals = host->allocate(host, n * sizeof(ps_vec3), "surfels");
    surfels->lengths = host->allocate(host, n * sizeof(float), "surfels");
    surfels->irradiance = host->allocate(host, n * sizeof(ps_rgb), "surfels");
    if (!surfels->positions || !surfels->normals || !surfels->lengths || !surfels->irradiance)
        return PS_ERROR_MEMORY;
    memset(surfels->irradiance, 0, n * sizeof *surfels->irradiance);
    ps_result result = host->for_each_picture_tile(host, find_in_tile, work);
    return result == PS_OK ? sort(surfels, n) : result;
}

ps_result surfels_find(const ps_host *host, const ps_pass *pass, uint32_t rays,
                       struct surfels *surfels)
{
    float radius;
    ps_vec3 center;
    host->scene_bounds(host, &center, &radius);
    *surfels = (struct surfels){
        .host = host,
        .extension = host->extension(host, PS_CELLS_EXTENSION),
        .origin = {center.x - 1.0371f * radius, center.y - 1.0719f * radius,
                   center.z - 1.0533f * radius},
        .largest = LARGEST * radius,
    };
    if (!surfels->extension)
        return host->fail(host, PS_ERROR_INVALID, "this psplat has no cells");
    struct finding work = {surfels, pass, rays, NULL};
    work.places = host->allocate(host, pass->tile_count * sizeof *work.places, "surfels");
    ps_result result = work.places ? find(&work) : PS_ERROR_MEMORY;
    host->release(host, work.places);
    return result;
}

void surfels_release(struct surfels *surfels)
{
    const ps_host *host = surfels->host;
    host->release(host, surfels->positions);
    host->release(host, surfels->normals);
    host->release(host, surfels->lengths);
    host->release(host, surfels->irradiance);
    host->release(host, surfels->sky);
    host->release(host, surfels->cells);
    *surfels = (struct surfels){.host = host};
}

/* --- correction --- */

static float *channel(ps_rgb *colour, int c)
{
    return c == 0 ? &colour->r : c == 1 ? &colour->g : &colour->b;
}

static double value(ps_rgb colour, int c)
{
    return (double)*channel(&colour, c);
}

/* Surfels near each other, and what their splats and paths say of one channel. */
struct group {
    ps_rgb *splatted;
    const ps_rgb *traced, *half;
    size_t n;
    /* Variance of the paths' noise, and mean square of what splats and paths differ by, over the
     * square of the mean. */
    double noise, difference;
};

static struct group group_at(const struct surfels *surfels, const ps_rgb *traced,
                             const ps_rgb *half, size_t index)
{
    struct surfel_group group = surfels_group(surfels, index);
    return (struct group){
        .splatted = surfels->irradiance + group.first,
        .traced = traced + group.first,
        .half = half + group.first,
        .n = group.n,
    };
}

/* Multiplies a group's splats by the ratio of what its paths and splats find. What no splat has
 * reached takes the mean of its paths. */
static void scale_splats(const struct group *group, int c)
{
    double by_splats = 0.0, by_paths = 0.0;
    for (size_t i = 0; i < group->n; i++) {
        by_splats += value(group->splatted[i], c);
        by_paths += value(group->traced[i], c);
    }
    bool reached = by_splats > 0.0;
    float scale = (float)(by_paths / (reached ? by_splats : (double)group->n));
    for (size_t i = 0; i < group->n; i++) {
        float *splatted = channel(&group->splatted[i], c);
        *splatted = reached ? scale * *splatted : scale;
    }
}

static void compare(struct group *group, int c)
{
    double sum = 0.0, noise = 0.0, difference = 0.0;
    for (size_t i = 0; i < group->n; i++) {
        double by_paths = value(group->traced[i], c);
        double off = value(group->half[i], c) - by_paths;
        double rest = value(group->splatted[i], c) - by_paths;
        noise += off * off;
        difference += rest * rest;
        sum += by_paths;
    }
    group->noise = sum > 0.0 ? noise / (sum * sum) : 0.0;
    group->difference = sum > 0.0 ? difference / (sum * sum) : 0.0;
}

/* The weight of splats in the mean of both, each weighted by the other's variance: what they differ
 * by, of which the paths' noise is known. From the groups around, too: a group's own estimate of
 * the noise depends on whether its paths happened to hit a light, and weights by it alone would
 * lose that light. */
static float weight_of_splats(const struct group *groups, size_t count, size_t index)
{
    size_t from = index > GROUPS_AROUND ? index - GROUPS_AROUND : 0;
    double noise = 0.0, difference = 0.0;
    for (size_t i = from; i < count && i <= index + GROUPS_AROUND; i++) {
        noise += groups[i].noise;
        difference += groups[i].difference;
    }
    return difference > noise ? (float)(noise / difference) : 1.0f;
}

static void mix(const struct group *group, float weight, int c)
{
    for (size_t i = 0; i < group->n; i++) {
        float *irradiance = channel(&group->splatted[i], c);
        float by_paths = (float)value(group->traced[i], c);
        *irradiance = weight * *irradiance + (1.0f - weight) * by_paths;
    }
}

ps_result surfels_correct(struct surfels *surfels, const ps_rgb *traced, const ps_rgb *half)
{
    const ps_host *host = surfels->host;
    size_t count = surfels_group_count(surfels);
    struct group *groups = host->allocate(host, count * sizeof *groups, "surfels");
    if (!groups)
        return PS_ERROR_MEMORY;
    for (int c = 0; c < 3; c++) {
        for (size_t i = 0; i < count; i++) {
            groups[i] = group_at(surfels, traced, half, i);
            scale_splats(&groups[i], c);
            compare(&groups[i], c);
        }
        for (size_t i = 0; i < count; i++)
            mix(&groups[i], weight_of_splats(groups, count, i), c);
    }
    host->release(host, groups);
    return PS_OK;
}
