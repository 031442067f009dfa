/* imperfect.c: imperfect shadow maps (Ritschel et al. 2008): depth maps of points instead of rays.
 *
 * Once, before the first pass, points are scattered over the scene's surfaces; a map is then made
 * of the points in its bundle alone, and what they leave open is filled by pull-push. Its cost does
 * not depend on how the geometry is made, and its maps leak a little: it is the approximation that
 * Hoet 2014, section 4.3, proposes for real-time use.
 *
 * A plugin gets rays, not triangles, so points come from random lines (Cauchy-Crofton): a line that
 * is uniform over the lines through the scene's sphere meets a surface of area A
 *
 *     A / (2 pi r^2)
 *
 * times on average, whatever its shape and however it is hidden, so all crossings of such lines are
 * points uniform over all area; and how many lines it took tells the area that each stands for.
 *
 * A point is drawn as a disc in its surface's plane, COVERAGE times its area, with the plane's depth
 * at each texel's centre; the nearest counts. So a flat surface gets the very depth that a ray would
 * find, and only its border is off, by a disc's radius, which falls with the root of `points`.
 *
 * Points lie in a grid. A bundle walks it slab by slab from its start, along the axis that it is
 * closest to, and stops when no point farther on could change the map.
 */
#include <psplat/plugin.h>
#include <stdio.h>
#include <string.h>

/* Area of a disc, in areas that a point stands for: leaves exp(-3) of a surface open, 5 %. Larger
 * discs leave less to pull-push, but stand out farther over edges. */
#define COVERAGE 3.0f
#define CELL 4.0f           /* side of a cell, in roots of a point's area */
#define MOST_CELLS 128      /* along an axis */
#define MOST_CROSSINGS 64   /* of a line that count */
#define LINES 256           /* at a time */
#define LINES_PER_POINT 64  /* of a scene that is mostly empty, before giving up */
#define CROSSING_STEP 1e-5f /* after a crossing, in radii of the scene */
/* Neighbouring texels whose depths are more than so many texels apart see two surfaces. */
#define SAME_SURFACE 4.0f

struct point {
    ps_vec3 position, normal;
};

struct cloud {
    struct point *points; /* cell by cell; owned */
    uint32_t *cells;      /* cells[c]..cells[c + 1]: points of cell c; owned */
    size_t count;
    float disc;  /* radius of a point */
    ps_vec3 low; /* corner of the grid */
    float cell;  /* side of a cell */
    int across;  /* cells along each axis */
};

struct state {
    int64_t points;
    int64_t pull;
    struct cloud cloud;
};

/* --- points --- */

struct lines {
    ps_ray rays[LINES];
    ps_hit hits[LINES];
};

/* Lines `first` and on: a direction, uniform over the sphere, and a place on the disc across it. */
static void draw_lines(const ps_host *host, uint64_t first, ps_vec3 center, float radius,
                       struct lines *lines)
{
    uint64_t indices[LINES];
    float numbers[LINES][4];
    for (size_t i = 0; i < LINES; i++)
        indices[i] = first + i;
    host->samples(host, PS_STREAM_PLUGIN, 0, indices, LINES, numbers);
    for (size_t i = 0; i < LINES; i++) {
        ps_vec3 u, v;
        ps_vec3 w = ps_cone_direction((ps_vec3){0, 0, 1}, -1.0f, numbers[i][0], numbers[i][1]);
        float off = radius * sqrtf(numbers[i][2]), turn = 2.0f * PS_PI * numbers[i][3];
        ps_frame(w, &u, &v);
        ps_vec3 origin = ps_add_scaled(center, off * cosf(turn), u);
        origin = ps_add_scaled(origin, off * sinf(turn), v);
        lines->rays[i] =
            (ps_ray){ps_add_scaled(origin, -1.01f * radius, w), 0.0f, w, 2.02f * radius};
    }
}

/* Keeps the lines that met something, to go on behind it. Returns how many. */
static size_t go_on(struct lines *lines, size_t n, float step)
{
    size_t left = 0;
    for (size_t i = 0; i < n; i++) {
        float beyond = lines->hits[i].distance + step;
        if (!(beyond < lines->rays[i].tfar))
            continue;
        lines->rays[left] = lines->rays[i];
        lines->rays[left++].tnear = beyond;
    }
    return left;
}

/* All crossings of LINES lines. Points past `wanted` are counted but not kept. */
static size_t follow_lines(const ps_host *host, struct lines *lines, float radius, size_t wanted,
                           struct point *points, size_t count)
{
    size_t n = LINES;
    for (int crossing = 0; crossing < MOST_CROSSINGS && n > 0; crossing++) {
        host->intersect(host, lines->rays, n, lines->hits);
        for (size_t i = 0; i < n; i++) {
            if (!(lines->hits[i].distance < INFINITY))
                continue;
            if (count < wanted)
                points[count] = (struct point){lines->hits[i].position, lines->hits[i].normal};
            count++;
        }
        n = go_on(lines, n, CROSSING_STEP * radius);
    }
    return count;
}

/* Fills `points`; returns how many there are, and the area of each. */
static size_t scatter(const ps_host *host, size_t wanted, struct point *points, float *area)
{
    struct lines lines;
    ps_vec3 center;
    float radius;
    uint64_t drawn = 0, most = LINES_PER_POINT * ((uint64_t)wanted + LINES);
    size_t count = 0;
    host->scene_bounds(host, &center, &radius);
    for (; count < wanted && drawn < most; drawn += LINES) {
        draw_lines(host, drawn, center, radius, &lines);
        count = follow_lines(host, &lines, radius, wanted, points, count);
    }
    double crossings_per_line = (double)count / (double)drawn;
    double whole = 2.0 * 3.14159265358979 * (double)radius * radius * crossings_per_line;
    count = count < wanted ? count : wanted;
    *area = count ? (float)(whole / (double)count) : 0.0f;
    return count;
}

/* --- grid --- */

/* The cell at x, in cells; what lies outside counts to the cells at the border. */
static int cell_at(const struct cloud *cloud, float x)
{
    return (int)fminf(fmaxf(x, 0.0f), (float)(cloud->across - 1));
}

static size_t cell_index(const struct cloud *cloud, int x, int y, int z)
{
    size_t across = (size_t)cloud->across;
    return ((size_t)z * across + (size_t)y) * across + (size_t)x;
}

static size_t cell_of(const struct cloud *cloud, ps_vec3 p)
{
    ps_vec3 at = ps_scale(ps_subtract(p, cloud->low), 1.0f / cloud->cell);
    return cell_index(cloud, cell_at(cloud, at.x), cell_at(cloud, at.y), cell_at(cloud, at.z));
}

static void lay_grid(const ps_host *host, float area, struct cloud *cloud)
{
    ps_vec3 center;
    float radius;
    host->scene_bounds(host, &center, &radius);
    float wanted = ceilf(2.0f * radius / (CELL * sqrtf(area)));
    cloud->across = (int)fminf(fmaxf(wanted, 1.0f), (float)MOST_CELLS);
    cloud->cell = 2.0f * radius / (float)cloud->across;
    cloud->low = ps_subtract(center, (ps_vec3){radius, radius, radius});
    cloud->disc = sqrtf(COVERAGE * area / PS_PI);
}

/* Counting sort by cell; within a cell points keep their order. */
static void sort_points(const struct point *points, size_t cells, struct cloud *cloud)
{
    memset(cloud->cells, 0, (cells + 1) * sizeof *cloud->cells);
    for (size_t i = 0; i < cloud->count; i++)
        cloud->cells[cell_of(cloud, points[i].position)]++;
    uint32_t sum = 0;
    for (size_t c = 0; c <= cells; c++) {
        sum += cloud->cells[c];
        cloud->cells[c] = sum;
    }
    for (size_t i = cloud->count; i-- > 0;)
        cloud->points[--cloud->cells[cell_of(cloud, points[i].position)]] = points[i];
}

static int make_cloud(const ps_host *host, const struct point *points, size_t count, float area,
                      struct cloud *cloud)
{
    cloud->count = count;
    lay_grid(host, area, cloud);
    size_t cells = (size_t)cloud->across * (size_t)cloud->across * (size_t)cloud->across;
    cloud->points = host->allocate(host, count * sizeof *points, "visibility points");
    cloud->cells = host->allocate(host, (cells + 1) * sizeof *cloud->cells, "visibility points");
    if (!cloud->points || !cloud->cells)
        return 0;
    sort_points(points, cells, cloud);
    return 1;
}

static void destroy(void *opaque, const ps_host *host)
{
    struct state *state = opaque;
    host->release(host, state->cloud.points);
    host->release(host, state->cloud.cells);
}

static ps_result init(void *opaque, const ps_host *host)
{
    struct state *state = opaque;
    size_t wanted = (size_t)state->points;
    struct point *points = host->allocate(host, wanted * sizeof *points, "visibility points");
    float area = 0;
    size_t count = points ? scatter(host, wanted, points, &area) : 0;
    int made = points && (count == 0 || make_cloud(host, points, count, area, &state->cloud));
    host->release(host, points);
    if (!made) {
        char why[80];
        destroy(state, host);
        snprintf(why, sizeof why, "out of memory for %lld points", (long long)state->points);
        return host->fail(host, PS_ERROR_MEMORY, why);
    }
    host->count(host, "visibility points", (double)count);
    if (count < wanted)
        host->log(host, PS_LOG_WARNING, "imperfect: the scene has hardly any surface for points");
    return PS_OK;
}

/* --- maps --- */

struct map {
    const ps_bundle *bundle;
    const struct cloud *cloud;
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

/* The bundle against the grid. Axes are numbered so that axis[0] is the one it is closest to, and all
 * vectors are in that order, from the grid's corner and in cells. */
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

/* Cuts a row of cells, (slab, row, x) for x in `range`, to what lies between the bundle's boundaries. */
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
    const struct cloud *cloud = map->cloud;
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

/* --- pull-push --- */

/* Whether one of the `reach` texels from (x, y) on in a direction is nearer than `limit`. */
static int is_closed(const float *depths, int side, int x, int y, int dx, int dy, int reach,
                     float limit)
{
    for (int i = 0; i < reach; i++) {
        x += dx;
        y += dy;
        if (x < 0 || y < 0 || x >= side || y >= side)
            return 0;
        if (depths[y * side + x] < limit)
            return 1;
    }
    return 0;
}

/* Marks texels that look through a hole between a surface's points: in all four directions there is
 * a surface far in front within `reach` texels. Opens them in place: an opened texel counts as far
 * behind. Where nothing lies behind, texels are open from the start; those that are not closed in
 * are no holes but see past everything. */
static void open_holes(float *depths, int side, int reach, float apart, uint8_t *holes)
{
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            float limit = depths[y * side + x] - apart;
            int hole = is_closed(depths, side, x, y, -1, 0, reach, limit) &&
                       is_closed(depths, side, x, y, 1, 0, reach, limit) &&
                       is_closed(depths, side, x, y, 0, -1, reach, limit) &&
                       is_closed(depths, side, x, y, 0, 1, reach, limit);
            holes[y * side + x] = (uint8_t)hole;
            if (hole)
                depths[y * side + x] = INFINITY;
        }
}

/* Mean depth of the texels of a block of four that lie within `apart` of the nearest: a hole belongs
 * to the surface in front. */
static float pull_block(const float *depths, uint32_t side, uint32_t left, uint32_t top,
                        float apart)
{
    float nearest = INFINITY, sum = 0;
    int count = 0;
    for (uint32_t y = top; y < top + 2 && y < side; y++)
        for (uint32_t x = left; x < left + 2 && x < side; x++)
            nearest = fminf(nearest, depths[y * side + x]);
    for (uint32_t y = top; y < top + 2 && y < side; y++)
        for (uint32_t x = left; x < left + 2 && x < side; x++)
            if (depths[y * side + x] < INFINITY && depths[y * side + x] <= nearest + apart) {
                sum += depths[y * side + x];
                count++;
            }
    return count ? sum / (float)count : INFINITY;
}

/* The depth of a flat surface at an open texel, from two texels on opposite sides that lie on one
 * surface; INFINITY if there are none. */
static float bridge(const float *depths, uint32_t side, uint32_t x, uint32_t y, float apart)
{
    const float *at = &depths[y * side + x];
    float best = INFINITY;
    if (x > 0 && x + 1 < side && fabsf(at[-1] - at[1]) <= apart)
        best = 0.5f * (at[-1] + at[1]);
    if (y > 0 && y + 1 < side && fabsf(at[-(int)side] - at[side]) <= apart)
        best = fminf(best, 0.5f * (at[-(int)side] + at[side]));
    return best;
}

/* Fills open texels from what is beside them, or from the level above, which is filled first. */
static void pull_push(float *depths, uint32_t side, int64_t levels, float apart)
{
    float above[PS_MOST_TEXELS / 2 * PS_MOST_TEXELS / 2];
    uint32_t half = (side + 1) / 2;
    if (levels == 0 || side < 2)
        return;
    for (uint32_t i = 0; i < half * half; i++)
        above[i] = pull_block(depths, side, 2 * (i % half), 2 * (i / half), apart);
    pull_push(above, half, levels - 1, 2.0f * apart);
    for (uint32_t i = 0; i < side * side; i++) {
        uint32_t x = i % side, y = i / side;
        if (depths[i] < INFINITY)
            continue;
        float between = bridge(depths, side, x, y, 2.0f * apart);
        depths[i] = between < INFINITY ? between : above[y / 2 * half + x / 2];
    }
}

/* A level of pull-push doubles the width of the holes that are found and filled. */
static void fill_holes(float *depths, uint32_t side, int64_t levels, float texel)
{
    float filled[PS_MOST_TEXELS * PS_MOST_TEXELS];
    uint8_t holes[PS_MOST_TEXELS * PS_MOST_TEXELS] = {0};
    if (levels == 0)
        return;
    open_holes(depths, (int)side, 1 << (levels - 1), SAME_SURFACE * texel, holes);
    memcpy(filled, depths, side * side * sizeof *filled);
    pull_push(filled, side, levels, SAME_SURFACE * texel);
    for (uint32_t i = 0; i < side * side; i++)
        depths[i] = holes[i] ? filled[i] : depths[i];
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
        fill_holes(map.depths, side, state->pull, texel);
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
