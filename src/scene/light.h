/* light.h: light sources: what they send out, and what they give to a point.
 *
 * Two ways of sampling, which agree: light_emit starts a light path at the light, light_sample
 * looks from a point towards it. Lights with a surface (rectangles, discs, emissive objects) are
 * geometry that shines; here they are triangles or a sphere, and only rays that meet them tell what
 * is seen of them. Each kind has its file, light_*.c, which states the method.
 *
 * Units: W (flux), W/sr (intensity), W/m^2 (irradiance), W/(m^2 sr) (radiance), metres standing for
 * scene units; pdfs of directions are by solid angle. Lights are constant once made, so all
 * functions on a const light may run on any number of threads. No input gives a NaN: where a light
 * is dark, has no size or no meaning for a point, the answer is 0 or false.
 */
#ifndef SCENE_LIGHT_H
#define SCENE_LIGHT_H

#include "base/error.h"
#include "scene/description.h"
#include "scene/distribution.h"
#include "scene/light_cluster.h"
#include "scene/shape.h"

/* The sphere around the scene. Sun and sky, which are infinitely far, send light paths through a
 * disc of its radius. */
struct light_bounds {
    ps_vec3 center;
    float radius; /* 0: an empty scene, into which nothing shines */
};

/* A picture of all directions by longitude (columns) and latitude (rows), linear radiance. Row 0 is
 * at the top, towards +y. The middle column lies towards -z, and columns to the right of it towards
 * +x: looking along -z with y up one sees the picture as it is. Borrowed, and constant. */
struct sky_picture {
    uint32_t width, height; /* > 0 */
    const float (*rgb)[3];  /* width * height, finite; numbers below 0 count as 0 */
};

/* What the radiance of a mesh is multiplied with at a point of it: a texture. At least 0, a pure
 * function, called from any thread. */
typedef ps_rgb (*light_pattern)(const void *user, ps_vec3 position,
                                const struct shape_point *point);

/* Triangles that shine, in world space, counter-clockwise seen from the front, which shines. */
struct light_mesh {
    const ps_vec3 *vertices;
    const uint32_t (*triangles)[3];
    size_t triangle_count;
    light_pattern pattern; /* NULL: the same radiance all over */
    const void *pattern_user;
};

enum emitter { EMITTER_SPOT, EMITTER_SUN, EMITTER_MESH, EMITTER_SPHERE, EMITTER_SKY };

/* A point, or a spot. */
struct light_spot {
    ps_vec3 location;
    ps_vec3 axis;                  /* unit; where a spot points */
    ps_rgb intensity;              /* at the axis */
    float cos_radius, cos_falloff; /* -1 for a light that shines all around */
    float tightness;
    float unit_flux; /* W, at intensity 1 */
};

struct light_sun {
    ps_vec3 towards;   /* unit; from the scene to the middle of the sun */
    float versine;     /* 1 - cos of half its diameter; 0: a point */
    ps_rgb radiance;   /* black where it is a point */
    ps_rgb irradiance; /* across the beam */
    struct light_bounds bounds;
};

struct light_surface {
    struct light_mesh mesh;
    struct distribution by_area; /* of triangles */
    ps_vec3 *normals;            /* of the triangles' fronts, owned */
    float area;
    ps_rgb radiance; /* before the pattern */
    ps_rgb mean;     /* of the pattern, over the area */
    bool both_sides;
};

struct light_sphere {
    ps_vec3 center;
    float radius;
    ps_rgb radiance;
    bool both_sides;
};

struct light_sky {
    ps_rgb radiance;            /* factor on the picture, or all there is */
    struct sky_picture picture; /* rgb is NULL for a sky of one colour */
    struct distribution_2d by_radiance;
    float turn;     /* of the picture about y, in rotations */
    ps_rgb fluence; /* radiance integrated over all directions, W/m^2 */
    /* That from which most of the light comes: (integral of L)^2 / integral of L^2, of luminance. 4
     * pi for one colour, less than 0.01 sr where a sun is in the picture. */
    float solid_angle;
    struct light_bounds bounds;
};

struct light {
    enum emitter emitter;
    union {
        struct light_spot spot;
        struct light_sun sun;
        struct light_surface surface;
        struct light_sphere sphere;
        struct light_sky sky;
    };
};

/* --- making them --- */

/* A point, spot, sun or sky; the others are surfaces, see below. `picture`, for a sky, must outlive
 * the light; NULL: the sky has one colour. PS_ERROR_INVALID: the unit does not fit the light, a
 * direction has no length, the picture is empty or holds a number that is not finite, or the power
 * overflows; PS_ERROR_MEMORY; or PS_OK: release the light. */
ps_result light_create(const struct light_description *description,
                       const struct light_bounds *bounds, const struct sky_picture *picture,
                       struct light *light, struct error *error);

/* All that `mesh` points at must outlive the light. Triangles without area are legal.
 * PS_ERROR_MEMORY; PS_ERROR_INVALID: area or power overflow; or PS_OK: release the light. */
ps_result light_create_mesh(const struct light_mesh *mesh, ps_rgb radiance, bool both_sides,
                            struct light *light, struct error *error);

/* A sphere that shines outwards, with `both_sides` inwards too. Its power must
 * not overflow. Nothing to release. */
struct light light_create_sphere(ps_vec3 center, float radius, ps_rgb radiance, bool both_sides);

/* Frees what the light owns, and zeroes it; a zeroed light may be released again. */
void light_release(struct light *light);

/* --- lights that are surfaces, as geometry --- */

/* Radiance of a rectangle, disc or sphere of this area from its power or radiance: power is
 * pi * area * radiance, twice that from both sides. Black where there is no area. */
ps_rgb light_surface_radiance(const struct light_description *description, double area);

/* The corners of a rectangle and its two triangles, in front of which it shines. */
void light_rectangle_triangles(const struct light_description *description, ps_vec3 vertices[4],
                               uint32_t triangles[2][3]);

/* A fan of `segments` >= 3 triangles around the middle of a disc: a regular polygon of the disc's
 * area, so that power and radiance are those of the disc. Arrays of segments + 1 and segments. */
void light_disc_triangles(const struct light_description *description, size_t segments,
                          ps_vec3 *vertices, uint32_t (*triangles)[3]);

/* --- the whole light --- */

/* What the light is, in the words of the plugin interface. */
ps_light light_describe(const struct light *light);

/* Radiant flux, W; of sun and sky: through discs as large as the scene. Of a mesh with a pattern:
 * an estimate, good enough to share light paths by. */
ps_rgb light_power(const struct light *light);

/* Whether it shines from infinity: sun and sky. */
bool light_is_afar(const struct light *light);

/* Whether its shadows are so soft that its irradiance changes slowly from place to place: a sky,
 * but one with a sun in its picture. */
bool light_is_soft(const struct light *light);

/* The bounds of a light that is not afar, of triangle `triangle` of one that is a mesh. */
struct light_cluster light_bounds_of(const struct light *light, size_t triangle);

/* Whether it is a point, in place or direction, so that all its shadow rays from a point are one
 * and no other ray can meet it. */
bool light_is_delta(const struct light *light);

/* Intensity of a point or spot in unit direction `direction` away from it; black for others. */
ps_rgb light_intensity(const struct light *light, ps_vec3 direction);

/* Radiance that arrives out of infinity, seen in unit direction `direction`: of a sky, or a sun
 * with an angle; black for others. */
ps_rgb light_radiance_from(const struct light *light, ps_vec3 direction);

/* --- sampling --- */

/* Starts a light path: a ray from the light, and the flux (W) it stands for, value / pdf; its mean
 * is light_power. `u`: four numbers in [0,1), 0 and 1 for the direction, 2 and 3 for the position.
 * On a surface the ray starts where it is, `normal` being that of the side it leaves, for the
 * caller to move it off; else `normal` is 0. Rays of sun and sky start outside of the scene. */
ps_rgb light_emit(const struct light *light, const float u[4], ps_ray *ray, ps_vec3 *normal);

struct light_sample {
    ps_vec3 direction; /* unit, from the point to the light */
    float distance;    /* INFINITY: sun, sky */
    ps_rgb weight;     /* irradiance across the beam that the sample stands for: I / d^2 of a point,
                          radiance / pdf of others; irradiance is weight times cosine */
    float pdf;         /* 0: the light is a delta */
};

/* For each of n positions chooses a point of the light by two numbers in [0,1), and tells what it
 * gives there if nothing is between. Where that is nothing, the weight is 0. `normals`: unit, of
 * surfaces to which light counts by the cosine and nothing else, and 0 for others; NULL: of none.
 * Where one is given, a sky of one radiance is looked at by that cosine, and light_pdf does not
 * tell the density. */
void light_sample(const struct light *light, const ps_vec3 *positions, const ps_vec3 *normals,
                  const float (*numbers)[2], size_t n, struct light_sample *samples);

/* One sample of one triangle of a mesh that shines; its density is that of the whole mesh, see
 * light_pdf. */
void light_sample_triangle(const struct light *light, size_t triangle, ps_vec3 position,
                           const float numbers[2], struct light_sample *sample);

/* The normal of the light's surface, on the side that is seen, at what light_sample chose by the
 * two numbers; 0 where it has no surface. */
ps_vec3 light_sample_normal(const struct light *light, ps_vec3 position, const float numbers[2],
                            const struct light_sample *sample);

/* The density by which light_sample chooses `direction` from `position`, if a ray in that direction
 * meets the light at `distance`, where its front's unit normal is `normal`; of sun and sky these
 * two do not matter. Of a mesh it is that of this point alone: where others lie in line with it,
 * each has its own. 0 for a delta. */
float light_pdf(const struct light *light, ps_vec3 position, ps_vec3 direction, float distance,
                ps_vec3 normal);

/* That of a sun or a sky for a surface whose normal light_sample is given. */
float light_pdf_by_normal(const struct light *light, ps_vec3 normal, ps_vec3 direction);

/* The density by which light_emit sends a ray from a point of the light through an area across it
 * at `position`, 1/m^2, over the density by which light_sample draws the point there. `direction`,
 * `distance`: of the point, seen from there; `normal`: of its front. 0 where it does not shine
 * there. */
float light_arrival(const struct light *light, ps_vec3 position, ps_vec3 direction, float distance,
                    ps_vec3 normal);

/* The normal of the front of a point of the light, given that on the side that is seen from
 * `position`. */
ps_vec3 light_front(const struct light *light, ps_vec3 position, ps_vec3 seen);

#endif
