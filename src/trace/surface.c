#include "trace/surface.h"

#include "base/sample.h"
#include "scene/bump.h"
#include "scene/ray_cone.h"
#include "scene/triangles.h"
#include <assert.h>
#include <string.h>

/* The shape, and how it stands in the world. */
struct placed {
    const struct shape *shape;
    const struct instance *instance; /* NULL: as it is */
    uint32_t object, material;
};

static struct placed find(const struct scene *scene, const struct intersection *at)
{
    if (at->instance == NO_INSTANCE) {
        const struct shape *shape = &scene->shapes[at->shape];
        return (struct placed){shape, NULL, at->shape, shape->material};
    }
    const struct instance *instance = &scene->instances[at->instance];
    const struct shape *shape = &scene->shapes[instance->group->first_shape + at->shape];
    uint32_t material = instance->material == NO_MATERIAL ? shape->material : instance->material;
    return (struct placed){shape, instance, instance->first_object + at->shape, material};
}

/* By the largest component first: the square of a very small or large one is no float. */
static ps_vec3 unit(ps_vec3 n)
{
    float largest = ps_max(fabsf(n.x), ps_max(fabsf(n.y), fabsf(n.z)));
    return ps_normalize(ps_scale(n, 1.0f / largest));
}

static ps_vec3 normal_to_world(const struct placed *placed, ps_vec3 n)
{
    const struct instance *instance = placed->instance;
    return unit(instance ? ps_scale(affine_normal(&instance->placement, n), instance->front) : n);
}

static ps_vec3 interpolate(const ps_vec3 *values, const uint32_t corner[3], float u, float v)
{
    ps_vec3 p = ps_scale(values[corner[0]], 1.0f - u - v);
    p = ps_add_scaled(p, u, values[corner[1]]);
    return ps_add_scaled(p, v, values[corner[2]]);
}

/* The place in a mesh. */
static struct shape_point point_of(const struct shape *shape, const struct intersection *at)
{
    return (struct shape_point){shape->triangles[at->triangle],
                                {1.0f - at->u - at->v, at->u, at->v}};
}

/* How the position moves with the texture coordinates; zero where they say nothing. */
static void mesh_tangents(const struct shape *shape, const float (*uv)[2], uint32_t triangle,
                          ps_vec3 *by_u, ps_vec3 *by_v)
{
    *by_u = *by_v = (ps_vec3){0, 0, 0};
    if (!uv)
        return;
    const uint32_t *corner = shape->triangles[triangle];
    const float *uv0 = uv[corner[0]], *uv1 = uv[corner[1]], *uv2 = uv[corner[2]];
    float u1 = uv1[0] - uv0[0], v1 = uv1[1] - uv0[1], u2 = uv2[0] - uv0[0], v2 = uv2[1] - uv0[1];
    float determinant = u1 * v2 - u2 * v1;
    if (!(fabsf(determinant) > 0.0f))
        return;
    ps_vec3 edge1 = ps_subtract(shape->vertices[corner[1]], shape->vertices[corner[0]]);
    ps_vec3 edge2 = ps_subtract(shape->vertices[corner[2]], shape->vertices[corner[0]]);
    float inverse = 1.0f / determinant;
    *by_u = ps_scale(ps_add_scaled(ps_scale(edge1, v2), -v1, edge2), inverse);
    *by_v = ps_scale(ps_add_scaled(ps_scale(edge2, u1), -u2, edge1), inverse);
}

static ps_vec3 sphere_outward(const struct placed *placed, const ps_ray *ray,
                              const struct intersection *at)
{
    if (placed->instance) /* Embree's normal, as the ray is in another space */
        return unit(at->normal);
    ps_vec3 p = ps_add_scaled(ray->origin, at->distance, ray->direction);
    return ps_normalize(ps_subtract(p, placed->shape->center));
}

/* Fills in where textures are looked up; `outward` is the normal of a sphere. */
static void locate_texture(const struct shape *shape, ps_vec3 outward,
                           const struct intersection *at, ps_hit *hit)
{
    if (shape->kind == SHAPE_SPHERE) {
        hit->texture_point = ps_add_scaled(shape->center, shape->radius, outward);
        shape_sphere_uv(shape, outward, hit->uv);
        return;
    }
    struct shape_point point = point_of(shape, at);
    hit->texture_point = interpolate(shape->vertices, shape->triangles[at->triangle], at->u, at->v);
    shape_mesh_uv((const float(*)[2])shape->uv, &point, hit->uv);
}

/* Fills in position and texture coordinates. */
static void locate(const struct placed *placed, const ps_ray *ray, const struct intersection *at,
                   ps_hit *hit)
{
    bool sphere = placed->shape->kind == SHAPE_SPHERE;
    ps_vec3 outward = sphere ? sphere_outward(placed, ray, at) : at->normal;
    locate_texture(placed->shape, outward, at, hit);
    hit->position = placed->instance
                        ? affine_point(&placed->instance->placement, hit->texture_point)
                        : hit->texture_point;
}

/* Puts what the mesh has for each vertex in place of the point. */
static void look_up(const struct shape *shape, const struct material *material,
                    const struct intersection *at, ps_hit *hit)
{
    assert(shape->kind == SHAPE_MESH);
    struct shape_point point = point_of(shape, at);
    hit->texture_point = material_texture_point(material, shape, &point, hit->texture_point);
}

/* The front's smoothed normal in the shape's space. */
static ps_vec3 smooth_normal(const struct shape *shape, const struct intersection *at)
{
    if (shape->normals)
        return unit(interpolate(shape->normals, shape->triangles[at->triangle], at->u, at->v));
    return unit(at->normal);
}

/* The derivatives of the position by what the pigment's image is looked up by, before the image's
 * own transform. */
static void tangents(const struct shape *shape, const struct pigment *pigment,
                     const struct intersection *at, ps_vec3 place, ps_vec3 *by_u, ps_vec3 *by_v)
{
    float(*uv)[2] = pigment->second_uv ? shape->second_uv : shape->uv;
    if (shape->kind == SHAPE_SPHERE)
        shape_sphere_tangents(shape, ps_normalize(ps_subtract(place, shape->center)), by_u, by_v);
    else
        mesh_tangents(shape, (const float(*)[2])uv, at->triangle, by_u, by_v);
}

/* By the material's normal map, in the shape's space; `place` is the point there. */
static ps_vec3 bend_by_map(const struct shape *shape, const struct pigment *map,
                           const struct intersection *at, ps_vec3 place, const ps_hit *hit,
                           ps_vec3 normal)
{
    ps_vec3 by_u, by_v;
    float uv[2];
    tangents(shape, map, at, place, &by_u, &by_v);
    pigment_tangents(map, &by_u, &by_v);
    pigment_place(map, hit->texture_point, hit->uv, uv);
    float log_width = ray_cone_log_width(hit) + map->log_scale;
    ps_vec3 bent = bump_normal_map(map->texture, uv, log_width, normal, by_u, by_v);
    float factor = map->colors[0].r;
    if (factor == 1.0f)
        return bent;
    ps_vec3 along = ps_scale(normal, ps_dot(bent, normal));
    return ps_normalize(ps_add_scaled(along, factor, ps_subtract(bent, along)));
}

static ps_vec3 bend(const struct shape *shape, const struct material *material,
                    const struct intersection *at, ps_vec3 place, const ps_hit *hit, ps_vec3 normal)
{
    if (material->has_normal_map)
        normal = bend_by_map(shape, &material->normal_map, at, place, hit, normal);
    if (material->has_bump) {
        ps_vec3 by_u, by_v;
        tangents(shape, &material->bump, at, place, &by_u, &by_v);
        normal = bump_bump(&material->bump, hit->texture_point, hit->uv, ray_cone_log_width(hit),
                           normal, by_u, by_v);
    }
    return normal;
}

/* --- ray cones
 * ----------------------------------------------------------------------------------- */

/* Of the parallelogram over a triangle's edges. */
static float uv_area(const float (*uv)[2], const uint32_t corner[3])
{
    const float *a = uv[corner[0]], *b = uv[corner[1]], *c = uv[corner[2]];
    return fabsf((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
}

static float area_in_world(const struct placed *placed, const uint32_t corner[3])
{
    ps_vec3 points[3];
    for (int i = 0; i < 3; i++) {
        points[i] = placed->shape->vertices[corner[i]];
        if (placed->instance)
            points[i] = affine_point(&placed->instance->placement, points[i]);
    }
    return ps_length(
        ps_cross(ps_subtract(points[1], points[0]), ps_subtract(points[2], points[0])));
}

/* How much of the texture coordinates' area a unit of the surface's area has; of two sets, the
 * smaller. */
static float uv_density(const struct placed *placed, uint32_t triangle)
{
    const struct shape *shape = placed->shape;
    if (shape->kind == SHAPE_SPHERE) /* in the mean; placed spheres have about this size */
        return 1.0f / (4.0f * PS_PI * shape->radius * shape->radius);
    const uint32_t *corner = shape->triangles[triangle];
    float area = INFINITY;
    if (shape->uv)
        area = uv_area((const float(*)[2])shape->uv, corner);
    if (shape->second_uv)
        area = fminf(area, uv_area((const float(*)[2])shape->second_uv, corner));
    return area < INFINITY ? area / area_in_world(placed, corner) : 0.0f;
}

/* As wide as the cone across its axis: on slanted surfaces the mean over its longer side would blur
 * along the shorter one. */
static uint32_t cone_flags(const struct placed *placed, const struct intersection *at,
                           enum material_filter filter, float spread)
{
    float width = spread * at->distance;
    if (filter == FILTER_IMAGES)
        return ray_cone_flags(0.5f * log2f(width * width * uv_density(placed, at->triangle)));
    float scale = placed->instance ? affine_log_scale(&placed->instance->placement) : 0.0f;
    return ray_cone_flags(log2f(width) - scale);
}

/* Turns both normals to the side that the ray came from. */
static void face_ray(const ps_ray *ray, bool diffuse, ps_hit *hit)
{
    if (ps_dot(hit->geometric_normal, ray->direction) > 0.0f) {
        hit->geometric_normal = ps_scale(hit->geometric_normal, -1.0f);
        hit->normal = ps_scale(hit->normal, -1.0f);
        hit->flags |= PS_HIT_BACK;
    }
    /* Near the outline of a coarse mesh a smoothed normal may turn away from who sees it. What is
     * diffuse alone looks the same from everywhere. */
    if (!diffuse && ps_dot(hit->normal, ray->direction) >= 0.0f)
        hit->normal = hit->geometric_normal;
}

ps_hit surface_resolve(const struct scene *scene, const ps_ray *ray, float spread,
                       const struct intersection *at)
{
    struct placed placed = find(scene, at);
    const struct material *material = &scene->materials[placed.material];
    ps_hit hit = {
        .distance = at->distance,
        .object = placed.object,
        .material = placed.material,
        .geometric_normal = normal_to_world(&placed, at->normal),
        .flags = (material->specular ? PS_HIT_SPECULAR : 0u) |
                 (material->emissive ? PS_HIT_EMISSIVE : 0u),
    };
    if (spread > 0.0f && material->filter != FILTER_NOTHING)
        hit.flags |= cone_flags(&placed, at, material->filter, spread);
    locate(&placed, ray, at, &hit);
    ps_vec3 place = hit.texture_point;
    if (material->lookup != LOOKUP_POINT)
        look_up(placed.shape, material, at, &hit);
    hit.normal = hit.geometric_normal;
    bool bent = material->has_normal_map || material->has_bump;
    if (bent || placed.shape->normals) {
        ps_vec3 normal = smooth_normal(placed.shape, at);
        if (bent)
            normal = bend(placed.shape, material, at, place, &hit, normal);
        hit.normal = normal_to_world(&placed, normal);
    }
    face_ray(ray, !material->specular, &hit);
    hit.albedo = material_albedo(material, scene->microfacets, &hit, ray->direction);
    hit.roughness = material->specular ? material_roughness(material, &hit) : 1.0f;
    return hit;
}

/* In (0, 1], a hash of the bits of the hit: the same for the same ray, and another for a ray that
 * hits a rounding error apart. Surfaces in one place have numbers of their own. */
static float number_of_point(const struct intersection *at, ps_vec3 place)
{
    uint32_t bits[3];
    memcpy(&bits[0], &place.x, sizeof bits[0]);
    memcpy(&bits[1], &place.y, sizeof bits[1]);
    memcpy(&bits[2], &place.z, sizeof bits[2]);
    uint64_t hash = sample_hash((uint64_t)at->instance << 32 | at->shape);
    hash = sample_hash(hash << 32 | at->triangle);
    for (int i = 0; i < 3; i++)
        hash = sample_hash(hash << 32 | bits[i]);
    return (float)((hash >> 8) + 1) * 0x1p-24f;
}

bool surface_is_specular(const struct scene *scene, const struct intersection *at)
{
    return scene->materials[find(scene, at).material].specular;
}

bool surface_is_opaque(const struct scene *scene, const struct intersection *at)
{
    struct placed placed = find(scene, at);
    const struct shape *shape = placed.shape;
    const struct material *material = &scene->materials[placed.material];
    if (!material->has_opacity)
        return true;
    ps_hit hit;
    locate_texture(shape, shape->kind == SHAPE_SPHERE ? unit(at->normal) : at->normal, at, &hit);
    struct opacity_place place = {hit.texture_point, {hit.uv[0], hit.uv[1]}};
    if (material->lookup != LOOKUP_POINT) {
        struct shape_point point = point_of(shape, at);
        place = material_opacity_place(material, shape, &point, hit.texture_point);
    }
    float coverage = material_coverage(material, &place);
    return coverage >= 1.0f ||
           (coverage > 0.0f && number_of_point(at, hit.texture_point) <= coverage);
}

bool surface_shows_side(const struct scene *scene, const struct intersection *at, ps_vec3 direction)
{
    struct placed placed = find(scene, at);
    if (!placed.shape->front_only && !(placed.instance && placed.instance->front_only))
        return true;
    return ps_dot(at->normal, direction) <= 0.0f;
}

/* The position in the world of a point of a shape, and at->normal there. */
static ps_vec3 place_of(const struct placed *placed, struct intersection *at)
{
    const struct shape *shape = placed->shape;
    ps_vec3 position;
    if (shape->kind == SHAPE_SPHERE) {
        const float weights[2] = {at->u, at->v};
        at->normal = ps_normalize(triangles_on_sphere(at->triangle, weights));
        position = ps_add_scaled(shape->center, shape->radius, at->normal);
    } else {
        const uint32_t *corner = shape->triangles[at->triangle];
        ps_vec3 first = shape->vertices[corner[0]];
        position = interpolate(shape->vertices, corner, at->u, at->v);
        at->normal = ps_cross(unit(ps_subtract(shape->vertices[corner[1]], first)),
                              unit(ps_subtract(shape->vertices[corner[2]], first)));
    }
    return placed->instance ? affine_point(&placed->instance->placement, position) : position;
}

ps_hit surface_at(const struct scene *scene, const ps_surface_point *point, ps_ray *ray)
{
    const struct instance *instance = scene_instance_of(scene, point->object);
    struct intersection at = {
        .instance = instance ? (uint32_t)(instance - scene->instances) : NO_INSTANCE,
        .shape = instance ? point->object - instance->first_object : point->object,
        .triangle = point->triangle,
        .u = point->u,
        .v = point->v,
        .distance = scene->surface_offset,
    };
    /* Mirrored triangles are given with these two corners exchanged (scene/triangles.c). */
    if (instance && instance->front < 0.0f) {
        at.u = point->v;
        at.v = point->u;
    }
    struct placed placed = find(scene, &at);
    ps_vec3 position = place_of(&placed, &at);
    ps_vec3 outward = normal_to_world(&placed, at.normal);
    ray->direction = ps_scale(outward, point->back ? 1.0f : -1.0f);
    ray->origin = ps_add_scaled(position, -at.distance, ray->direction);
    ray->tnear = 0.0f;
    ray->tfar = INFINITY;
    if (!surface_is_opaque(scene, &at))
        return (ps_hit){.distance = INFINITY, .object = PS_NO_OBJECT};
    ps_hit hit = surface_resolve(scene, ray, 0.0f, &at);
    hit.position = position;
    return hit;
}
