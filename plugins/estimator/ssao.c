/* ssao.c: ambient light that corners and grooves get less of: screen-space ambient occlusion.
 *
 * The cheap end of what splatting is compared with (Hoet 2014, section 2.1; Mittring 2007). This is
 * the estimator of McGuire et al. 2011, "The Alchemy screen-space ambient obscurance algorithm",
 * which needs nothing but positions and normals. Samples q lie in the disc of pixels that a ball of
 * radius r around the pixel's point p covers; with v = q - p, normal n and bias b,
 *
 *     A(p) = max(0, 1 - 2 intensity r / s * sum over s samples of
 *                       max(0, v.n - b r) / (v.v + e) * max(0, 1 - v.v / r^2))
 *     E(p) = irradiance * A(p)          W/m^2
 *
 * Lengths in units of r, with e = (r / 10)^2, make A free of units: a scene twice as large looks
 * the same. The paper's bias grows with the distance from the camera, as errors of a depth buffer
 * do; positions here are exact, and a long lens would lose the effect. The last factor lets it end
 * at r, so that what passes far in front of a surface casts no halo.
 */
#include "shared/ambient_occlusion.h"

#define GOLDEN_ANGLE 2.39996323f

struct state {
    ps_rgb irradiance;
    ps_number_or_choice radius;
    int64_t samples;
    double intensity;
    double bias;
};

struct work {
    const struct state *state;
    float radius;
};

/* How much what one sample sees occludes the point, times the radius. */
static float obscurance(const struct work *work, const struct screen_point *point, ps_vec3 sample)
{
    float radius2 = work->radius * work->radius;
    ps_vec3 v = ps_subtract(sample, point->position);
    float length2 = ps_dot(v, v);
    float height = ps_dot(v, point->normal) - (float)work->state->bias * work->radius;
    if (!(height > 0.0f && length2 < radius2))
        return 0.0f;
    return work->radius * height / (length2 + 0.01f * radius2) * (1.0f - length2 / radius2);
}

/* Samples along a spiral over the disc, all of the same share of its area; `numbers` turn it and
 * shift it outwards. */
static float visibility(const void *user, const struct screen *screen,
                        const struct screen_point *point, uint32_t x, uint32_t y,
                        const float numbers[4])
{
    const struct work *work = user;
    float reach = screen_extent(screen, point, x, y, work->radius), sum = 0.0f;
    if (!(reach > 0.0f))
        return 1.0f;
    int64_t count = work->state->samples;
    float angle = 2.0f * PS_PI * numbers[1];
    float u = cosf(angle), v = sinf(angle);
    const float turn_u = cosf(GOLDEN_ANGLE), turn_v = sinf(GOLDEN_ANGLE);
    for (int64_t i = 0; i < count; i++) {
        float radius = reach * sqrtf(((float)i + numbers[0]) / (float)count);
        float turned = u * turn_u - v * turn_v;
        struct screen_point sample;
        if (screen_look(screen, (float)x + 0.5f + radius * u, (float)y + 0.5f + radius * v,
                        &sample))
            sum += obscurance(work, point, sample.position);
        v = u * turn_v + v * turn_u;
        u = turned;
    }
    return fmaxf(0.0f, 1.0f - 2.0f * (float)work->state->intensity / (float)count * sum);
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    const struct state *state = opaque;
    const struct work work = {state, ambient_occlusion_radius(host, state->radius)};
    return ambient_occlusion_light(host, pass, state->irradiance, visibility, &work);
}

static const ps_param params[] = {
    AMBIENT_OCCLUSION_IRRADIANCE(struct state),
    AMBIENT_OCCLUSION_RADIUS(struct state),
    PS_INT(struct state, samples, "16", 1, 65536, "pixels",
           "pixels looked at for each pixel and pass"),
    PS_NUMBER(struct state, intensity, "1", 0, 1000, 0, "",
              "strength; 1: a right-angled crease keeps about half of its light; 0: as ambient"),
    PS_NUMBER(struct state, bias, "0.01", 0, 1, PS_PARAM_EXPERT, "radii",
              "height above the surface that does not yet occlude, as a fraction of radius"),
};

static const ps_estimator_vtable vtable = {.size = sizeof vtable, .accumulate = accumulate};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "ssao",
    .version = "1.0",
    .summary = "ambient light, less where the picture shows something near",
    .paper = "McGuire et al. 2011, The Alchemy screen-space ambient obscurance algorithm",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, ssao, &descriptor)
