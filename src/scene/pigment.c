#include "scene/pigment.h"

#include "scene/fraction.h"
#include "scene/noise.h"
#include <psplat/math.h>

/* Independent noises of one point. */
enum { SEED_PATTERN = 0x1000, SEED_TURBULENCE = 0x2000 };

/* --- from the description -------------------------------------------------------------------- */

static struct affine inverse_of(const struct affine *placement)
{
    struct affine inverse;
    if (affine_invert(placement, &inverse))
        return inverse;
    return (struct affine){.x = {0, 0, 0}};
}

static ps_vec3 unit_or_zero(ps_vec3 axis)
{
    float length = ps_length(axis);
    bool usable = length > 0.0f && isfinite(length);
    return usable ? ps_scale(axis, 1.0f / length) : (ps_vec3){0, 0, 0};
}

static int32_t usable_octaves(int64_t octaves)
{
    if (octaves < 1)
        return 1;
    return octaves < NOISE_OCTAVES_LIMIT ? (int32_t)octaves : NOISE_OCTAVES_LIMIT;
}

struct pigment pigment_create(const struct pigment_description *description,
                              const struct texture *textures)
{
    struct pigment pigment = {
        .kind = description->kind,
        .colors = {description->colors[0], description->colors[1]},
        .channel = description->channel,
        .scale = {(float)description->scale_u, (float)description->scale_v},
        .cross = {(float)description->cross_u, (float)description->cross_v},
        .offset = {(float)description->offset_u, (float)description->offset_v},
        .second_uv = description->uv_set == 1,
        .complement = description->complement,
        .vertex_colors = description->vertex_colors,
        .to_pattern = inverse_of(&description->placement),
        .axis = unit_or_zero(description->axis),
        .octaves = usable_octaves(description->octaves),
        .turbulence = (float)description->turbulence,
    };
    const float *scale = pigment.scale, *cross = pigment.cross;
    if (pigment.kind == PIGMENT_IMAGE) {
        pigment.log_scale = 0.5f * log2f(fabsf(scale[0] * scale[1] - cross[0] * cross[1]));
        pigment.texture = &textures[description->texture];
    } else {
        pigment.log_scale = affine_log_scale(&pigment.to_pattern);
    }
    return pigment;
}

/* --- images ---------------------------------------------------------------------------------- */

static ps_rgb select_channel(const float rgba[4], int32_t channel)
{
    if (channel == CHANNEL_RGB)
        return (ps_rgb){rgba[0], rgba[1], rgba[2]};
    float value = rgba[channel - CHANNEL_R];
    return (ps_rgb){value, value, value};
}

/* The image's own transform. */
static void transform_uv(const struct pigment *pigment, const float uv[2], float place[2])
{
    for (int i = 0; i < 2; i++)
        place[i] = pigment->scale[i] * uv[i] + pigment->cross[i] * uv[1 - i] + pigment->offset[i];
}

static ps_rgb image_color(const struct pigment *pigment, const float uv[2], float log_width)
{
    float place[2], rgba[4];
    transform_uv(pigment, uv, place);
    texture_filter(pigment->texture, place[0], place[1], log_width + pigment->log_scale, rgba);
    ps_rgb color = ps_rgb_multiply(pigment->colors[0], select_channel(rgba, pigment->channel));
    if (pigment->complement)
        return (ps_rgb){1.0f - color.r, 1.0f - color.g, 1.0f - color.b};
    return color;
}

/* Of the surface, before the image's own transform. */
static void choose_uv(const struct pigment *pigment, ps_vec3 point, const float uv[2],
                      float chosen[2])
{
    chosen[0] = pigment->second_uv ? point.x : uv[0];
    chosen[1] = pigment->second_uv ? point.y : uv[1];
}

void pigment_place(const struct pigment *pigment, ps_vec3 point, const float uv[2], float place[2])
{
    float at[2];
    choose_uv(pigment, point, uv, at);
    transform_uv(pigment, at, place);
}

void pigment_tangents(const struct pigment *pigment, ps_vec3 *by_u, ps_vec3 *by_v)
{
    const float *scale = pigment->scale, *cross = pigment->cross;
    float determinant = scale[0] * scale[1] - cross[0] * cross[1];
    float inverse = fabsf(determinant) > 0.0f ? 1.0f / determinant : 0.0f;
    ps_vec3 u = *by_u, v = *by_v;
    *by_u = ps_scale(ps_add_scaled(ps_scale(u, scale[1]), -cross[1], v), inverse);
    *by_v = ps_scale(ps_add_scaled(ps_scale(v, scale[0]), -cross[0], u), inverse);
}

/* --- patterns -------------------------------------------------------------------------------- */

static float checker_share(ps_vec3 p)
{
    uint32_t cubes = (uint32_t)whole_of(p.x + PATTERN_OFFSET) +
                     (uint32_t)whole_of(p.y + PATTERN_OFFSET) +
                     (uint32_t)whole_of(p.z + PATTERN_OFFSET);
    return (float)(cubes & 1);
}

static float gradient_share(ps_vec3 p, ps_vec3 axis)
{
    float share = fraction_of(ps_dot(p, axis) + PATTERN_OFFSET) - PATTERN_OFFSET;
    return share > 0.0f ? share : 0.0f;
}

static float noise_share(ps_vec3 p, int32_t octaves, float width)
{
    float share = 0.5f + 0.5f * noise_fractal(p, octaves, width, SEED_PATTERN);
    return fminf(fmaxf(share, 0.0f), 1.0f);
}

static ps_vec3 displace(ps_vec3 p, float turbulence, float width)
{
    if (turbulence == 0.0f)
        return p;
    return ps_add_scaled(p, turbulence,
                         noise_vector(p, TURBULENCE_OCTAVES, width, SEED_TURBULENCE));
}

/* 0: the point. */
static float width_in_pattern(const struct pigment *pigment, float log_width)
{
    return exp2f(log_width + pigment->log_scale);
}

/* How much of colors[1] there is at a point of the pattern's space, where `width` is the cone's
 * there. */
static float pattern_share(const struct pigment *pigment, ps_vec3 p, float width)
{
    switch (pigment->kind) {
    case PIGMENT_CHECKER:
        return checker_share(p);
    case PIGMENT_GRADIENT:
        return gradient_share(displace(p, pigment->turbulence, width), pigment->axis);
    case PIGMENT_NOISE:
        return noise_share(displace(p, pigment->turbulence, width), pigment->octaves, width);
    case PIGMENT_COLOR:
    case PIGMENT_IMAGE:
        break;
    }
    return 0.0f;
}

static ps_rgb within_unit(ps_rgb color)
{
    return (ps_rgb){fminf(fmaxf(color.r, 0.0f), 1.0f), fminf(fmaxf(color.g, 0.0f), 1.0f),
                    fminf(fmaxf(color.b, 0.0f), 1.0f)};
}

/* What a mesh file's materials are made of. */
static ps_rgb vary_by_mesh(const struct pigment *pigment, ps_vec3 point, const float uv[2],
                           float log_width)
{
    float at[2];
    choose_uv(pigment, point, uv, at);
    ps_rgb color =
        pigment->kind == PIGMENT_IMAGE ? image_color(pigment, at, log_width) : pigment->colors[0];
    if (pigment->vertex_colors)
        color = ps_rgb_multiply(color, (ps_rgb){point.x, point.y, point.z});
    return pigment->bounded ? within_unit(color) : color;
}

ps_rgb pigment_vary(const struct pigment *pigment, ps_vec3 point, const float uv[2],
                    float log_width)
{
    if (pigment->kind == PIGMENT_IMAGE || pigment->kind == PIGMENT_COLOR)
        return vary_by_mesh(pigment, point, uv, log_width);
    float share = pattern_share(pigment, affine_point(&pigment->to_pattern, point),
                                width_in_pattern(pigment, log_width));
    return ps_rgb_add(ps_rgb_scale(pigment->colors[0], 1.0f - share),
                      ps_rgb_scale(pigment->colors[1], share));
}

/* --- slopes ---------------------------------------------------------------------------------- */

#define STEP 0.01f

/* Half the way between the points of a difference. Far from the origin floats lie so far apart that
 * a shorter way would measure their rounding. */
static float difference_step(ps_vec3 p)
{
    float size = fmaxf(fabsf(p.x), fmaxf(fabsf(p.y), fabsf(p.z)));
    return fmaxf(STEP, 1e-5f * size);
}

/* For patterns with jumps, which have no gradient there: as steep as they are over the step. */
static ps_vec3 gradient_by_differences(const struct pigment *pigment, ps_vec3 p)
{
    float step = difference_step(p);
    const ps_vec3 ways[3] = {{step, 0, 0}, {0, step, 0}, {0, 0, step}};
    float slopes[3];
    for (int i = 0; i < 3; i++)
        slopes[i] = (pattern_share(pigment, ps_add(p, ways[i]), 0.0f) -
                     pattern_share(pigment, ps_subtract(p, ways[i]), 0.0f)) /
                    (2.0f * step);
    return (ps_vec3){slopes[0], slopes[1], slopes[2]};
}

/* A gradient at p + turbulence * noise_vector(p), as it is at p. */
static ps_vec3 before_turbulence(ps_vec3 gradient, float turbulence, const ps_vec3 of_vector[3])
{
    ps_vec3 sum = ps_scale(of_vector[0], gradient.x);
    sum = ps_add_scaled(sum, gradient.y, of_vector[1]);
    sum = ps_add_scaled(sum, gradient.z, of_vector[2]);
    return ps_add_scaled(gradient, turbulence, sum);
}

static ps_vec3 noise_gradient(const struct pigment *pigment, ps_vec3 p)
{
    ps_vec3 gradient, of_vector[3];
    float turbulence = pigment->turbulence;
    if (turbulence != 0.0f)
        p = ps_add_scaled(
            p, turbulence,
            noise_vector_gradients(p, TURBULENCE_OCTAVES, SEED_TURBULENCE, of_vector));
    float noise = noise_fractal_gradient(p, pigment->octaves, SEED_PATTERN, &gradient);
    if (fabsf(noise) >= 1.0f)
        return (ps_vec3){0, 0, 0}; /* shares end there */
    gradient = ps_scale(gradient, 0.5f);
    return turbulence != 0.0f ? before_turbulence(gradient, turbulence, of_vector) : gradient;
}

static ps_vec3 pattern_gradient(const struct pigment *pigment, ps_vec3 p)
{
    return pigment->kind == PIGMENT_NOISE ? noise_gradient(pigment, p)
                                          : gradient_by_differences(pigment, p);
}

/* The chain rule: a gradient goes back through the transpose of the map to the pattern. */
ps_vec3 pigment_gradient(const struct pigment *pigment, ps_vec3 point)
{
    if (pigment->kind == PIGMENT_COLOR || pigment->kind == PIGMENT_IMAGE)
        return (ps_vec3){0, 0, 0};
    const struct affine *map = &pigment->to_pattern;
    ps_vec3 slope = pattern_gradient(pigment, affine_point(map, point));
    ps_vec3 gradient = {ps_dot(map->x, slope), ps_dot(map->y, slope), ps_dot(map->z, slope)};
    return ps_scale(gradient, pigment_mean(pigment->colors[1]) - pigment_mean(pigment->colors[0]));
}

/* Along u (axis 0) or v; by what the coordinates differ after rounding. */
static float image_slope(const struct pigment *pigment, const float uv[2], float log_width,
                         int axis)
{
    const float sizes[2] = {(float)pigment->texture->width, (float)pigment->texture->height};
    float texels = fmaxf(sizes[axis] * fabsf(pigment->scale[axis]),
                         sizes[1 - axis] * fabsf(pigment->cross[1 - axis]));
    if (texels == 0.0f)
        return 0.0f;
    float step = 0.5f * fmaxf(1.0f / texels, exp2f(log_width));
    float before[2] = {uv[0], uv[1]}, after[2] = {uv[0], uv[1]};
    before[axis] -= step;
    after[axis] += step;
    float way = after[axis] - before[axis];
    if (!(way > 0.0f) || isinf(way))
        return 0.0f;
    return (pigment_mean(image_color(pigment, after, log_width)) -
            pigment_mean(image_color(pigment, before, log_width))) /
           way;
}

void pigment_uv_gradient(const struct pigment *pigment, const float uv[2], float log_width,
                         float gradient[2])
{
    for (int axis = 0; axis < 2; axis++)
        gradient[axis] =
            pigment->kind == PIGMENT_IMAGE ? image_slope(pigment, uv, log_width, axis) : 0.0f;
}
