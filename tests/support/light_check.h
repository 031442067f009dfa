/* light_check.h: light sources against what they promise, by means that are not theirs. */
#ifndef TESTS_SUPPORT_LIGHT_CHECK_H
#define TESTS_SUPPORT_LIGHT_CHECK_H

#include "scene/light.h"

/* What a ray from a point meets of a light: distance, and unit normal of the front. */
typedef bool (*meet_function)(const void *geometry, ps_vec3 origin, ps_vec3 direction,
                              float *distance, ps_vec3 *normal);

/* The nearest of a `struct light_mesh`'s triangles, from either side. */
bool meet_mesh(const void *mesh, ps_vec3 origin, ps_vec3 direction, float *distance,
               ps_vec3 *normal);
/* A `struct light_sphere`. */
bool meet_sphere(const void *sphere, ps_vec3 origin, ps_vec3 direction, float *distance,
                 ps_vec3 *normal);
/* Always, at INFINITY: sun and sky. */
bool meet_infinity(const void *nothing, ps_vec3 origin, ps_vec3 direction, float *distance,
                   ps_vec3 *normal);

/* A light as it is seen from a point: within a cone of half angle `degrees` around unit `axis`. */
struct light_view {
    const struct light *light;
    const struct light *density; /* whose pdf to expect; NULL: that of the light itself */
    ps_vec3 position, axis;
    double degrees;
    meet_function meet;
    const void *geometry;
    bool of_emission; /* the directions of light_emit, backwards, instead of light_sample's */
};

/* light_sample for one position; whether there is any light. */
bool sample_light(const struct light *light, ps_vec3 position, float u1, float u2,
                  struct light_sample *sample);

/* How likely the directions that are chosen are, by light_pdf: chi-squared over cells of the cone.
 * Fails where the pdf does not integrate to the share of samples that give light, or where a
 * direction leaves the cone. */
double light_view_fit(const struct light_view *view);

/* Fails unless each sample says where its ray meets the light, the density of that, and a weight of
 * `radiance` / pdf. */
void expect_samples_meet_light(const struct light_view *view, ps_rgb radiance);

/* Red irradiance of a point whose surroundings are empty, by a jittered grid of samples. */
double irradiance_by_samples(const struct light *light, ps_vec3 position, ps_vec3 normal);

/* Fails unless the flux of light paths has the light's power as its mean, all three colours. */
void expect_flux_is_power(const struct light *light, double tolerance);

/* Fails unless light paths bring a square plate, of unit normal `normal` and half edge `half`, the
 * irradiance that light_sample gives to it. */
void expect_plate_agrees(const struct light *light, ps_vec3 center, ps_vec3 normal, double half);

/* A light with the description, in a scene of radius 5 around (1, 2, 3); fails if it is refused. */
struct light light_of(const struct light_description *description,
                      const struct sky_picture *picture);

void expect_close(double value, double expected, double relative);

#endif
