/* polygons.c: see polygons.h. */
#include "pov/polygons.h"

#include "writer/scene_text.h"
#include <stdlib.h>
#include <string.h>

bool csg_take(struct csg_budget *budget, size_t steps, size_t bytes)
{
    budget->spent = budget->spent || steps > budget->steps || bytes > budget->bytes;
    budget->steps -= steps < budget->steps ? steps : budget->steps;
    budget->bytes -= bytes < budget->bytes ? bytes : budget->bytes;
    return !budget->spent;
}

void csg_polygons_release(struct csg_polygons *polygons)
{
    if (polygons->budget)
        polygons->budget->bytes += polygons->vertex_capacity * sizeof *polygons->vertices +
                                   polygons->capacity * sizeof *polygons->list;
    free(polygons->vertices);
    free(polygons->list);
    *polygons = (struct csg_polygons){0};
}

void csg_polygons_clear(struct csg_polygons *polygons)
{
    polygons->vertex_count = polygons->count = 0;
}

static bool grow(struct csg_budget *budget, void **items, size_t *capacity, size_t wanted,
                 size_t size)
{
    size_t before = *capacity;
    if (wanted <= before)
        return true;
    if (budget && (budget->spent || (wanted - before) > budget->bytes / size)) {
        budget->spent = true;
        return false;
    }
    if (!scene_text_grow(items, capacity, wanted, size))
        return false;
    return !budget || csg_take(budget, 0, (*capacity - before) * size);
}

bool csg_polygons_add(struct csg_polygons *polygons, const struct csg_vertex *vertices,
                      size_t count)
{
    if (count < 3)
        return true;
    if (!grow(polygons->budget, (void **)&polygons->vertices, &polygons->vertex_capacity,
              polygons->vertex_count + count, sizeof *vertices) ||
        !grow(polygons->budget, (void **)&polygons->list, &polygons->capacity, polygons->count + 1,
              sizeof *polygons->list))
        return false;
    memcpy(polygons->vertices + polygons->vertex_count, vertices, count * sizeof *vertices);
    polygons->list[polygons->count++] = (struct csg_polygon){polygons->vertex_count, count};
    polygons->vertex_count += count;
    return true;
}

static double height(const struct csg_plane *plane, struct vector p)
{
    return vector_dot(plane->normal, p) - plane->distance;
}

static double mixed(double a, double b, double t)
{
    return a + t * (b - a);
}

static struct vector between(struct vector a, struct vector b, double t)
{
    return (struct vector){mixed(a.x, b.x, t), mixed(a.y, b.y, t), mixed(a.z, b.z, t)};
}

/* How the polygon lies to the plane: -1 behind or in it, 1 before, 0 across. */
static int side_of(const struct csg_plane *plane, const struct csg_vertex *v, size_t count,
                   double tolerance)
{
    bool before = false, behind = false;
    for (size_t i = 0; i < count; i++) {
        double h = height(plane, v[i].point);
        before = before || h > tolerance;
        behind = behind || h < -tolerance;
    }
    return before && behind ? 0 : before ? 1 : -1;
}

/* A polygon across the plane in two (I. Sutherland and G. Hodgman, "Reentrant polygon clipping",
 * 1974); each has room for one corner more. */
static void split(const struct csg_plane *plane, const struct csg_vertex *v, size_t count,
                  double tolerance, struct csg_vertex *back, size_t *back_count,
                  struct csg_vertex *front, size_t *front_count)
{
    *back_count = *front_count = 0;
    for (size_t i = 0; i < count; i++) {
        const struct csg_vertex *a = &v[i], *b = &v[(i + 1) % count];
        double ha = height(plane, a->point), hb = height(plane, b->point);
        if (ha <= tolerance)
            back[(*back_count)++] = *a;
        if (ha >= -tolerance)
            front[(*front_count)++] = *a;
        if ((ha > tolerance && hb < -tolerance) || (ha < -tolerance && hb > tolerance)) {
            double t = ha / (ha - hb);
            struct csg_vertex middle = {between(a->point, b->point, t),
                                        between(a->normal, b->normal, t)};
            back[(*back_count)++] = front[(*front_count)++] = middle;
        }
    }
}

static bool add(struct csg_polygons *to, const struct csg_vertex *v, size_t count)
{
    return !to || csg_polygons_add(to, v, count);
}

/* Surely apart: by the spheres around both, or by one of the planes. */
static bool is_apart(const struct csg_convex *convex, const struct csg_vertex *v, size_t count,
                     double tolerance, struct csg_budget *budget)
{
    double nearest = INFINITY, size = 0.0;
    for (size_t i = 0; i < count && convex->radius < INFINITY; i++) {
        size = fmax(size, vector_length(vector_subtract(v[i].point, v[0].point)));
        nearest = fmin(nearest, vector_length(vector_subtract(v[i].point, convex->center)));
    }
    if (convex->radius < INFINITY && nearest - size > convex->radius)
        return true;
    for (size_t i = 0; i < convex->plane_count; i++) {
        csg_take(budget, count, 0);
        if (side_of(&convex->planes[i], v, count, tolerance) > 0)
            return true;
    }
    return false;
}

/* Buffers of the corners of one polygon, which the planes add to. */
struct buffers {
    struct csg_vertex *rest, *back, *front;
};

static bool cut_one(const struct csg_vertex *v, size_t count, const struct csg_convex *convex,
                    double tolerance, struct buffers *buffers, struct csg_polygons *inside,
                    struct csg_polygons *outside, struct csg_budget *budget)
{
    size_t back_count, front_count;
    if (is_apart(convex, v, count, tolerance, budget))
        return add(outside, v, count);
    memcpy(buffers->rest, v, count * sizeof *v);
    for (size_t i = 0; i < convex->plane_count; i++) {
        csg_take(budget, count, 0);
        if (side_of(&convex->planes[i], buffers->rest, count, tolerance) < 0)
            continue;
        split(&convex->planes[i], buffers->rest, count, tolerance, buffers->back, &back_count,
              buffers->front, &front_count);
        if (!add(outside, buffers->front, front_count))
            return false;
        struct csg_vertex *swapped = buffers->rest;
        buffers->rest = buffers->back;
        buffers->back = swapped;
        count = back_count;
        if (count < 3)
            return true;
    }
    return add(inside, buffers->rest, count);
}

bool csg_cut(const struct csg_polygons *polygons, const struct csg_convex *convex, double tolerance,
             struct csg_polygons *inside, struct csg_polygons *outside, struct csg_budget *budget)
{
    size_t largest = 0;
    for (size_t i = 0; i < polygons->count; i++)
        largest = largest > polygons->list[i].count ? largest : polygons->list[i].count;
    size_t room = 2 * (largest + convex->plane_count + 2);
    struct csg_vertex *memory = malloc(3 * room * sizeof *memory);
    if (!memory)
        return false;
    struct buffers buffers = {memory, memory + room, memory + 2 * room};
    bool good = true;
    for (size_t i = 0; i < polygons->count && good; i++)
        good = cut_one(polygons->vertices + polygons->list[i].start, polygons->list[i].count,
                       convex, tolerance, &buffers, inside, outside, budget) &&
               !budget->spent;
    free(memory);
    return good;
}
