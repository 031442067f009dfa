/* light_sun.c: light from one direction, or from a small disc of the sky of even radiance L.
 *
 * A disc of half angle a gives a surface that faces it the irradiance E = pi L sin^2 a. Shadow rays
 * and light paths choose directions uniformly over its cone. Light paths start on a disc across
 * their own direction that is as large as the scene (Pharr, Jakob and Humphreys, "Physically based
 * rendering", on distant lights), so that the flux is L * solid angle * pi r^2, or E pi r^2 where
 * the sun is a point. That is a little more than E pi r^2 for a sun with an angle: a disc across
 * the sun's axis would not cover the scene for the rays at its rim.
 */
#include "scene/light_kinds.h"

/* Radians: narrower half angles are below what directions in single precision tell apart, so that
 * such a sun is a point. */
#define NARROWEST 1e-6

static float solid_angle(const struct light_sun *sun)
{
    return 2.0f * PS_PI * sun->versine;
}

static bool is_delta(const struct light_sun *sun)
{
    return !(sun->versine > 0.0f);
}

/* `projected`: solid angle times cosine, pi sin^2 a. */
static ps_result set_radiance(const struct light_description *description, float projected,
                              struct light_sun *sun, struct error *error)
{
    if (description->unit == UNIT_IRRADIANCE) {
        sun->irradiance = description->amount;
        if (!is_delta(sun))
            sun->radiance = ps_rgb_scale(description->amount, 1.0f / projected);
        return PS_OK;
    }
    if (description->unit != UNIT_RADIANCE)
        return error_set(error, PS_ERROR_INVALID, "a sun needs its irradiance or its radiance");
    if (is_delta(sun))
        return error_set(error, PS_ERROR_INVALID,
                         "a sun without an angle has no radiance; give its irradiance");
    sun->radiance = description->amount;
    sun->irradiance = ps_rgb_scale(description->amount, projected);
    return PS_OK;
}

ps_result light_sun_create(const struct light_description *description,
                           const struct light_bounds *bounds, struct light_sun *sun,
                           struct error *error)
{
    double half = description->angle * (PI_DOUBLE / 360.0);
    double sine = sin(half), sine_of_half = sin(0.5 * half);
    *sun = (struct light_sun){
        .towards = ps_scale(ps_normalize(description->direction), -1.0f),
        .versine = half > NARROWEST ? (float)(2.0 * sine_of_half * sine_of_half) : 0.0f,
        .bounds = *bounds,
    };
    if (!isfinite(ps_dot(sun->towards, sun->towards)))
        return error_set(error, PS_ERROR_INVALID, "the sun's direction has no length");
    return set_radiance(description, (float)(PI_DOUBLE * sine * sine), sun, error);
}

/* Flux through a unit of area across the ray. */
static ps_rgb fluence(const struct light_sun *sun)
{
    return is_delta(sun) ? sun->irradiance : ps_rgb_scale(sun->radiance, solid_angle(sun));
}

ps_rgb light_sun_power(const struct light_sun *sun)
{
    return ps_rgb_scale(fluence(sun), light_scene_area(&sun->bounds));
}

/* |a - b|^2 = 2 (1 - cos): precise where the cosine itself is not. */
static bool is_within(const struct light_sun *sun, ps_vec3 direction)
{
    ps_vec3 apart = ps_subtract(direction, sun->towards);
    return !is_delta(sun) && ps_dot(apart, apart) <= 2.0f * sun->versine;
}

ps_rgb light_sun_radiance(const struct light_sun *sun, ps_vec3 direction)
{
    return is_within(sun, direction) ? sun->radiance : (ps_rgb){0, 0, 0};
}

static ps_vec3 choose_direction(const struct light_sun *sun, float u1, float u2)
{
    return is_delta(sun) ? sun->towards : light_cone_direction(sun->towards, sun->versine, u1, u2);
}

ps_rgb light_sun_emit(const struct light_sun *sun, const float u[4], ps_ray *ray)
{
    *ray = light_ray_into_scene(&sun->bounds, choose_direction(sun, u[0], u[1]), u[2], u[3]);
    return light_sun_power(sun);
}

void light_sun_sample(const struct light_sun *sun, float u1, float u2, struct light_sample *sample)
{
    *sample = (struct light_sample){
        .direction = choose_direction(sun, u1, u2),
        .distance = INFINITY,
        .weight = fluence(sun),
        .pdf = is_delta(sun) ? 0.0f : 1.0f / solid_angle(sun),
    };
}

float light_sun_pdf(const struct light_sun *sun, ps_vec3 direction)
{
    return is_within(sun, direction) ? 1.0f / solid_angle(sun) : 0.0f;
}
