/* light_spot.c: points of light, and spotlights.
 *
 * A spotlight's edge is POV-Ray's: full intensity inside `radius`, none outside `falloff`, a smooth
 * cubic of the cosine in between; with a `tightness` t, times cos^t of the angle to the axis.
 * Rays are uniform over the cone, or follow cos^t, and carry what is left as flux.
 */
#include "scene/light_kinds.h"

/* Simpson's rule over the edge: even where cos^1000 falls within a thousandth of the range, the
 * error is below 1e-4. */
#define PANELS 4096

/* Radians: what an angle is taken to be larger by, and the widest edge whose importance may fall
 * off by its cosine. */
#define ROUNDING 1e-3f
#define WIDEST_EDGE 1.4f

static float cosine_of_degrees(double degrees)
{
    return (float)cos(degrees * (PI_DOUBLE / 180.0));
}

/* The fraction of full intensity at the cosine to the axis, but for the tightness. */
static float edge(const struct light_spot *spot, float cosine)
{
    if (cosine >= spot->cos_radius)
        return 1.0f;
    if (cosine <= spot->cos_falloff)
        return 0.0f;
    float t = (cosine - spot->cos_falloff) / (spot->cos_radius - spot->cos_falloff);
    return t * t * (3.0f - 2.0f * t);
}

static float tightened(const struct light_spot *spot, float cosine)
{
    return spot->tightness > 0.0f ? powf(fmaxf(cosine, 0.0f), spot->tightness) : 1.0f;
}

/* Flux inside the edge, over 2 pi, by numbers: the cubic times the power of the cosine. */
static double tight_border(const struct light_spot *spot)
{
    double low = fmax(0.0, (double)spot->cos_falloff), high = (double)spot->cos_radius;
    double sum = 0.0;
    for (int i = 0; i <= PANELS; i++) {
        double cosine = low + (high - low) * i / PANELS;
        double factor = i == 0 || i == PANELS ? 1.0 : (i % 2 ? 4.0 : 2.0);
        sum += factor * (double)edge(spot, (float)cosine) * pow(cosine, (double)spot->tightness);
    }
    return high > low ? sum * (high - low) / (3.0 * PANELS) : 0.0;
}

static float unit_flux(const struct light_spot *spot)
{
    if (spot->tightness > 0.0f) {
        double power = (double)spot->tightness + 1.0;
        double inside = (1.0 - pow((double)spot->cos_radius, power)) / power;
        return (float)(2.0 * PI_DOUBLE * (inside + tight_border(spot)));
    }
    /* The cubic's mean over its range of cosines is 1/2. */
    float inside = 1.0f - spot->cos_radius;
    float border = 0.5f * (spot->cos_radius - spot->cos_falloff);
    return 2.0f * PS_PI * (inside + border);
}

static ps_result set_intensity(const struct light_description *description, struct light_spot *spot,
                               struct error *error)
{
    spot->intensity = description->amount;
    if (description->unit == UNIT_INTENSITY)
        return PS_OK;
    if (description->unit != UNIT_POWER)
        return error_set(error, PS_ERROR_INVALID,
                         "a light at a point needs its intensity or its power");
    if (!(spot->unit_flux > 0.0f))
        return error_set(error, PS_ERROR_INVALID,
                         "the spotlight's cone is too narrow for a power; give its intensity");
    spot->intensity = ps_rgb_scale(description->amount, 1.0f / spot->unit_flux);
    return PS_OK;
}

ps_result light_spot_create(const struct light_description *description, struct light_spot *spot,
                            struct error *error)
{
    *spot = (struct light_spot){
        .location = description->location,
        .axis = {0, 0, 1},
        .cos_radius = -1.0f,
        .cos_falloff = -1.0f,
    };
    if (description->kind == LIGHT_SPOT) {
        spot->axis = ps_normalize(ps_subtract(description->point_at, description->location));
        spot->cos_radius = cosine_of_degrees(description->radius);
        spot->cos_falloff = cosine_of_degrees(description->falloff);
        spot->tightness = (float)description->tightness;
    }
    if (!isfinite(ps_dot(spot->axis, spot->axis)))
        return error_set(error, PS_ERROR_INVALID, "point_at is too close to the spotlight");
    spot->unit_flux = unit_flux(spot);
    return set_intensity(description, spot, error);
}

/* A spot sends its light at no more than `falloff` from its axis. A point where it has none any
 * more may round to either side. */
struct light_cluster light_spot_cluster(const struct light_spot *spot)
{
    float inner = acosf(fminf(fmaxf(spot->cos_radius, -1.0f), 1.0f));
    float outer = acosf(fminf(fmaxf(spot->cos_falloff, -1.0f), 1.0f)) + ROUNDING;
    inner = fmaxf(inner, outer - WIDEST_EDGE);
    return (struct light_cluster){
        .low = spot->location,
        .high = spot->location,
        .axis = spot->axis,
        .cos_theta_o = cosf(fminf(inner, PS_PI)),
        .cos_theta_e = cosf(outer - inner),
        .intensity = spot->intensity.r + spot->intensity.g + spot->intensity.b,
    };
}

ps_rgb light_spot_power(const struct light_spot *spot)
{
    return ps_rgb_scale(spot->intensity, spot->unit_flux);
}

ps_rgb light_spot_intensity(const struct light_spot *spot, ps_vec3 direction)
{
    /* Rounding may take a dot product past -1, where a light that shines all around would end. */
    float cosine = fmaxf(ps_dot(direction, spot->axis), -1.0f);
    return ps_rgb_scale(spot->intensity, edge(spot, cosine) * tightened(spot, cosine));
}

/* By inversion: the cosine c has density (t + 1) c^t / (1 - c_min^(t+1)). */
static ps_rgb emit_tight(const struct light_spot *spot, float u1, float u2, ps_vec3 *direction)
{
    float power = spot->tightness + 1.0f;
    float lowest = powf(fmaxf(spot->cos_falloff, 0.0f), power);
    float cosine = powf(1.0f - u1 * (1.0f - lowest), 1.0f / power);
    *direction = light_cone_direction(spot->axis, 1.0f - cosine, 1.0f, u2);
    return ps_rgb_scale(spot->intensity,
                        edge(spot, cosine) * 2.0f * PS_PI * (1.0f - lowest) / power);
}

ps_rgb light_spot_emit(const struct light_spot *spot, const float u[4], ps_ray *ray)
{
    *ray = (ps_ray){spot->location, 0.0f, spot->axis, INFINITY};
    if (spot->tightness > 0.0f)
        return emit_tight(spot, u[0], u[1], &ray->direction);
    ray->direction = ps_cone_direction(spot->axis, spot->cos_falloff, u[0], u[1]);
    float solid_angle = 2.0f * PS_PI * (1.0f - spot->cos_falloff);
    return ps_rgb_scale(light_spot_intensity(spot, ray->direction), solid_angle);
}

bool light_spot_sample(const struct light_spot *spot, ps_vec3 position, struct light_sample *sample)
{
    ps_vec3 to_light = ps_subtract(spot->location, position);
    sample->distance = ps_length(to_light);
    if (!(sample->distance > 0.0f))
        return false;
    sample->direction = ps_scale(to_light, 1.0f / sample->distance);
    ps_rgb intensity = light_spot_intensity(spot, ps_scale(sample->direction, -1.0f));
    sample->weight = ps_rgb_scale(intensity, 1.0f / (sample->distance * sample->distance));
    sample->pdf = 0.0f;
    return true;
}

/* By the density of the direction: even over the cone, or (t + 1) c^t / (2 pi (1 -
 * c_min^(t+1))). */
float light_spot_arrival(const struct light_spot *spot, ps_vec3 direction, float distance)
{
    float cosine = fminf(fmaxf(-ps_dot(direction, spot->axis), -1.0f), 1.0f);
    float density = 1.0f / (2.0f * PS_PI * (1.0f - spot->cos_falloff));
    if (spot->tightness > 0.0f) {
        float power = spot->tightness + 1.0f;
        float lowest = powf(fmaxf(spot->cos_falloff, 0.0f), power);
        density = power * tightened(spot, cosine) / (2.0f * PS_PI * (1.0f - lowest));
    }
    float arrival = density / (distance * distance);
    return cosine >= spot->cos_falloff && arrival < INFINITY ? arrival : 0.0f;
}
