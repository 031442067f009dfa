/* light_kinds.h: the functions of light.h for each kind of light, and what they share. Only for
 * light.c and light_*.c. */
#ifndef SCENE_LIGHT_KINDS_H
#define SCENE_LIGHT_KINDS_H

#include "scene/light.h"
#include <psplat/math.h>

#define PI_DOUBLE 3.14159265358979323846

/* A ray through the scene that travels along -`towards`: from a disc across it, just outside of the
 * bounding sphere. */
ps_ray light_ray_into_scene(const struct light_bounds *bounds, ps_vec3 towards, float u1, float u2);

/* The area of that disc. */
float light_scene_area(const struct light_bounds *bounds);

/* Direction uniform over the cone around unit `axis` whose half angle has versine (1 - cos)
 * `versine`. Unlike ps_cone_direction it keeps its precision in cones as narrow as the sun's. */
ps_vec3 light_cone_direction(ps_vec3 axis, float versine, float u1, float u2);

/* 1 - cos(a), by its sine: no cancellation where the angle is small. */
float light_versine_of_sine2(float sine2);

/* Direction uniform over all. */
ps_vec3 light_any_direction(float u1, float u2);

ps_result light_spot_create(const struct light_description *description, struct light_spot *spot,
                            struct error *error);
struct light_cluster light_spot_cluster(const struct light_spot *spot);
ps_rgb light_spot_power(const struct light_spot *spot);
ps_rgb light_spot_intensity(const struct light_spot *spot, ps_vec3 direction);
ps_rgb light_spot_emit(const struct light_spot *spot, const float u[4], ps_ray *ray);
bool light_spot_sample(const struct light_spot *spot, ps_vec3 position,
                       struct light_sample *sample);
float light_spot_arrival(const struct light_spot *spot, ps_vec3 direction, float distance);

ps_result light_sun_create(const struct light_description *description,
                           const struct light_bounds *bounds, struct light_sun *sun,
                           struct error *error);
ps_rgb light_sun_power(const struct light_sun *sun);
ps_rgb light_sun_radiance(const struct light_sun *sun, ps_vec3 direction);
ps_rgb light_sun_emit(const struct light_sun *sun, const float u[4], ps_ray *ray);
void light_sun_sample(const struct light_sun *sun, float u1, float u2, struct light_sample *sample);
float light_sun_pdf(const struct light_sun *sun, ps_vec3 direction);

ps_result light_surface_create(const struct light_mesh *mesh, ps_rgb radiance, bool both_sides,
                               struct light_surface *surface, struct error *error);
void light_surface_release(struct light_surface *surface);
ps_rgb light_surface_power(const struct light_surface *surface);
ps_rgb light_surface_emit(const struct light_surface *surface, const float u[4], ps_ray *ray,
                          ps_vec3 *normal);
void light_surface_sample(const struct light_surface *surface, const ps_vec3 *positions,
                          const float (*numbers)[2], size_t n, struct light_sample *samples);
ps_vec3 light_surface_normal(const struct light_surface *surface, const float numbers[2]);
float light_surface_pdf(const struct light_surface *surface, ps_vec3 direction, float distance,
                        ps_vec3 normal);
float light_surface_arrival(const struct light_surface *surface, ps_vec3 direction, float distance,
                            ps_vec3 normal);

/* Not from the table, which rounds the small ones away. */
float light_surface_triangle_area(const struct light_surface *surface, size_t triangle);
struct light_cluster light_surface_cluster(const struct light_surface *surface, size_t triangle);
void light_surface_sample_triangle(const struct light_surface *surface, size_t triangle,
                                   ps_vec3 position, const float numbers[2],
                                   struct light_sample *sample);

struct light_cluster light_sphere_cluster(const struct light_sphere *sphere);
ps_rgb light_sphere_power(const struct light_sphere *sphere);
ps_rgb light_sphere_emit(const struct light_sphere *sphere, const float u[4], ps_ray *ray,
                         ps_vec3 *normal);
bool light_sphere_sample(const struct light_sphere *sphere, ps_vec3 position, float u1, float u2,
                         struct light_sample *sample);
float light_sphere_pdf(const struct light_sphere *sphere, ps_vec3 position, ps_vec3 direction,
                       float distance, ps_vec3 normal);
float light_sphere_arrival(const struct light_sphere *sphere, ps_vec3 position, ps_vec3 direction,
                           float distance, ps_vec3 normal);

ps_result light_sky_create(const struct light_description *description,
                           const struct light_bounds *bounds, const struct sky_picture *picture,
                           struct light_sky *sky, struct error *error);
void light_sky_release(struct light_sky *sky);
ps_rgb light_sky_power(const struct light_sky *sky);
ps_rgb light_sky_radiance(const struct light_sky *sky, ps_vec3 direction);
ps_rgb light_sky_emit(const struct light_sky *sky, const float u[4], ps_ray *ray);
void light_sky_sample(const struct light_sky *sky, ps_vec3 normal, const float u[2],
                      struct light_sample *sample);
float light_sky_pdf(const struct light_sky *sky, ps_vec3 normal, ps_vec3 direction);

/* Emission and sampling that surfaces share: density by solid angle of a point chosen uniformly
 * over an area, seen from `distance` at `cosine` to its normal; 0 where that is not positive.
 * Compilers make vectors of it. */
static inline float light_pdf_of_area(float area, float distance, float cosine)
{
    float pdf = distance * distance / (cosine * area);
    bool any = (cosine > 0.0f) & (pdf < INFINITY);
    return any ? pdf : 0.0f;
}

/* light_arrival of a point of a surface that sends rays out by their cosine, of `sides` sides,
 * where both ways of drawing points are even over the area. */
static inline float light_arrival_by_cosine(float sides, float distance, float cosine)
{
    float arrival = cosine / (sides * PS_PI * distance * distance);
    bool any = (cosine > 0.0f) & (arrival < INFINITY);
    return any ? arrival : 0.0f;
}

/* light_arrival of sun and sky, whose rays are even over the disc: both draw directions alike. */
static inline float light_arrival_from_afar(const struct light_bounds *bounds)
{
    float area = light_scene_area(bounds);
    return area > 0.0f ? 1.0f / area : 0.0f;
}

/* Splits a number in [0,1) in two: which half it is in, and where in that half. */
bool light_take_half(float *u);

#endif
