/* surface.h: from the ray tracer's numbers to the surface that was met. */
#ifndef TRACE_SURFACE_H
#define TRACE_SURFACE_H

#include "scene/scene.h"

#define NO_INSTANCE UINT32_MAX

/* What the ray tracer says about a hit. */
struct intersection {
    uint32_t instance; /* NO_INSTANCE: a shape of the world */
    uint32_t shape;    /* of the world, or within the instance's group */
    uint32_t triangle;
    float u, v; /* barycentric, of the second and third corner */
    /* By the triangle's winding, or outward; any length, in the shape's own space. */
    ps_vec3 normal;
    float distance;
};

/* `spread`: of the cone that the ray stands for, by which it gets wider with the distance; 0:
 * none. */
ps_hit surface_resolve(const struct scene *scene, const ps_ray *ray, float spread,
                       const struct intersection *intersection);

/* The surface at a point of a triangle (scene/triangles.h), and a ray at right angles to the
 * triangle that meets it; its distance is INFINITY where the surface has a hole. The point's object
 * and triangle must be there. */
ps_hit surface_at(const struct scene *scene, const ps_surface_point *point, ps_ray *ray);

/* Whether the surface is there at all, for materials with cut-outs; the distance does not
 * matter. */
bool surface_is_opaque(const struct scene *scene, const struct intersection *intersection);

/* Whether it mirrors, refracts or has gloss. */
bool surface_is_specular(const struct scene *scene, const struct intersection *intersection);

/* Whether the camera sees the side that a ray of that direction meets; the direction in the space
 * of at->normal. */
bool surface_shows_side(const struct scene *scene, const struct intersection *at,
                        ps_vec3 direction);

#endif
