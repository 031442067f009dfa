#include "surface_lines.h"

static void add(ps_vec3 *vector, uint32_t axis, float amount)
{
    *(axis == 0 ? &vector->x : (axis == 1 ? &vector->y : &vector->z)) += amount;
}

static ps_ray line(const struct surface_lines *lines, uint32_t way, uint32_t row, uint32_t column)
{
    uint32_t axis = surface_axis(way);
    float step = lines->grid.side / (float)lines->per_cell;
    float length = lines->grid.side * (float)lines->grid.across;
    ps_ray ray = {lines->grid.corner, 0.0f, {0, 0, 0}, length};
    add(&ray.origin, (axis + 1) % 3, ((float)column + 0.5f) * step);
    add(&ray.origin, (axis + 2) % 3, ((float)row + 0.5f) * step);
    if (way >= 3)
        add(&ray.origin, axis, length);
    add(&ray.direction, axis, way < 3 ? 1.0f : -1.0f);
    return ray;
}

/* Keeps the lines that met something, with what they met. */
static void keep_met(struct surface_crossings *crossings)
{
    size_t met = 0;
    for (size_t i = 0; i < crossings->n; i++) {
        if (!(crossings->hits[i].distance < INFINITY))
            continue;
        crossings->columns[met] = crossings->columns[i];
        crossings->rays[met] = crossings->rays[i];
        crossings->hits[met++] = crossings->hits[i];
    }
    crossings->n = met;
}

static void go_on_behind(const struct surface_lines *lines, const float *distances,
                         struct surface_crossings *crossings)
{
    size_t left = 0;
    for (size_t i = 0; i < crossings->n; i++) {
        ps_ray ray = crossings->rays[i];
        ray.tnear = nextafterf(distances[i] + lines->offset, INFINITY);
        if (!(ray.tnear < ray.tfar))
            continue;
        crossings->columns[left] = crossings->columns[i];
        crossings->rays[left++] = ray;
    }
    crossings->n = left;
}

void surface_lines_follow(const struct surface_lines *lines, uint32_t way, uint32_t row,
                          surface_lines_take take, void *user)
{
    struct surface_crossings crossings = {.way = way, .row = row};
    float distances[PS_PATH_CHUNK] = {0};
    uint32_t across = surface_lines_across(lines);
    for (uint32_t first = 0; first < across; first += PS_PATH_CHUNK) {
        crossings.n = across - first < PS_PATH_CHUNK ? across - first : PS_PATH_CHUNK;
        for (uint32_t i = 0; i < crossings.n; i++) {
            crossings.columns[i] = first + i;
            crossings.rays[i] = line(lines, way, row, first + i);
        }
        for (crossings.round = 0; crossings.n > 0; crossings.round++) {
            lines->host->intersect(lines->host, crossings.rays, crossings.n, crossings.hits);
            keep_met(&crossings);
            for (size_t i = 0; i < crossings.n; i++)
                distances[i] = crossings.hits[i].distance;
            if (crossings.n > 0)
                take(user, &crossings);
            go_on_behind(lines, distances, &crossings);
        }
    }
}
