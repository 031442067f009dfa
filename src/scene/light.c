#include "scene/light.h"

#include <psplat/math.h>

static float cosine_of_degrees(double degrees)
{
    return (float)cos(degrees * (3.14159265358979323846 / 180.0));
}

struct light light_from_description(const struct light_description *description)
{
    struct light light = {
        .location = description->location,
        .axis = {0, 0, 1},
        .intensity = description->amount,
        .cos_radius = -1.0f,
        .cos_falloff = -1.0f,
    };
    if (description->kind == LIGHT_SPOT) {
        light.axis = ps_normalize(ps_subtract(description->point_at, description->location));
        light.cos_radius = cosine_of_degrees(description->radius);
        light.cos_falloff = cosine_of_degrees(description->falloff);
    }
    return light;
}

/* The fraction of full intensity at the cosine to the axis. */
static float edge(const struct light *light, float cosine)
{
    if (cosine >= light->cos_radius)
        return 1.0f;
    if (cosine <= light->cos_falloff)
        return 0.0f;
    float t = (cosine - light->cos_falloff) / (light->cos_radius - light->cos_falloff);
    return t * t * (3.0f - 2.0f * t);
}

ps_rgb light_power(const struct light *light)
{
    /* The cubic's mean over its range of cosines is 1/2. */
    float inside = 1.0f - light->cos_radius;
    float border = 0.5f * (light->cos_radius - light->cos_falloff);
    return ps_rgb_scale(light->intensity, 2.0f * PS_PI * (inside + border));
}

ps_rgb light_intensity(const struct light *light, ps_vec3 direction)
{
    /* Rounding may take a dot product past -1, where a light that shines all around would end. */
    float cosine = fmaxf(ps_dot(direction, light->axis), -1.0f);
    return ps_rgb_scale(light->intensity, edge(light, cosine));
}

ps_rgb light_emit(const struct light *light, float u1, float u2, ps_ray *ray)
{
    ps_vec3 direction = ps_cone_direction(light->axis, light->cos_falloff, u1, u2);
    *ray = (ps_ray){light->location, 0.0f, direction, INFINITY};
    float solid_angle = 2.0f * PS_PI * (1.0f - light->cos_falloff);
    return ps_rgb_scale(light_intensity(light, direction), solid_angle);
}
