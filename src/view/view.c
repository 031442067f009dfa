#include "view/view.h"

#include "base/sample.h"
#include "direct/direct.h"
#include <psplat/host.h>
#include <psplat/path.h>
#include <psplat/tile.h>

/* Set of the numbers that choose a point of the lens; surfaces along the path take sets 0, 1, 2,
 * ... */
#define LENS_SET 0x10000u

/* The width of a camera ray's cone over the pixel's side (scene/ray_cone.h): textures are averaged
 * over it. Finer detail is averaged by the passes, which sample other points of the pixel. */
#define CONE_SIDE 0.125f

/* Paths of a tile that are still under way. */
struct camera_paths {
    size_t count;
    uint32_t lanes[PS_TILE_PIXELS];
    ps_ray rays[PS_TILE_PIXELS];
    ps_rgb throughput[PS_TILE_PIXELS];
    float travelled[PS_TILE_PIXELS];
    float pdfs[PS_TILE_PIXELS];            /* of the last scattering; 0 from the camera */
    float spreads[PS_TILE_PIXELS];         /* of the cone that the ray stands for */
    struct stratum strata[PS_TILE_PIXELS]; /* what lobes and glass choose by */
    const uint64_t *indices;               /* of each lane's random numbers */
};

static void move_path(struct camera_paths *paths, size_t from, size_t to)
{
    paths->lanes[to] = paths->lanes[from];
    paths->rays[to] = paths->rays[from];
    paths->throughput[to] = paths->throughput[from];
    paths->travelled[to] = paths->travelled[from];
    paths->pdfs[to] = paths->pdfs[from];
    paths->spreads[to] = paths->spreads[from];
    paths->strata[to] = paths->strata[from];
}

static ps_ray camera_ray_at(const struct view_pass *pass, const struct view_points *points,
                            uint32_t lane)
{
    const struct camera *camera = &pass->lighting.scene->camera;
    float lens[4] = {0, 0, 0, 0};
    if (camera->aperture > 0.0f)
        sample_point(sample_key(pass->seed, PS_STREAM_VIEW, LENS_SET), points->indices[lane], lens);
    return camera_ray(camera, points->x[lane], points->y[lane], lens);
}

static void start(const struct view_pass *pass, const struct view_points *points, uint32_t tile,
                  struct camera_paths *paths)
{
    bool lens = pass->lighting.scene->camera.aperture > 0.0f;
    uint8_t *choice = pass->hits ? NULL : &pass->gbuffer->choice[(size_t)tile * PS_TILE_PIXELS];
    paths->count = points->count;
    paths->indices = points->indices;
    for (size_t i = 0; i < points->count; i++) {
        paths->lanes[i] = points->lanes[i];
        paths->rays[i] = camera_ray_at(pass, points, points->lanes[i]);
        paths->throughput[i] = (ps_rgb){1, 1, 1};
        paths->travelled[i] = 0.0f;
        paths->strata[i].paths = points->samples_of_pixel;
        paths->pdfs[i] = 0.0f;
        paths->spreads[i] = CONE_SIDE * camera_pixel_spread(&pass->lighting.scene->camera,
                                                            paths->rays[i].direction);
        if (choice)
            choice[points->lanes[i]] = lens ? CHOSEN_BY_LENS_OR_GLOSS : CHOSEN_BY_NOTHING;
    }
}

static void add_to_lane(const struct view_pass *pass, uint32_t tile, uint32_t lane, ps_rgb radiance)
{
    ps_rgb *emitted = &pass->gbuffer->emitted[(size_t)tile * PS_TILE_PIXELS + lane];
    *emitted = ps_rgb_add(*emitted, radiance);
}

static void collect_emission(const struct view_pass *pass, uint32_t tile, uint32_t depth,
                             const struct camera_paths *paths, const ps_hit *hits)
{
    ps_rgb radiance[PS_TILE_PIXELS];
    emitted_radiance(&pass->lighting, paths->rays, hits, paths->pdfs, paths->count, radiance);
    for (size_t i = 0; i < paths->count; i++) {
        bool hidden =
            depth == 0 && pass->lighting.scene->sky_is_hidden && !(hits[i].distance < INFINITY);
        if (!hidden)
            add_to_lane(pass, tile, paths->lanes[i],
                        ps_rgb_multiply(paths->throughput[i], radiance[i]));
    }
}

/* Path i ends at the hit. */
static void end_path(const struct view_pass *pass, uint32_t tile, const struct camera_paths *paths,
                     size_t i, const ps_hit *hit, ps_rgb throughput, float travelled)
{
    uint32_t lane = paths->lanes[i];
    if (!pass->hits) {
        gbuffer_store(&pass->gbuffer->tiles[tile], lane, hit, throughput, travelled);
        gbuffer_store_geometric_normal(pass->gbuffer, tile, lane, hit);
        if (pass->gbuffer->glossy)
            gbuffer_forget_mirror(&pass->gbuffer->glossy[tile], lane);
        return;
    }
    pass->rays[lane] = paths->rays[i];
    pass->hits[lane] = *hit;
}

/* Ends paths at purely diffuse surfaces and where nothing was met; returns how many are left, and
 * their hits moved to the front. */
static void end_at_diffuse(const struct view_pass *pass, uint32_t tile, struct camera_paths *paths,
                           ps_hit *hits)
{
    size_t left = 0;
    for (size_t i = 0; i < paths->count; i++) {
        float travelled = paths->travelled[i] + hits[i].distance;
        if (!(hits[i].distance < INFINITY))
            continue;
        if (!(hits[i].flags & PS_HIT_SPECULAR)) {
            end_path(pass, tile, paths, i, &hits[i], paths->throughput[i], travelled);
            continue;
        }
        hits[left] = hits[i];
        move_path(paths, i, left);
        paths->travelled[left++] = travelled;
    }
    paths->count = left;
}

/* What gloss reflects of the lights; the diffuse part of these surfaces is left to where paths
 * end. */
static void collect_gloss(const struct view_pass *pass, uint32_t tile, uint32_t depth,
                          const struct camera_paths *paths, const ps_hit *hits)
{
    ps_hit glossy[PS_TILE_PIXELS];
    ps_rgb radiance[PS_TILE_PIXELS];
    uint64_t indices[PS_TILE_PIXELS];
    for (size_t i = 0; i < paths->count; i++) {
        glossy[i] = hits[i];
        glossy[i].albedo = (ps_rgb){0, 0, 0};
        indices[i] = paths->indices[paths->lanes[i]];
    }
    struct light_numbers numbers = {pass->seed, PS_STREAM_LIGHT, depth + 1, indices};
    direct_radiance(&pass->lighting, paths->rays, glossy, NULL, paths->count, &numbers, radiance);
    for (size_t i = 0; i < paths->count; i++)
        add_to_lane(pass, tile, paths->lanes[i],
                    ps_rgb_multiply(paths->throughput[i], radiance[i]));
}

/* Stores the surface that stands for the pixel: the first glossy or partly diffuse one that path i
 * leaves; or a mirror (`sharp`), until the path ends at a surface. */
static void note_gloss(const struct view_pass *pass, uint32_t tile,
                       const struct camera_paths *paths, size_t i, const ps_hit *hit, bool sharp)
{
    const struct scene *scene = pass->lighting.scene;
    struct gbuffer *gbuffer = pass->gbuffer;
    uint32_t lane = paths->lanes[i];
    if (!gbuffer->glossy)
        return;
    ps_rgb reflectance = material_reflectance(&scene->materials[hit->material], scene->microfacets,
                                              hit, paths->rays[i].direction);
    float diffuse = ps_luminance(hit->albedo), all = ps_luminance(reflectance);
    float gloss = all > 0.0f ? 1.0f - diffuse / all : 1.0f;
    reflectance = ps_rgb_multiply(paths->throughput[i], reflectance);
    if (sharp)
        gbuffer_store_mirror(&gbuffer->glossy[tile], lane, hit, reflectance, paths->travelled[i]);
    else
        gbuffer_store_glossy(&gbuffer->glossy[tile], lane, hit, reflectance, gloss,
                             paths->travelled[i]);
}

/* Marks pixels whose path goes on by chance, which take several samples, most where they see glass.
 * Glass does not stand for the pixel, as gloss does: what is seen through it is sharp. */
static void note_scattering(const struct view_pass *pass, uint32_t tile,
                            const struct camera_paths *paths, size_t i, const ps_hit *hit,
                            const ps_bsdf_sample *on)
{
    bool gloss = on->probability < 1.0f || on->lobe == PS_GLOSSY;
    bool refracts = material_refracts(&pass->lighting.scene->materials[hit->material]);
    if (pass->hits)
        return;
    uint8_t *choice = &pass->gbuffer->choice[(size_t)tile * PS_TILE_PIXELS + paths->lanes[i]];
    if (refracts)
        *choice = CHOSEN_BY_GLASS;
    else if (gloss && *choice == CHOSEN_BY_NOTHING)
        *choice = CHOSEN_BY_LENS_OR_GLOSS;
    if (gloss || !refracts)
        note_gloss(pass, tile, paths, i, hit, !gloss);
}

/* Sends the paths on, or ends them at the diffuse lobe of a surface that has others too. */
static void scatter(const struct view_pass *pass, uint32_t tile, uint32_t depth,
                    struct camera_paths *paths, const ps_hit *hits)
{
    const struct scene *scene = pass->lighting.scene;
    uint32_t key = sample_key(pass->seed, PS_STREAM_VIEW, depth);
    size_t left = 0;
    for (size_t i = 0; i < paths->count; i++) {
        float numbers[4];
        sample_point(key, paths->indices[paths->lanes[i]], numbers);
        if (depth == 0)
            paths->strata[i].number = numbers[3];
        ps_bsdf_sample on =
            material_scatter(&scene->materials[hits[i].material], scene->microfacets,
                             PS_FROM_CAMERA, &paths->rays[i], &hits[i], numbers, &paths->strata[i]);
        note_scattering(pass, tile, paths, i, &hits[i], &on);
        if (on.lobe == PS_DIFFUSE) {
            ps_rgb throughput = ps_rgb_scale(paths->throughput[i], 1.0f / on.probability);
            if (ps_rgb_maximum(hits[i].albedo) > 0.0f)
                end_path(pass, tile, paths, i, &hits[i], throughput, paths->travelled[i]);
            continue;
        }
        if (!(ps_rgb_maximum(on.weight) > 0.0f))
            continue;
        move_path(paths, i, left);
        paths->throughput[left] = ps_rgb_multiply(paths->throughput[left], on.weight);
        paths->pdfs[left] = on.pdf;
        paths->spreads[left] = ps_max(paths->spreads[left], ps_cone_spread(on.pdf));
        paths->rays[left++] =
            ps_leave_surface(hits[i].position, on.normal, on.direction, scene->surface_offset);
    }
    paths->count = left;
}

/* Lanes in 4x4 blocks, so that each packet of 16 rays is compact. */
void view_pixels(const struct gbuffer *gbuffer, uint32_t tile_number, uint32_t number,
                 float jitter_x, float jitter_y, struct view_points *points)
{
    points->count = 0;
    points->samples_of_pixel = 1;
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
        uint32_t x, y, lane = gbuffer_block_lane(i);
        if (!gbuffer_picture_pixel(gbuffer, tile_number, lane, &x, &y))
            continue;
        points->lanes[points->count++] = lane;
        points->x[lane] = (float)x + jitter_x;
        points->y[lane] = (float)y + jitter_y;
        points->indices[lane] = ps_sample_block(tile_number, lane) + number;
    }
}

void view_trace(const struct view_pass *pass, const struct view_points *points, uint32_t index)
{
    struct camera_paths paths;
    ps_hit hits[PS_TILE_PIXELS];
    bool collects = !pass->hits && !pass->without_light;
    if (!pass->hits)
        gbuffer_clear_tile(pass->gbuffer, index);
    start(pass, points, index, &paths);
    for (uint32_t depth = 0; paths.count > 0 && depth <= PS_LONGEST_CHAIN; depth++) {
        trace_intersect(pass->lighting.trace, depth == 0 ? RAYS_CAMERA : RAYS_INCOHERENT,
                        paths.rays, paths.spreads, paths.count, hits);
        if (collects)
            collect_emission(pass, index, depth, &paths, hits);
        end_at_diffuse(pass, index, &paths, hits);
        if (paths.count > 0) {
            if (collects)
                collect_gloss(pass, index, depth, &paths, hits);
            scatter(pass, index, depth, &paths, hits);
        }
    }
}
