#include "surfels.h"
#include "../shared/paths.h"
#include "../shared/sampled_tiles.h"

#include <stdbool.h>
#include <string.h>

#define LARGEST 0.25f /* side of the table's largest cubes, in radii of the scene */

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
            surfels->materials[place] = hit->material;
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

/* Puts the values of surfels in their new order; `room` is for n values. */
static void reorder(const struct surfels *surfels, const ps_key_entry *sorted, size_t n,
                    size_t size, void *values, void *room)
{
    memcpy(room, values, n * size);
    for (size_t i = 0; i < surfels->count; i++)
        memcpy((char *)values + i * size, (char *)room + sorted[i].index * size, size);
}

/* By place, so that splats cull well, and without the rays that met nothing. */
static ps_result sort(struct surfels *surfels, size_t n)
{
    const ps_host *host = surfels->host;
    const ps_cells *cells = surfels->extension;
    ps_key_entry *entries = host->allocate(host, 2 * n * sizeof *entries, "surfels sorted");
    void *room = host->allocate(host, n * sizeof(ps_vec3), "surfels sorted");
    if (entries && room) {
        ps_lattice lattice = cells->lattice(host, surfels->origin, (double)surfels->largest / 512);
        for (size_t i = 0; i < n; i++) {
            if (!(surfels->lengths[i] > 0.0f))
                continue;
            uint64_t key =
                cells->key(&lattice, surfel_facing(surfels->normals[i]), surfels->positions[i]);
            entries[surfels->count++] = (ps_key_entry){key, i};
        }
        const ps_key_entry *sorted = cells->sort(entries, entries + n, surfels->count);
        reorder(surfels, sorted, n, sizeof(ps_vec3), surfels->positions, room);
        reorder(surfels, sorted, n, sizeof(ps_vec3), surfels->normals, room);
        reorder(surfels, sorted, n, sizeof(uint32_t), surfels->materials, room);
        reorder(surfels, sorted, n, sizeof(float), surfels->lengths, room);
    }
    bool failed = !entries || !room;
    host->release(host, entries);
    host->release(host, room);
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
    surfels->materials = host->allocate(host, n * sizeof(uint32_t), "surfels");
    surfels->lengths = host->allocate(host, n * sizeof(float), "surfels");
    surfels->irradiance = host->allocate(host, n * sizeof(ps_rgb), "surfels");
    if (!surfels->positions || !surfels->normals || !surfels->materials || !surfels->lengths ||
        !surfels->irradiance)
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
    host->release(host, surfels->materials);
    host->release(host, surfels->lengths);
    host->release(host, surfels->irradiance);
    host->release(host, surfels->sky);
    host->release(host, surfels->cells);
    *surfels = (struct surfels){.host = host};
}
