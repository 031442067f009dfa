#include "scene/triangles.h"

#include <psplat/math.h>

#define SEGMENTS 32                                                     /* around a sphere's axis */
static const uint32_t rings = PS_SPHERE_TRIANGLES / (2 * SEGMENTS) + 1; /* and the poles */

/* A shape of the world, or of an instance's group. */
struct placed_shape {
    const struct shape *shape;
    const struct instance *instance; /* NULL: it stands in the world */
    uint32_t object, material;
};

/* Number `index` of all; false past the last. */
static bool find_shape(const struct scene *scene, size_t index, size_t *instance,
                       struct placed_shape *placed)
{
    if (index < scene->world_shape_count) {
        const struct shape *shape = &scene->shapes[index];
        *placed = (struct placed_shape){shape, NULL, (uint32_t)index, shape->material};
        return true;
    }
    /* Objects of instances are numbered one after the other. */
    while (*instance < scene->instance_count) {
        const struct instance *at = &scene->instances[*instance];
        size_t within = index - at->first_object;
        if (within < at->group->shape_count) {
            const struct shape *shape = &scene->shapes[at->group->first_shape + within];
            uint32_t material = at->material == NO_MATERIAL ? shape->material : at->material;
            *placed = (struct placed_shape){shape, at, (uint32_t)index, material};
            return true;
        }
        ++*instance;
    }
    return false;
}

uint64_t triangles_of_shape(const struct shape *shape)
{
    return shape->kind == SHAPE_SPHERE ? PS_SPHERE_TRIANGLES : shape->triangle_count;
}

uint64_t triangles_count(const struct scene *scene)
{
    uint64_t count = 0;
    size_t instance = 0;
    struct placed_shape placed;
    for (size_t i = 0; find_shape(scene, i, &instance, &placed); i++)
        count += triangles_of_shape(placed.shape);
    return count;
}

/* Of the unit sphere: ring 0 is the pole at -y. */
static ps_vec3 on_sphere(uint32_t ring, uint32_t segment)
{
    float polar = PS_PI * (float)ring / (float)rings,
          around = 2.0f * PS_PI * (float)segment / SEGMENTS;
    return (ps_vec3){sinf(polar) * cosf(around), -cosf(polar), -sinf(polar) * sinf(around)};
}

/* Triangle `index` of the unit sphere, counter-clockwise from outside: a fan at each pole, two for
 * each square between. */
static void sphere_triangle(uint32_t index, ps_vec3 corners[3])
{
    uint32_t strip = (index + SEGMENTS) / (2 * SEGMENTS); /* the ring below it */
    uint32_t place = (index + SEGMENTS) % (2 * SEGMENTS), segment = place / 2;
    bool upper = place % 2;
    if (strip == 0 || strip == rings - 1) { /* a fan has one triangle where others have two */
        segment = strip == 0 ? index : index - (PS_SPHERE_TRIANGLES - SEGMENTS);
        upper = strip == 0;
    }
    ps_vec3 left = on_sphere(strip, segment), right = on_sphere(strip, segment + 1);
    ps_vec3 above_left = on_sphere(strip + 1, segment),
            above_right = on_sphere(strip + 1, segment + 1);
    corners[0] = left;
    corners[1] = upper ? above_right : right;
    corners[2] = upper ? above_left : above_right;
}

ps_vec3 triangles_on_sphere(uint32_t triangle, const float weights[2])
{
    ps_vec3 corners[3];
    sphere_triangle(triangle, corners);
    ps_vec3 p = ps_scale(corners[0], 1.0f - weights[0] - weights[1]);
    p = ps_add_scaled(p, weights[0], corners[1]);
    return ps_add_scaled(p, weights[1], corners[2]);
}

static ps_vec3 area_vector(const ps_vec3 corners[3])
{
    return ps_scale(
        ps_cross(ps_subtract(corners[1], corners[0]), ps_subtract(corners[2], corners[0])), 0.5f);
}

/* By how much the triangles have to grow for the sphere's area. */
static float sphere_scale(void)
{
    double area = 0.0;
    for (uint32_t i = 0; i < PS_SPHERE_TRIANGLES; i++) {
        ps_vec3 corners[3];
        sphere_triangle(i, corners);
        area += (double)ps_length(area_vector(corners));
    }
    return (float)sqrt(4.0 * (double)PS_PI / area);
}

static void corners_of(const struct placed_shape *placed, uint64_t index, float scale,
                       ps_vec3 corners[3])
{
    const struct shape *shape = placed->shape;
    if (shape->kind == SHAPE_SPHERE) {
        sphere_triangle((uint32_t)index, corners);
        for (int i = 0; i < 3; i++)
            corners[i] = ps_add_scaled(shape->center, scale * shape->radius, corners[i]);
    } else {
        for (int i = 0; i < 3; i++)
            corners[i] = shape->vertices[shape->triangles[index][i]];
    }
}

static ps_triangle triangle_of(const struct placed_shape *placed, uint64_t index, float scale)
{
    ps_triangle triangle = {.object = placed->object, .material = placed->material};
    ps_vec3 *corners = triangle.vertices;
    corners_of(placed, index, scale, corners);
    if (placed->instance) {
        for (int i = 0; i < 3; i++)
            corners[i] = affine_point(&placed->instance->placement, corners[i]);
        if (placed->instance->front < 0.0f) {
            ps_vec3 swapped = corners[1];
            corners[1] = corners[2];
            corners[2] = swapped;
        }
    }
    ps_vec3 across = area_vector(corners);
    triangle.area = ps_length(across);
    triangle.normal = ps_normalize(across);
    return triangle;
}

size_t triangles_get(const struct scene *scene, uint64_t first, size_t n, ps_triangle *triangles)
{
    size_t done = 0, instance = 0;
    float scale = sphere_scale();
    struct placed_shape placed;
    for (size_t i = 0; done < n && find_shape(scene, i, &instance, &placed); i++) {
        uint64_t count = triangles_of_shape(placed.shape);
        for (; first < count && done < n; first++)
            triangles[done++] = triangle_of(&placed, first, scale);
        first -= first < count ? first : count;
    }
    return done;
}
