#include "point_cloud.h"

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

static size_t cell_of(const struct point_cloud *cloud, ps_vec3 p)
{
    ps_vec3 at = ps_scale(ps_subtract(p, cloud->low), 1.0f / cloud->cell);
    return cell_index(cloud, cell_at(cloud, at.x), cell_at(cloud, at.y), cell_at(cloud, at.z));
}

static void lay_grid(const ps_host *host, float area, struct point_cloud *cloud)
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
static void sort_points(const struct point *points, size_t cells, struct point_cloud *cloud)
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

static bool make_cloud(const ps_host *host, const struct point *points, size_t count, float area,
                       struct point_cloud *cloud)
{
    cloud->count = count;
    lay_grid(host, area, cloud);
    size_t cells = (size_t)cloud->across * (size_t)cloud->across * (size_t)cloud->across;
    cloud->points = host->allocate(host, count * sizeof *points, "visibility points");
    cloud->cells = host->allocate(host, (cells + 1) * sizeof *cloud->cells, "visibility points");
    if (!cloud->points || !cloud->cells)
        return false;
    sort_points(points, cells, cloud);
    return true;
}

void imperfect_cloud_release(const ps_host *host, struct point_cloud *cloud)
{
    host->release(host, cloud->points);
    host->release(host, cloud->cells);
    *cloud = (struct point_cloud){.count = 0};
}

bool imperfect_cloud_create(const ps_host *host, size_t wanted, struct point_cloud *cloud)
{
    struct point *points = host->allocate(host, wanted * sizeof *points, "visibility points");
    float area = 0;
    size_t count = points ? scatter(host, wanted, points, &area) : 0;
    *cloud = (struct point_cloud){.count = 0};
    bool made = points && (count == 0 || make_cloud(host, points, count, area, cloud));
    host->release(host, points);
    if (!made)
        imperfect_cloud_release(host, cloud);
    return made;
}
