/* light.c: what every light can do, passed on to its kind. */
#include "scene/light.h"

#include "scene/light_kinds.h"
#include <assert.h>

#define SOFT_SKY 1.0f /* sr, from which most of its light comes */

static const ps_rgb black = {0, 0, 0};

/* False for NaN too. */
static bool is_light(ps_rgb value)
{
    float sum = value.r + value.g + value.b;
    return sum > 0.0f && isfinite(sum);
}

/* --- making them --- */

/* Passes the result on, but for a light whose power single precision can't hold. */
static ps_result check_power(ps_result result, struct light *light, struct error *error)
{
    if (result == PS_OK) {
        ps_rgb power = light_power(light);
        if (isfinite(power.r + power.g + power.b))
            return PS_OK;
        result = error_set(error, PS_ERROR_INVALID, "the light's power is too large a number");
    }
    light_release(light);
    return result;
}

static ps_result create_kind(const struct light_description *description,
                             const struct light_bounds *bounds, const struct sky_picture *picture,
                             struct light *light, struct error *error)
{
    *light = (struct light){.emitter = EMITTER_SPOT};
    switch (description->kind) {
    case LIGHT_POINT:
    case LIGHT_SPOT:
        return light_spot_create(description, &light->spot, error);
    case LIGHT_SUN:
        light->emitter = EMITTER_SUN;
        return light_sun_create(description, bounds, &light->sun, error);
    case LIGHT_SKY:
        light->emitter = EMITTER_SKY;
        return light_sky_create(description, bounds, picture, &light->sky, error);
    case LIGHT_RECTANGLE:
    case LIGHT_DISC:
    case LIGHT_SPHERE:
        break;
    }
    return error_set(error, PS_ERROR_INVALID, "a light with a surface is geometry that shines");
}

ps_result light_create(const struct light_description *description,
                       const struct light_bounds *bounds, const struct sky_picture *picture,
                       struct light *light, struct error *error)
{
    return check_power(create_kind(description, bounds, picture, light, error), light, error);
}

ps_result light_create_mesh(const struct light_mesh *mesh, ps_rgb radiance, bool both_sides,
                            struct light *light, struct error *error)
{
    *light = (struct light){.emitter = EMITTER_MESH};
    ps_result result = light_surface_create(mesh, radiance, both_sides, &light->surface, error);
    return check_power(result, light, error);
}

struct light light_create_sphere(ps_vec3 center, float radius, ps_rgb radiance, bool both_sides)
{
    return (struct light){
        .emitter = EMITTER_SPHERE,
        .sphere = {center, radius, radiance, both_sides},
    };
}

void light_release(struct light *light)
{
    if (light->emitter == EMITTER_MESH)
        light_surface_release(&light->surface);
    if (light->emitter == EMITTER_SKY)
        light_sky_release(&light->sky);
    *light = (struct light){.emitter = EMITTER_SPOT};
}

/* --- the whole light --- */

ps_light light_describe(const struct light *light)
{
    static const ps_light_kind kind_of[] = {
        [EMITTER_SPOT] = PS_LIGHT_POINT,   [EMITTER_SUN] = PS_LIGHT_SUN,
        [EMITTER_MESH] = PS_LIGHT_SURFACE, [EMITTER_SPHERE] = PS_LIGHT_SURFACE,
        [EMITTER_SKY] = PS_LIGHT_SKY,
    };
    ps_light described = {.kind = kind_of[light->emitter], .power = light_power(light)};
    if (light->emitter == EMITTER_SPOT) {
        described.cos_cone = light->spot.cos_falloff;
        described.position = light->spot.location;
        described.axis = light->spot.axis;
    }
    if (light->emitter == EMITTER_SUN)
        described.axis = ps_scale(light->sun.towards, -1.0f);
    return described;
}

ps_rgb light_power(const struct light *light)
{
    switch (light->emitter) {
    case EMITTER_SPOT:
        return light_spot_power(&light->spot);
    case EMITTER_SUN:
        return light_sun_power(&light->sun);
    case EMITTER_MESH:
        return light_surface_power(&light->surface);
    case EMITTER_SPHERE:
        return light_sphere_power(&light->sphere);
    case EMITTER_SKY:
        return light_sky_power(&light->sky);
    }
    return black;
}

bool light_is_afar(const struct light *light)
{
    return light->emitter == EMITTER_SUN || light->emitter == EMITTER_SKY;
}

bool light_is_soft(const struct light *light)
{
    return light->emitter == EMITTER_SKY && light->sky.solid_angle > SOFT_SKY;
}

struct light_cluster light_bounds_of(const struct light *light, size_t triangle)
{
    assert(!light_is_afar(light));
    if (light->emitter == EMITTER_SPOT)
        return light_spot_cluster(&light->spot);
    if (light->emitter == EMITTER_SPHERE)
        return light_sphere_cluster(&light->sphere);
    return light_surface_cluster(&light->surface, triangle);
}

bool light_is_delta(const struct light *light)
{
    return light->emitter == EMITTER_SPOT ||
           (light->emitter == EMITTER_SUN && !(light->sun.versine > 0.0f));
}

ps_rgb light_intensity(const struct light *light, ps_vec3 direction)
{
    return light->emitter == EMITTER_SPOT ? light_spot_intensity(&light->spot, direction) : black;
}

ps_rgb light_radiance_from(const struct light *light, ps_vec3 direction)
{
    if (light->emitter == EMITTER_SUN)
        return light_sun_radiance(&light->sun, direction);
    if (light->emitter == EMITTER_SKY)
        return light_sky_radiance(&light->sky, direction);
    return black;
}

/* --- sampling --- */

static ps_rgb emit(const struct light *light, const float u[4], ps_ray *ray, ps_vec3 *normal)
{
    switch (light->emitter) {
    case EMITTER_SPOT:
        return light_spot_emit(&light->spot, u, ray);
    case EMITTER_SUN:
        return light_sun_emit(&light->sun, u, ray);
    case EMITTER_MESH:
        return light_surface_emit(&light->surface, u, ray, normal);
    case EMITTER_SPHERE:
        return light_sphere_emit(&light->sphere, u, ray, normal);
    case EMITTER_SKY:
        return light_sky_emit(&light->sky, u, ray);
    }
    return black;
}

ps_rgb light_emit(const struct light *light, const float u[4], ps_ray *ray, ps_vec3 *normal)
{
    *ray = (ps_ray){{0, 0, 0}, 0.0f, {0, 0, 1}, INFINITY};
    *normal = (ps_vec3){0, 0, 0};
    ps_rgb flux = emit(light, u, ray, normal);
    return is_light(flux) ? flux : black;
}

static bool sample_one(const struct light *light, ps_vec3 position, ps_vec3 normal,
                       const float u[2], struct light_sample *sample)
{
    switch (light->emitter) {
    case EMITTER_SPOT:
        return light_spot_sample(&light->spot, position, sample);
    case EMITTER_SUN:
        light_sun_sample(&light->sun, u[0], u[1], sample);
        return true;
    case EMITTER_SPHERE:
        return light_sphere_sample(&light->sphere, position, u[0], u[1], sample);
    case EMITTER_SKY:
        light_sky_sample(&light->sky, normal, u, sample);
        return true;
    case EMITTER_MESH: /* many at once */
        break;
    }
    return false;
}

static void sample_each(const struct light *light, const ps_vec3 *positions, const ps_vec3 *normals,
                        const float (*numbers)[2], size_t n, struct light_sample *samples)
{
    static const ps_vec3 unknown = {0, 0, 0};
    for (size_t i = 0; i < n; i++)
        if (!sample_one(light, positions[i], normals ? normals[i] : unknown, numbers[i],
                        &samples[i]))
            samples[i].weight = black;
}

void light_sample(const struct light *light, const ps_vec3 *positions, const ps_vec3 *normals,
                  const float (*numbers)[2], size_t n, struct light_sample *samples)
{
    if (light->emitter == EMITTER_MESH)
        light_surface_sample(&light->surface, positions, numbers, n, samples);
    else
        sample_each(light, positions, normals, numbers, n, samples);
    for (size_t i = 0; i < n; i++)
        if (!is_light(samples[i].weight))
            samples[i].weight = black;
}

void light_sample_triangle(const struct light *light, size_t triangle, ps_vec3 position,
                           const float numbers[2], struct light_sample *sample)
{
    light_surface_sample_triangle(&light->surface, triangle, position, numbers, sample);
    if (!is_light(sample->weight))
        sample->weight = black;
}

ps_vec3 light_sample_normal(const struct light *light, ps_vec3 position, const float numbers[2],
                            const struct light_sample *sample)
{
    ps_vec3 normal = {0, 0, 0};
    if (light->emitter == EMITTER_SPHERE) {
        ps_vec3 point = ps_add_scaled(position, sample->distance, sample->direction);
        normal = ps_normalize(ps_subtract(point, light->sphere.center));
    } else if (light->emitter == EMITTER_MESH && light->surface.area > 0.0f) {
        normal = light_surface_normal(&light->surface, numbers);
    }
    return ps_dot(normal, sample->direction) > 0.0f ? ps_scale(normal, -1.0f) : normal;
}

float light_pdf(const struct light *light, ps_vec3 position, ps_vec3 direction, float distance,
                ps_vec3 normal)
{
    switch (light->emitter) {
    case EMITTER_SPOT:
        return 0.0f;
    case EMITTER_SUN:
        return light_sun_pdf(&light->sun, direction);
    case EMITTER_MESH:
        return light_surface_pdf(&light->surface, direction, distance, normal);
    case EMITTER_SPHERE:
        return light_sphere_pdf(&light->sphere, position, direction, distance, normal);
    case EMITTER_SKY:
        return light_pdf_by_normal(light, (ps_vec3){0, 0, 0}, direction);
    }
    return 0.0f;
}

float light_pdf_by_normal(const struct light *light, ps_vec3 normal, ps_vec3 direction)
{
    assert(light_is_afar(light));
    return light->emitter == EMITTER_SUN ? light_sun_pdf(&light->sun, direction)
                                         : light_sky_pdf(&light->sky, normal, direction);
}

float light_arrival(const struct light *light, ps_vec3 position, ps_vec3 direction, float distance,
                    ps_vec3 normal)
{
    switch (light->emitter) {
    case EMITTER_SPOT:
        return light_spot_arrival(&light->spot, direction, distance);
    case EMITTER_SUN:
        return light_arrival_from_afar(&light->sun.bounds);
    case EMITTER_MESH:
        return light_surface_arrival(&light->surface, direction, distance, normal);
    case EMITTER_SPHERE:
        return light_sphere_arrival(&light->sphere, position, direction, distance, normal);
    case EMITTER_SKY:
        return light_arrival_from_afar(&light->sky.bounds);
    }
    return 0.0f;
}

ps_vec3 light_front(const struct light *light, ps_vec3 position, ps_vec3 seen)
{
    bool is_inside =
        light->emitter == EMITTER_SPHERE &&
        !(ps_length(ps_subtract(light->sphere.center, position)) > light->sphere.radius);
    return is_inside ? ps_scale(seen, -1.0f) : seen;
}
