/* imperfect.c: imperfect shadow maps (Ritschel et al. 2008): depth maps of points instead of rays.
 *
 * Once, before the first pass, points are scattered over the scene's surfaces; a map is then made
 * of the points in its bundle alone, and what they leave open is filled by pull-push. Its cost does
 * not depend on how the geometry is made, and its maps leak a little: it is the approximation that
 * Hoet 2014, section 4.3, proposes for real-time use.
 *
 * A point is drawn as a disc in its surface's plane, three times its area, with the plane's depth
 * at each texel's centre; the nearest counts. So a flat surface gets the very depth that a ray
 * would find, and only its border is off, by a disc's radius, which falls with the root of
 * `points`.
 *
 * Points lie in a grid. A bundle walks it slab by slab from its start, along the axis that it is
 * closest to, and stops when no point farther on could change the map.
 */
#include "imperfect/point_cloud.h"
#include "imperfect/pull_push.h"

#include <psplat/plugin.h>
#include <stdio.h>

struct state {
    int64_t points;
    int64_t pull;
    struct point_cloud cloud;
};

static void destroy(void *opaque, const ps_host *host)
{
    struct state *state = opaque;
    imperfect_cloud_release(host, &state->cloud);
}

static ps_result init(void *opaque, const ps_host *host)
{
    struct state *state = opaque;
    size_t wanted = (size_t)state->points;
    if (!imperfect_cloud_create(host, wanted, &state->cloud)) {
        char why[80];
        snprintf(why, sizeof why, "out of memory for %lld points", (long long)state->points);
        return host->fail(host, PS_ERROR_MEMORY, why);
    }
    host->count(host, "visibility points", (double)state->cloud.count);
    if (state->cloud.count < wanted)
        host->log(host, PS_LOG_WARNING, "imperfect: the scene has hardly any surface for points");
    return PS_OK;
}

/* --- maps --- */

struct map {
    const ps_bundle *bundle;
    const struct point_cloud *cloud;
    float *depths;
    uint32_t side;
    float texel;
    uint32_t open; /* texels that are INFINITY */
};

/* First texel whose centre is not before x, at most `side`. */
static uint32_t texel_from(const struct map *map, float x)
{
    float place = (x + map->bundle->radius) / map->texel - 0.5f;
    if (!(place > 0.0f))
        return 0;
    if (place >= (float)map->side)
        return map->side;
    uint32_t whole = (uint32_t)place;
    return whole + ((float)whole < place);
}

static void draw_texel(struct map *map, uint32_t column, uint32_t row, ps_vec3 place,
                       ps_vec3 normal)
{
    float u = ps_texel_centre(map->bundle->radius, map->side, column);
    float v = ps_texel_centre(map->bundle->radius, map->side, row);
    float du = u - place.x, dv = v - place.y;
    float dt = -(du * normal.x + dv * normal.y) / normal.z;
    if (!(du * du + dv * dv + dt * dt <= map->cloud->disc * map->cloud->disc))
        return;
    float depth = place.z + dt;
    float *held = &map->depths[row * map->side + column];
    if (depth < ps_bundle_start(map->bundle, u, v) || depth > map->bundle->far_depth ||
        depth >= *held)
        return;
    map->open -= !(*held < INFINITY);
    *held = depth;
}

static void draw_point(struct map *map, const struct point *point)
{
    const ps_bundle *bundle = map->bundle;
    ps_vec3 place = ps_bundle_place(bundle, point->position);
    float reach = bundle->radius + map->cloud->disc;
    if (fabsf(place.x) > reach || fabsf(place.y) > reach)
        return;
    ps_vec3 normal = {ps_dot(point->normal, bundle->axis_u), ps_dot(point->normal, bundle->axis_v),
                      ps_dot(point->normal, bundle->axis_w)};
    float half_u = map->cloud->disc * sqrtf(fmaxf(0.0f, 1.0f - normal.x * normal.x));
    float half_v = map->cloud->disc * sqrtf(fmaxf(0.0f, 1.0f - normal.y * normal.y));
    uint32_t right = texel_from(map, place.x + half_u), bottom = texel_from(map, place.y + half_v);
    for (uint32_t row = texel_from(map, place.y - half_v); row < bottom; row++)
        for (uint32_t column = texel_from(map, place.x - half_u); column < right; column++)
            draw_texel(map, column, row, place, normal);
}

/* The bundle against the grid. Axes are numbered so that axis[0] is the one it is closest to, and
 * all vectors are in that order, from the grid's corner and in cells. */
struct walk {
    int axis[3];
    float centre[3], w[3];
    float across[2][3]; /* u and v */
    float extent[3];    /* of the bundle's cross-section */
    float reach;        /* radius of the bundle and of a disc */
    float start, end;   /* depths between which the bundle is walked */
};

static void order_axes(ps_vec3 w, int axis[3])
{
    const float along[3] = {fabsf(w.x), fabsf(w.y), fabsf(w.z)};
    int first = along[0] > along[1] ? 0 : 1;
    first = along[2] > along[first] ? 2 : first;
    for (int i = 0; i < 3; i++)
        axis[i] = (first + i) % 3;
}

static void reorder(const int axis[3], ps_vec3 from, float to[3])
{
    const float members[3] = {from.x, from.y, from.z};
    for (int i = 0; i < 3; i++)
        to[i] = members[axis[i]];
}

static struct walk begin_walk(const struct map *map)
{
    const ps_bundle *bundle = map->bundle;
    float disc = map->cloud->disc, cell = map->cloud->cell;
    float tilt = bundle->radius * (fabsf(bundle->start_slope_u) + fabsf(bundle->start_slope_v));
    struct walk walk = {
        .reach = (bundle->radius + disc) / cell,
        .start = (bundle->start_depth - tilt - disc) / cell,
        .end = (bundle->far_depth + disc) / cell,
    };
    order_axes(bundle->axis_w, walk.axis);
    ps_vec3 centre = ps_subtract(bundle->centre, map->cloud->low);
    reorder(walk.axis, ps_scale(centre, 1.0f / cell), walk.centre);
    reorder(walk.axis, bundle->axis_w, walk.w);
    reorder(walk.axis, bundle->axis_u, walk.across[0]);
    reorder(walk.axis, bundle->axis_v, walk.across[1]);
    for (int i = 0; i < 3; i++)
        walk.extent[i] = walk.reach * (fabsf(walk.across[0][i]) + fabsf(walk.across[1][i]));
    return walk;
}

struct range {
    float from, to;
};

/* Depths of the bundle within a slab. */
static struct range slab_depths(const struct walk *walk, int slab)
{
    float low = (float)slab - walk->centre[0] - walk->extent[0];
    float high = (float)slab + 1.0f - walk->centre[0] + walk->extent[0];
    float inverse = 1.0f / walk->w[0];
    return (struct range){fminf(low * inverse, high * inverse),
                          fmaxf(low * inverse, high * inverse)};
}

/* Where the bundle lies along axis i between two depths. */
static struct range beam_along(const struct walk *walk, int i, struct range depths)
{
    float a = walk->centre[i] + depths.from * walk->w[i];
    float b = walk->centre[i] + depths.to * walk->w[i];
    return (struct range){fminf(a, b) - walk->extent[i], fmaxf(a, b) + walk->extent[i]};
}

/* Cuts a row of cells, (slab, row, x) for x in `range`, to what lies between the bundle's
 * boundaries. */
static struct range cut_row(const struct walk *walk, int slab, int row, struct range range)
{
    for (int wall = 0; wall < 2; wall++) {
        const float *n = walk->across[wall];
        if (fabsf(n[2]) < 1e-3f)
            continue;
        float middle = ((float)slab + 0.5f - walk->centre[0]) * n[0] +
                       ((float)row + 0.5f - walk->centre[1]) * n[1];
        float slack = (walk->reach + 0.5f * (fabsf(n[0]) + fabsf(n[1]))) / fabsf(n[2]);
        float at = walk->centre[2] - middle / n[2];
        range.from = fmaxf(range.from, at - slack);
        range.to = fminf(range.to, at + slack);
    }
    return range;
}

static void draw_cell(struct map *map, const struct walk *walk, int slab, int row, int column)
{
    int at[3];
    at[walk->axis[0]] = slab;
    at[walk->axis[1]] = row;
    at[walk->axis[2]] = column;
    size_t cell = cell_index(map->cloud, at[0], at[1], at[2]);
    for (uint32_t i = map->cloud->cells[cell]; i < map->cloud->cells[cell + 1]; i++)
        draw_point(map, &map->cloud->points[i]);
}

static void draw_slab(struct map *map, const struct walk *walk, int slab, struct range depths)
{
    depths.from = fmaxf(depths.from, walk->start);
    depths.to = fminf(depths.to, walk->end);
    if (!(depths.from <= depths.to))
        return;
    const struct point_cloud *cloud = map->cloud;
    struct range rows = beam_along(walk, 1, depths), columns = beam_along(walk, 2, depths);
    int last_row = cell_at(cloud, rows.to);
    for (int row = cell_at(cloud, rows.from); row <= last_row; row++) {
        struct range range = cut_row(walk, slab, row, columns);
        int last = cell_at(cloud, range.to);
        for (int column = cell_at(cloud, range.from); range.from <= range.to && column <= last;
             column++)
            draw_cell(map, walk, slab, row, column);
    }
}

static int is_behind(const struct map *map, float depth)
{
    if (map->open > 0)
        return 0;
    for (uint32_t i = 0; i < map->side * map->side; i++)
        if (map->depths[i] > depth)
            return 0;
    return 1;
}

static void draw_map(struct map *map)
{
    struct walk walk = begin_walk(map);
    int across = map->cloud->across, forward = walk.w[0] > 0;
    for (int step = 0; step < across; step++) {
        int slab = forward ? step : across - 1 - step;
        struct range depths = slab_depths(&walk, slab);
        if (depths.from > walk.end || is_behind(map, depths.from * map->cloud->cell))
            return;
        draw_slab(map, &walk, slab, depths);
    }
}

/* --- callbacks --- */

static void depth_maps(const void *opaque, const ps_host *host, const ps_bundle *bundles, size_t n,
                       uint32_t side, float *depths)
{
    const struct state *state = opaque;
    uint32_t texels = side * side;
    (void)host;
    for (size_t b = 0; b < n; b++) {
        float texel = 2.0f * bundles[b].radius / (float)side;
        struct map map = {&bundles[b], &state->cloud, depths + b * texels, side, texel, texels};
        for (uint32_t i = 0; i < texels; i++)
            map.depths[i] = INFINITY;
        if (state->cloud.count == 0)
            continue;
        draw_map(&map);
        imperfect_fill_holes(map.depths, side, state->pull, texel);
    }
}

static const ps_param params[] = {
    PS_INT(struct state, points, "100000", 1, 100000000, "points",
           "points that stand for the scene's surfaces"),
    PS_ROW(struct state, pull, PS_PARAM_INT, "2", 0, 6, PS_PARAM_EXPERT, NULL, "levels",
           "levels of pull-push, which fills holes of up to 2^pull - 1 texels; 0: none"),
};

static const ps_visibility_vtable vtable = {
    .size = sizeof vtable,
    .depth_maps = depth_maps,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_VISIBILITY,
    .name = "imperfect",
    .version = "1.0",
    .summary = "imperfect shadow maps: depth maps of points scattered over the scene",
    .paper = "Ritschel et al. 2008, Imperfect shadow maps for efficient computation of indirect "
             "illumination",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .init = init,
    .destroy = destroy,
    .vtable = &vtable,
};

PS_MODULE(visibility, imperfect, &descriptor)
