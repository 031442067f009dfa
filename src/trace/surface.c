#include "trace/surface.h"

#include "scene/bump.h"
#include "scene/triangles.h"

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

/* Texture coordinates; 0 where the mesh has none. */
static void mesh_uv(const struct shape *shape, uint32_t triangle, float u, float v, float uv[2])
{
    uv[0] = uv[1] = 0.0f;
    const uint32_t *corner = shape->triangles[triangle];
    for (int k = 0; k < 2 && shape->uv; k++)
        uv[k] = (1.0f - u - v) * shape->uv[corner[0]][k] + u * shape->uv[corner[1]][k] +
                v * shape->uv[corner[2]][k];
}

/* How the position moves with the texture coordinates; zero where they say nothing. */
static void mesh_tangents(const struct shape *shape, uint32_t triangle, ps_vec3 *by_u,
                          ps_vec3 *by_v)
{
    *by_u = *by_v = (ps_vec3){0, 0, 0};
    if (!shape->uv)
        return;
    const uint32_t *corner = shape->triangles[triangle];
    const float *uv0 = shape->uv[corner[0]], *uv1 = shape->uv[corner[1]];
    const float *uv2 = shape->uv[corner[2]];
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
    hit->texture_point = interpolate(shape->vertices, shape->triangles[at->triangle], at->u, at->v);
    mesh_uv(shape, at->triangle, at->u, at->v, hit->uv);
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

/* The front's smoothed normal in the shape's space. */
static ps_vec3 smooth_normal(const struct shape *shape, const struct intersection *at)
{
    if (shape->normals)
        return unit(interpolate(shape->normals, shape->triangles[at->triangle], at->u, at->v));
    return unit(at->normal);
}

/* By the material's normal map and bumps, in the shape's space. */
static ps_vec3 bend(const struct placed *placed, const struct material *material,
                    const struct intersection *at, const ps_hit *hit, ps_vec3 normal)
{
    ps_vec3 by_u, by_v;
    const struct shape *shape = placed->shape;
    if (shape->kind == SHAPE_SPHERE)
        shape_sphere_tangents(shape, ps_normalize(ps_subtract(hit->texture_point, shape->center)),
                              &by_u, &by_v);
    else
        mesh_tangents(shape, at->triangle, &by_u, &by_v);
    if (material->normal_map)
        normal = bump_normal_map(material->normal_map, hit->uv, normal, by_u, by_v);
    if (material->has_bump)
        normal = bump_bump(&material->bump, hit->texture_point, hit->uv, normal, by_u, by_v);
    return normal;
}

/* Turns both normals to the side that the ray came from. */
static void face_ray(const ps_ray *ray, ps_hit *hit)
{
    if (ps_dot(hit->geometric_normal, ray->direction) > 0.0f) {
        hit->geometric_normal = ps_scale(hit->geometric_normal, -1.0f);
        hit->normal = ps_scale(hit->normal, -1.0f);
        hit->flags |= PS_HIT_BACK;
    }
    /* Near the outline of a coarse mesh a smoothed normal may turn away from who sees it. */
    if (ps_dot(hit->normal, ray->direction) >= 0.0f)
        hit->normal = hit->geometric_normal;
}

ps_hit surface_resolve(const struct scene *scene, const ps_ray *ray, const struct intersection *at)
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
    locate(&placed, ray, at, &hit);
    hit.normal = hit.geometric_normal;
    bool bent = material->normal_map || material->has_bump;
    if (bent || placed.shape->normals) {
        ps_vec3 normal = smooth_normal(placed.shape, at);
        if (bent)
            normal = bend(&placed, material, at, &hit, normal);
        hit.normal = normal_to_world(&placed, normal);
    }
    face_ray(ray, &hit);
    hit.albedo = material_albedo(material, scene->microfacets, &hit, ray->direction);
    hit.roughness = material->specular ? material_roughness(material, &hit) : 1.0f;
    return hit;
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
    return material_is_opaque(material, hit.texture_point, hit.uv);
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
    ps_hit hit = surface_resolve(scene, ray, &at);
    hit.position = position;
    return hit;
}
