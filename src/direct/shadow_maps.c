/* shadow_maps.c: see shadow_maps.h.
 *
 * A map holds the distance along each ray, measured from where it starts, to what it meets first.
 * The four pixels around a point are compared with the point's own distance and weighed bilinearly,
 * so that shadows end softly within a pixel and converge to those of rays.
 *
 * A pixel's ray passes the point at up to sqrt(2) pixels, where the point's surface may be nearer
 * to the light by tan(theta) times that; theta: between light and normal. So the tolerance is 1.5
 * pixels * tan(theta), as for splats (bundle.h). A constant would either shadow slopes or leak at
 * contacts.
 */
#include "direct/shadow_maps.h"

#include "base/parallel.h"
#include <psplat/light_map.h>
#include <psplat/math.h>
#include <stdlib.h>

#define BLOCK 4 /* pixels along the side of a packet */

#define SLOPE_PIXELS 1.5f
#define FLAT_PIXELS 0.1f /* tolerance where light arrives at a right angle */

struct shadow_maps {
    size_t *first; /* the maps of light i: first[i] up to first[i + 1] */
    ps_light_view *views;
    float *depths; /* side * side of each view, row by row; INFINITY: nothing is met */
    size_t count;  /* of views */
    uint32_t side;
};

/* The sphere around the scene, seen from outside. */
static ps_light_view view_of_sun(const struct scene *scene, ps_vec3 axis)
{
    ps_light_view view = {.axis = axis, .radius = scene->radius, .parallel = 1};
    view.origin = ps_add_scaled(scene->center, -2.0f * scene->radius, axis);
    ps_frame(axis, &view.u, &view.v);
    return view;
}

/* Writes the views of a light, at most 6; returns how many. */
static size_t views_of_light(const struct scene *scene, const struct light *light,
                             ps_light_view views[6])
{
    ps_light described = light_describe(light);
    if (!light_is_delta(light))
        return 0;
    if (described.kind == PS_LIGHT_SUN) {
        views[0] = view_of_sun(scene, described.axis);
        return 1;
    }
    uint32_t count = ps_light_view_count(&described);
    for (uint32_t face = 0; face < count; face++)
        views[face] = ps_light_view_of(&described, face);
    return count;
}

static size_t pixels_of(const struct shadow_maps *maps)
{
    return (size_t)maps->side * maps->side;
}

/* --- tracing
 * ------------------------------------------------------------------------------------ */

struct tracing {
    struct shadow_maps *maps;
    const struct trace *trace;
    float offset;
};

/* Pixels (left .. left + 3, top .. top + 3) of a map; rays past the border go to waste. */
static void trace_block(const struct tracing *tracing, size_t map, uint32_t left, uint32_t top)
{
    const struct shadow_maps *maps = tracing->maps;
    float side = (float)maps->side, *depths = &maps->depths[map * pixels_of(maps)];
    _Alignas(64) ps_ray_packet packet;
    for (uint32_t lane = 0; lane < BLOCK * BLOCK; lane++) {
        uint32_t column = left + lane % BLOCK, row = top + lane / BLOCK;
        ps_ray ray = ps_light_view_ray(&maps->views[map], ((float)column + 0.5f) / side,
                                       ((float)row + 0.5f) / side, tracing->offset);
        ps_packet_set(&packet, lane, ray);
    }
    trace_packets(tracing->trace, &packet, 1, true);
    for (uint32_t lane = 0; lane < BLOCK * BLOCK; lane++) {
        uint32_t column = left + lane % BLOCK, row = top + lane / BLOCK;
        if (column < maps->side && row < maps->side)
            depths[(size_t)row * maps->side + column] = packet.tfar[lane];
    }
}

static uint32_t blocks_across(const struct shadow_maps *maps)
{
    return (maps->side + BLOCK - 1) / BLOCK;
}

static void trace_row_of_blocks(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct tracing *tracing = user;
    uint32_t blocks = blocks_across(tracing->maps);
    for (uint32_t block = 0; block < blocks; block++)
        trace_block(tracing, index / blocks, block * BLOCK, (uint32_t)(index % blocks) * BLOCK);
}

/* --- making them
 * -------------------------------------------------------------------------------- */

static size_t count_views(const struct scene *scene)
{
    ps_light_view views[6];
    size_t count = 0;
    for (size_t i = 0; i < scene->light_count; i++)
        count += views_of_light(scene, &scene->lights[i], views);
    return count;
}

static void set_views(const struct scene *scene, struct shadow_maps *maps)
{
    ps_light_view views[6];
    maps->first[0] = 0;
    for (size_t i = 0; i < scene->light_count; i++) {
        size_t count = views_of_light(scene, &scene->lights[i], views);
        for (size_t face = 0; face < count; face++)
            maps->views[maps->first[i] + face] = views[face];
        maps->first[i + 1] = maps->first[i] + count;
    }
}

ps_result shadow_maps_create(const struct scene *scene, const struct trace *trace, uint32_t side,
                             struct workers *workers, struct shadow_maps **created,
                             struct error *error)
{
    size_t views = count_views(scene), pixels = (size_t)side * side;
    size_t bytes = views * pixels * sizeof(float);
    struct shadow_maps *maps = calloc(1, sizeof *maps);
    if (!maps)
        return error_memory(error, sizeof *maps, "shadow maps");
    maps->side = side;
    maps->count = views;
    maps->first = calloc(scene->light_count + 1, sizeof *maps->first);
    maps->views = calloc(views + 1, sizeof *maps->views);
    maps->depths = views <= SIZE_MAX / sizeof(float) / pixels ? malloc(bytes + 1) : NULL;
    if (!maps->first || !maps->views || !maps->depths) {
        shadow_maps_destroy(maps);
        return error_memory(error, bytes, "shadow maps; lower direct_resolution");
    }
    set_views(scene, maps);
    struct tracing tracing = {maps, trace, scene->surface_offset};
    parallel_for(workers, (uint64_t)views * blocks_across(maps), trace_row_of_blocks, &tracing);
    *created = maps;
    return PS_OK;
}

void shadow_maps_destroy(struct shadow_maps *maps)
{
    if (!maps)
        return;
    free(maps->first);
    free(maps->views);
    free(maps->depths);
    free(maps);
}

size_t shadow_maps_bytes(const struct shadow_maps *maps)
{
    return maps->count * pixels_of(maps) * sizeof *maps->depths;
}

/* --- looking up
 * --------------------------------------------------------------------------------- */

bool shadow_maps_hold(const struct shadow_maps *maps, size_t light)
{
    return maps->first[light + 1] > maps->first[light];
}

/* Where a point lies in a view. */
struct place {
    float x, y;    /* in pixels; the first one's middle is at 0 */
    float depth;   /* distance that its ray goes to it */
    float pixel;   /* width of a pixel there */
    ps_vec3 light; /* unit; towards the light */
};

static float along(const ps_light_view *view, ps_vec3 point)
{
    return ps_dot(ps_subtract(point, view->origin), view->axis);
}

/* The view whose square the point is seen through: of a cube's, the one that it lies deepest in. */
static size_t view_that_holds(const struct shadow_maps *maps, size_t light, ps_vec3 point)
{
    size_t deepest = maps->first[light];
    for (size_t i = deepest + 1; i < maps->first[light + 1]; i++)
        if (along(&maps->views[i], point) > along(&maps->views[deepest], point))
            deepest = i;
    return deepest;
}

static struct place place_of(const struct shadow_maps *maps, const ps_light_view *view,
                             ps_vec3 point)
{
    ps_vec3 from = ps_subtract(point, view->origin);
    float deep = ps_dot(from, view->axis), side = (float)maps->side;
    float radius = view->parallel ? view->radius : view->radius * deep;
    return (struct place){
        .x = 0.5f * (ps_dot(from, view->u) / radius + 1.0f) * side - 0.5f,
        .y = 0.5f * (ps_dot(from, view->v) / radius + 1.0f) * side - 0.5f,
        .depth = view->parallel ? deep : ps_length(from),
        .pixel = 2.0f * radius / side,
        .light = ps_scale(view->parallel ? view->axis : ps_normalize(from), -1.0f),
    };
}

static float tolerance(const struct place *place, ps_vec3 normal)
{
    float cosine = fminf(fmaxf(ps_dot(place->light, normal), 1e-6f), 1.0f);
    float slope = sqrtf(1.0f - cosine * cosine) / cosine;
    return place->pixel * (FLAT_PIXELS + SLOPE_PIXELS * slope);
}

/* 1 where the pixel's ray gets as far as `depth`. Past the border the nearest pixel speaks. */
static float reaches(const struct shadow_maps *maps, const float *depths, float x, float y,
                     float depth)
{
    float last = (float)(maps->side - 1);
    size_t column = (size_t)fminf(fmaxf(x, 0.0f), last), row = (size_t)fminf(fmaxf(y, 0.0f), last);
    return depth <= depths[row * maps->side + column] ? 1.0f : 0.0f;
}

float shadow_maps_lit(const struct shadow_maps *maps, size_t light, ps_vec3 point, ps_vec3 normal)
{
    size_t map = view_that_holds(maps, light, point);
    struct place place = place_of(maps, &maps->views[map], point);
    const float *depths = &maps->depths[map * pixels_of(maps)];
    float depth = place.depth - tolerance(&place, normal);
    float left = floorf(place.x), top = floorf(place.y);
    float right_share = place.x - left, lower_share = place.y - top;
    float upper = reaches(maps, depths, left, top, depth) * (1.0f - right_share) +
                  reaches(maps, depths, left + 1.0f, top, depth) * right_share;
    float lower = reaches(maps, depths, left, top + 1.0f, depth) * (1.0f - right_share) +
                  reaches(maps, depths, left + 1.0f, top + 1.0f, depth) * right_share;
    return upper * (1.0f - lower_share) + lower * lower_share;
}
