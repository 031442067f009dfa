/* light_surface.c: triangles that shine: rectangles, discs, emissive meshes.
 *
 * Points are uniform over the area: a triangle by its share, then a point in it. Sampling by solid
 * angle (Arvo 1995) has less noise close by, but needs to choose among triangles by what they look
 * like from each point; area is right for any mesh, and one table serves all points. Light paths
 * leave with the cosine distribution of a Lambertian emitter.
 *
 * Normals and areas are computed in double, for triangles whose edges square to nothing in float.
 */
#include "scene/light_kinds.h"

#include <stdlib.h>
#include <string.h>

/* How many points, over all triangles, a pattern's mean is made from, and the most along an edge.
 */
#define PATTERN_POINTS 65536
#define PATTERN_EDGE 64

struct corners {
    ps_vec3 p[3];
};

static struct corners corners_of(const struct light_mesh *mesh, size_t triangle)
{
    const uint32_t *index = mesh->triangles[triangle];
    return (struct corners){
        {mesh->vertices[index[0]], mesh->vertices[index[1]], mesh->vertices[index[2]]}};
}

/* The triangle's area, and its unit normal where that is more than 0. */
static double measure(const struct corners *corners, ps_vec3 *normal)
{
    const ps_vec3 *p = corners->p;
    double ax = (double)p[1].x - p[0].x, ay = (double)p[1].y - p[0].y;
    double az = (double)p[1].z - p[0].z, bx = (double)p[2].x - p[0].x;
    double by = (double)p[2].y - p[0].y, bz = (double)p[2].z - p[0].z;
    double x = ay * bz - az * by, y = az * bx - ax * bz, z = ax * by - ay * bx;
    double length = sqrt(x * x + y * y + z * z);
    if (length > 0.0)
        *normal = (ps_vec3){(float)(x / length), (float)(y / length), (float)(z / length)};
    return 0.5 * length;
}

/* A point of a triangle by its shares of the corners. */
struct shares {
    float of[3];
};

/* The unit square to a triangle: folded along the diagonal rather than squeezed into a corner
 * (Heitz 2019, "A low-distortion map between triangle and square"). */
static struct shares shares_of(float u1, float u2)
{
    float half = 0.5f * ps_min(u1, u2), a = u1 - half, b = u2 - half;
    return (struct shares){{ps_max(1.0f - a - b, 0.0f), a, b}};
}

static ps_vec3 point_of(const struct corners *corners, const struct shares *shares)
{
    const ps_vec3 *p = corners->p;
    ps_vec3 along = ps_scale(ps_subtract(p[1], p[0]), shares->of[1]);
    along = ps_add_scaled(along, shares->of[2], ps_subtract(p[2], p[0]));
    return ps_add(p[0], along);
}

static ps_rgb pattern_at(const struct light_mesh *mesh, size_t triangle, ps_vec3 position,
                         const struct shares *shares)
{
    if (!mesh->pattern)
        return (ps_rgb){1, 1, 1};
    const struct shape_point point = {mesh->triangles[triangle],
                                      {shares->of[0], shares->of[1], shares->of[2]}};
    return mesh->pattern(mesh->pattern_user, position, &point);
}

static ps_rgb triangle_mean(const struct light_mesh *mesh, size_t triangle, size_t edge)
{
    struct corners corners = corners_of(mesh, triangle);
    ps_rgb sum = {0, 0, 0};
    for (size_t i = 0; i < edge; i++)
        for (size_t k = 0; k < edge; k++) {
            struct shares shares =
                shares_of(((float)i + 0.5f) / (float)edge, ((float)k + 0.5f) / (float)edge);
            ps_vec3 position = point_of(&corners, &shares);
            sum = ps_rgb_add(sum, pattern_at(mesh, triangle, position, &shares));
        }
    return ps_rgb_scale(sum, 1.0f / (float)(edge * edge));
}

/* The pattern's mean by a grid of points in each triangle. */
static ps_rgb mean_of_pattern(const struct light_surface *surface)
{
    const struct light_mesh *mesh = &surface->mesh;
    double red = 0.0, green = 0.0, blue = 0.0;
    if (!mesh->pattern || mesh->triangle_count == 0)
        return (ps_rgb){1, 1, 1};
    size_t edge = (size_t)sqrt((double)PATTERN_POINTS / (double)mesh->triangle_count);
    edge = edge < 1 ? 1 : (edge > PATTERN_EDGE ? PATTERN_EDGE : edge);
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        float probability = distribution_probability(&surface->by_area, i);
        if (!(probability > 0.0f))
            continue;
        ps_rgb mean = ps_rgb_scale(triangle_mean(mesh, i, edge), probability);
        red += (double)mean.r;
        green += (double)mean.g;
        blue += (double)mean.b;
    }
    return (ps_rgb){(float)red, (float)green, (float)blue};
}

/* Areas of the triangles, and their normals. */
static void measure_triangles(const struct light_surface *surface, float *areas)
{
    for (size_t i = 0; i < surface->mesh.triangle_count; i++) {
        struct corners corners = corners_of(&surface->mesh, i);
        surface->normals[i] = (ps_vec3){0, 0, 1};
        areas[i] = (float)measure(&corners, &surface->normals[i]);
    }
}

static ps_result distribute_by_area(struct light_surface *surface, struct error *error)
{
    size_t count = surface->mesh.triangle_count;
    float *areas = calloc(count, sizeof *areas);
    surface->normals = calloc(count, sizeof *surface->normals);
    ps_result result = PS_OK;
    if (areas && surface->normals) {
        measure_triangles(surface, areas);
        result = distribution_create(areas, count, &surface->by_area, error);
    } else {
        result = error_memory(error, count * (sizeof *areas + sizeof *surface->normals),
                              "an emissive mesh");
    }
    free(areas);
    return result;
}

ps_result light_surface_create(const struct light_mesh *mesh, ps_rgb radiance, bool both_sides,
                               struct light_surface *surface, struct error *error)
{
    *surface = (struct light_surface){
        .mesh = *mesh,
        .radiance = radiance,
        .both_sides = both_sides,
    };
    if (mesh->triangle_count == 0)
        return PS_OK;
    ps_result result = distribute_by_area(surface, error);
    if (result != PS_OK) {
        light_surface_release(surface);
        return result;
    }
    surface->area = (float)surface->by_area.total;
    surface->mean = mean_of_pattern(surface);
    return PS_OK;
}

void light_surface_release(struct light_surface *surface)
{
    distribution_release(&surface->by_area);
    free(surface->normals);
    *surface = (struct light_surface){.area = 0.0f};
}

/* Power of the surface where its pattern is 1. */
static ps_rgb plain_power(const struct light_surface *surface)
{
    float sides = surface->both_sides ? 2.0f : 1.0f;
    return ps_rgb_scale(surface->radiance, sides * PS_PI * surface->area);
}

ps_rgb light_surface_power(const struct light_surface *surface)
{
    return ps_rgb_multiply(plain_power(surface), surface->mean);
}

/* The least that the pattern in a triangle is taken to be: a part of the mean of the light, and a
 * number, since the points that tell both may miss all that shines. */
#define LEAST_PATTERN 0.05f
#define LEAST_RADIANCE 1e-3f
#define TRIANGLE_EDGE 2

struct light_cluster light_surface_cluster(const struct light_surface *surface, size_t triangle)
{
    struct corners corners = corners_of(&surface->mesh, triangle);
    const ps_vec3 *p = corners.p;
    ps_rgb pattern = surface->mean;
    if (surface->mesh.pattern) {
        ps_rgb mean = triangle_mean(&surface->mesh, triangle, TRIANGLE_EDGE);
        ps_rgb least = ps_rgb_scale(surface->mean, LEAST_PATTERN);
        pattern = (ps_rgb){ps_max(mean.r, ps_max(least.r, LEAST_RADIANCE)),
                           ps_max(mean.g, ps_max(least.g, LEAST_RADIANCE)),
                           ps_max(mean.b, ps_max(least.b, LEAST_RADIANCE))};
    }
    ps_rgb radiance = ps_rgb_multiply(surface->radiance, pattern);
    return (struct light_cluster){
        .low = {fminf(p[0].x, fminf(p[1].x, p[2].x)), fminf(p[0].y, fminf(p[1].y, p[2].y)),
                fminf(p[0].z, fminf(p[1].z, p[2].z))},
        .high = {fmaxf(p[0].x, fmaxf(p[1].x, p[2].x)), fmaxf(p[0].y, fmaxf(p[1].y, p[2].y)),
                 fmaxf(p[0].z, fmaxf(p[1].z, p[2].z))},
        .axis = surface->normals[triangle],
        .cos_theta_o = 1.0f,
        .cos_theta_e = 0.0f,
        .intensity =
            light_surface_triangle_area(surface, triangle) * (radiance.r + radiance.g + radiance.b),
        .both_sides = surface->both_sides,
    };
}

float light_surface_triangle_area(const struct light_surface *surface, size_t triangle)
{
    struct corners corners = corners_of(&surface->mesh, triangle);
    ps_vec3 normal;
    return (float)measure(&corners, &normal);
}

struct surface_point {
    ps_vec3 position, normal; /* the front's */
    ps_rgb pattern;
};

static struct surface_point choose_in_triangle(const struct light_surface *surface, size_t triangle,
                                               float u1, float u2)
{
    struct surface_point point;
    struct corners corners = corners_of(&surface->mesh, triangle);
    struct shares shares = shares_of(u1, u2);
    point.normal = surface->normals[triangle];
    point.position = point_of(&corners, &shares);
    point.pattern = pattern_at(&surface->mesh, triangle, point.position, &shares);
    return point;
}

/* Needs an area. */
static struct surface_point choose_point(const struct light_surface *surface, float u1, float u2)
{
    size_t triangle = distribution_choose(&surface->by_area, u1, &u1);
    return choose_in_triangle(surface, triangle, u1, u2);
}

ps_rgb light_surface_emit(const struct light_surface *surface, const float u[4], ps_ray *ray,
                          ps_vec3 *normal)
{
    if (!(surface->area > 0.0f))
        return (ps_rgb){0, 0, 0};
    float u1 = u[0];
    struct surface_point point = choose_point(surface, u[2], u[3]);
    bool is_back = surface->both_sides && light_take_half(&u1);
    *normal = is_back ? ps_scale(point.normal, -1.0f) : point.normal;
    *ray = (ps_ray){point.position, 0.0f, ps_cosine_direction(*normal, u1, u[1]), INFINITY};
    return ps_rgb_multiply(plain_power(surface), point.pattern);
}

/* Cosine at the light towards a point that looks along `direction`; not above 0 where it sees a
 * back that does not shine. */
static inline float cosine_at_light(ps_vec3 direction, ps_vec3 normal, bool both_sides)
{
    float cosine = -ps_dot(direction, normal);
    return both_sides ? fabsf(cosine) : cosine;
}

ps_vec3 light_surface_normal(const struct light_surface *surface, const float numbers[2])
{
    return choose_point(surface, numbers[0], numbers[1]).normal;
}

float light_surface_pdf(const struct light_surface *surface, ps_vec3 direction, float distance,
                        ps_vec3 normal)
{
    return light_pdf_of_area(surface->area, distance,
                             cosine_at_light(direction, normal, surface->both_sides));
}

float light_surface_arrival(const struct light_surface *surface, ps_vec3 direction, float distance,
                            ps_vec3 normal)
{
    return light_arrival_by_cosine(surface->both_sides ? 2.0f : 1.0f, distance,
                                   cosine_at_light(direction, normal, surface->both_sides));
}

/* Points of the light, seen from as many places at once: a point costs four divisions and a root,
 * each of which waits for the one before. */
#define LANES 16

struct sights {
    float x[LANES], y[LANES], z[LANES]; /* the way there; then its direction */
    float normal_x[LANES], normal_y[LANES], normal_z[LANES];
    float distance[LANES], pdf[LANES], inverse_pdf[LANES];
    ps_rgb pattern[LANES];
};

static void choose_points(const struct light_surface *surface, const ps_vec3 *positions,
                          const float (*numbers)[2], size_t n, struct sights *sights)
{
    for (size_t i = 0; i < n; i++) {
        struct surface_point point = choose_point(surface, numbers[i][0], numbers[i][1]);
        ps_vec3 way = ps_subtract(point.position, positions[i]);
        sights->x[i] = way.x;
        sights->y[i] = way.y;
        sights->z[i] = way.z;
        sights->normal_x[i] = point.normal.x;
        sights->normal_y[i] = point.normal.y;
        sights->normal_z[i] = point.normal.z;
        sights->pattern[i] = point.pattern;
    }
}

static void find_densities(float area, bool both_sides, size_t n, struct sights *sights)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++) {
        ps_vec3 way = {sights->x[i], sights->y[i], sights->z[i]};
        ps_vec3 normal = {sights->normal_x[i], sights->normal_y[i], sights->normal_z[i]};
        float distance = ps_length(way);
        ps_vec3 direction = ps_scale(way, distance > 0.0f ? 1.0f / distance : 0.0f);
        float pdf =
            light_pdf_of_area(area, distance, cosine_at_light(direction, normal, both_sides));
        sights->x[i] = direction.x;
        sights->y[i] = direction.y;
        sights->z[i] = direction.z;
        sights->distance[i] = distance;
        sights->pdf[i] = pdf;
        sights->inverse_pdf[i] = pdf > 0.0f ? 1.0f / pdf : 0.0f;
    }
}

static void sample_some(const struct light_surface *surface, const ps_vec3 *positions,
                        const float (*numbers)[2], size_t n, struct light_sample *samples)
{
    struct sights sights;
    choose_points(surface, positions, numbers, n, &sights);
    find_densities(surface->area, surface->both_sides, n, &sights);
    for (size_t i = 0; i < n; i++) {
        ps_rgb radiance = ps_rgb_multiply(surface->radiance, sights.pattern[i]);
        samples[i] = (struct light_sample){
            .direction = {sights.x[i], sights.y[i], sights.z[i]},
            .distance = sights.distance[i],
            .weight = ps_rgb_scale(radiance, sights.inverse_pdf[i]),
            .pdf = sights.pdf[i],
        };
    }
}

void light_surface_sample(const struct light_surface *surface, const ps_vec3 *positions,
                          const float (*numbers)[2], size_t n, struct light_sample *samples)
{
    for (size_t first = 0; first < n; first += LANES) {
        size_t some = n - first < LANES ? n - first : LANES;
        if (surface->area > 0.0f)
            sample_some(surface, positions + first, numbers + first, some, samples + first);
        else
            memset(samples + first, 0, some * sizeof *samples);
    }
}

void light_surface_sample_triangle(const struct light_surface *surface, size_t triangle,
                                   ps_vec3 position, const float numbers[2],
                                   struct light_sample *sample)
{
    struct surface_point point = choose_in_triangle(surface, triangle, numbers[0], numbers[1]);
    ps_vec3 way = ps_subtract(point.position, position);
    float distance = ps_length(way);
    ps_vec3 direction = ps_scale(way, distance > 0.0f ? 1.0f / distance : 0.0f);
    float cosine = cosine_at_light(direction, point.normal, surface->both_sides);
    float area = light_surface_triangle_area(surface, triangle);
    float pdf = light_pdf_of_area(area, distance, cosine);
    ps_rgb radiance = ps_rgb_multiply(surface->radiance, point.pattern);
    *sample = (struct light_sample){
        .direction = direction,
        .distance = distance,
        .weight = ps_rgb_scale(radiance, pdf > 0.0f ? 1.0f / pdf : 0.0f),
        .pdf = light_pdf_of_area(surface->area, distance, cosine),
    };
}
