/* light_sphere.c: spheres that shine.
 *
 * Seen from outside a sphere fills a cone of sine r / d, over which shadow rays are uniform: the
 * least noise that an unoccluded sphere can have (Pharr, Jakob and Humphreys, "Physically based
 * rendering", on sampling spheres). All is said in versines (1 - cos), which stay precise for
 * spheres that are small or far. From inside, where the cone is all directions and the sphere is
 * near in some of them, points are uniform over its area.
 */
#include "scene/light_kinds.h"

static float area_of(const struct light_sphere *sphere)
{
    return 4.0f * PS_PI * sphere->radius * sphere->radius;
}

struct light_cluster light_sphere_cluster(const struct light_sphere *sphere)
{
    float r = sphere->radius;
    return (struct light_cluster){
        .low = ps_subtract(sphere->center, (ps_vec3){r, r, r}),
        .high = ps_add(sphere->center, (ps_vec3){r, r, r}),
        .axis = {0, 0, 1},
        .cos_theta_o = -1.0f,
        .cos_theta_e = 0.0f,
        .intensity = PS_PI * r * r * (sphere->radiance.r + sphere->radiance.g + sphere->radiance.b),
        .both_sides = sphere->both_sides,
    };
}

ps_rgb light_sphere_power(const struct light_sphere *sphere)
{
    float sides = sphere->both_sides ? 2.0f : 1.0f;
    return ps_rgb_scale(sphere->radiance, sides * PS_PI * area_of(sphere));
}

ps_rgb light_sphere_emit(const struct light_sphere *sphere, const float u[4], ps_ray *ray,
                         ps_vec3 *normal)
{
    float u1 = u[0];
    ps_vec3 outward = light_any_direction(u[2], u[3]);
    bool is_inward = sphere->both_sides && light_take_half(&u1);
    *normal = is_inward ? ps_scale(outward, -1.0f) : outward;
    ps_vec3 origin = ps_add_scaled(sphere->center, sphere->radius, outward);
    *ray = (ps_ray){origin, 0.0f, ps_cosine_direction(*normal, u1, u[1]), INFINITY};
    return light_sphere_power(sphere);
}

/* The versine of the cone that the sphere fills at distance d of its centre, more than r.
 * Differences of squares are products here, for points that almost touch the sphere. */
static float versine_of(const struct light_sphere *sphere, float d)
{
    float ratio = sphere->radius / d;
    float cosine = sqrtf((d - sphere->radius) / d * ((d + sphere->radius) / d));
    return ratio * ratio / (1.0f + cosine);
}

static bool sample_outside(const struct light_sphere *sphere, ps_vec3 to_center, float d, float u1,
                           float u2, struct light_sample *sample)
{
    float versine = versine_of(sphere, d), below = u1 * versine;
    if (!(versine > 0.0f))
        return false;
    float solid_angle = 2.0f * PS_PI * versine;
    /* Where the ray enters: d cos - sqrt(r^2 - d^2 sin^2). */
    float sine = d * sqrtf(below * (2.0f - below));
    float half_chord = sqrtf(fmaxf(0.0f, (sphere->radius - sine) * (sphere->radius + sine)));
    *sample = (struct light_sample){
        .direction = light_cone_direction(ps_scale(to_center, 1.0f / d), versine, u1, u2),
        .distance = fmaxf(0.0f, d * (1.0f - below) - half_chord),
        .weight = ps_rgb_scale(sphere->radiance, solid_angle),
        .pdf = 1.0f / solid_angle,
    };
    return true;
}

static bool sample_inside(const struct light_sphere *sphere, ps_vec3 to_center, float u1, float u2,
                          struct light_sample *sample)
{
    ps_vec3 outward = light_any_direction(u1, u2);
    ps_vec3 to_light = ps_add_scaled(to_center, sphere->radius, outward);
    float distance = ps_length(to_light);
    if (!sphere->both_sides || !(distance > 0.0f))
        return false;
    ps_vec3 direction = ps_scale(to_light, 1.0f / distance);
    float pdf = light_pdf_of_area(area_of(sphere), distance, ps_dot(direction, outward));
    *sample =
        (struct light_sample){direction, distance, ps_rgb_scale(sphere->radiance, 1.0f / pdf), pdf};
    return pdf > 0.0f;
}

bool light_sphere_sample(const struct light_sphere *sphere, ps_vec3 position, float u1, float u2,
                         struct light_sample *sample)
{
    ps_vec3 to_center = ps_subtract(sphere->center, position);
    float d = ps_length(to_center);
    return d > sphere->radius ? sample_outside(sphere, to_center, d, u1, u2, sample)
                              : sample_inside(sphere, to_center, u1, u2, sample);
}

float light_sphere_pdf(const struct light_sphere *sphere, ps_vec3 position, ps_vec3 direction,
                       float distance, ps_vec3 normal)
{
    float d = ps_length(ps_subtract(sphere->center, position));
    if (!(d > sphere->radius))
        return sphere->both_sides
                   ? light_pdf_of_area(area_of(sphere), distance, ps_dot(direction, normal))
                   : 0.0f;
    float versine = versine_of(sphere, d);
    bool is_front = ps_dot(direction, normal) < 0.0f;
    return is_front && versine > 0.0f ? 1.0f / (2.0f * PS_PI * versine) : 0.0f;
}

/* From outside: cos / (pi * 4 pi r^2) is the density of the ray, d^2 / (2 pi versine cos) that of
 * the point. */
float light_sphere_arrival(const struct light_sphere *sphere, ps_vec3 position, ps_vec3 direction,
                           float distance, ps_vec3 normal)
{
    float d = ps_length(ps_subtract(sphere->center, position));
    float cosine = ps_dot(direction, normal), sides = sphere->both_sides ? 2.0f : 1.0f;
    if (!(d > sphere->radius))
        return sphere->both_sides ? light_arrival_by_cosine(sides, distance, cosine) : 0.0f;
    float arrival =
        versine_of(sphere, d) / (2.0f * PS_PI * sides * sphere->radius * sphere->radius);
    return cosine < 0.0f && arrival < INFINITY ? arrival : 0.0f;
}
