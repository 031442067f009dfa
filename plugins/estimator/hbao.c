/* hbao.c: ambient light that corners and grooves get less of: horizon-based ambient occlusion.
 *
 * Bavoil, Sainz and Dimitrov 2008, "Image-space horizon-based ambient occlusion". The hemisphere
 * around the direction to the viewer is cut into slices. In the slice of azimuth theta the tangent
 * plane rises by the angle t, and what the picture shows along a line of pixels rises to a horizon.
 * Where a sample at distance r raises the horizon from h to h', the directions in between are
 * occluded by W(r) = max(0, 1 - r^2 / R^2). With all light weighing the same, as in the paper,
 *
 *     A = 1 - 1 / N * sum over N slices and their samples of W(r) (sin h' - sin h)
 *
 * Irradiance weighs light by the cosine to the normal n. With w the slice's direction across the
 * view v,
 *
 *     A = 1 - 2 / N * sum of W(r) (F(h') - F(h))
 *     F(a) = (n.w) (a / 2 + sin(2a) / 4) + (n.v) sin(a)^2 / 2
 *
 * which is the integral of the cosine over the directions between the horizons.
 *
 * Slices are spread evenly around v, not in the picture. What the picture shows has no thickness: a
 * post before a wall occludes all that is behind it. Points that the camera sees through mirrors,
 * glass or out of focus take slices around their normals, spread evenly in the picture, as the line
 * back to the viewer is not known.
 */
#include "shared/ambient_occlusion.h"

#define STEP_ASIDE 1e-2f /* in distances from the camera, to project a direction */

struct state {
    ps_rgb irradiance;
    ps_number_or_choice radius;
    int64_t slices;
    int64_t steps;
    int32_t cosine;
    double bias;
};

struct work {
    const struct state *state;
    const ps_host *host;
    ps_camera camera;
    float radius, bias;
};

/* A point, and where in the picture it shows. */
struct receiver {
    struct screen_point point;
    ps_vec3 view;      /* to the viewer */
    float view_normal; /* n.v */
    float x, y;        /* in pixels */
    float shown[2];    /* where the point projects to */
    float reach;       /* the radius, in pixels */
};

/* A sample of a slice. Pixels do not lie on the slice's line, so each has its own azimuth; were the
 * tangent plane not that of the azimuth, surfaces that slant would occlude themselves. */
struct sample {
    float up, across;    /* how far it is from the point along the view, and across it */
    float across_normal; /* n.w */
    float weight;        /* W(r) */
};

/* 0 where nothing that occludes is seen. */
static int take_sample(const struct work *work, const struct screen *screen,
                       const struct receiver *receiver, float x, float y, struct sample *sample)
{
    struct screen_point seen;
    if (!screen_look(screen, x, y, &seen))
        return 0;
    ps_vec3 offset = ps_subtract(seen.position, receiver->point.position);
    float up = ps_dot(offset, receiver->view);
    float share = ps_dot(offset, offset) / (work->radius * work->radius);
    ps_vec3 in_plane = ps_add_scaled(offset, -up, receiver->view);
    float across = ps_length(in_plane);
    if (!(across > 0.0f && share < 1.0f))
        return 0;
    *sample = (struct sample){up, across, ps_dot(receiver->point.normal, in_plane) / across,
                              1.0f - share};
    return 1;
}

/* The share of a slice's light that comes from below an angle, but for a constant. */
static float light_below(const struct work *work, const struct receiver *receiver,
                         const struct sample *sample, float angle)
{
    float sine = sinf(angle);
    if (!work->state->cosine)
        return sine;
    return sample->across_normal * (angle + sine * cosf(angle)) +
           receiver->view_normal * sine * sine;
}

/* How much of a slice's light the pixels along (u, v) hide, the first of them `shift` in [0, 1) of
 * a step away. */
static float occlude_slice(const struct work *work, const struct screen *screen,
                           const struct receiver *receiver, float u, float v, float shift)
{
    float step = receiver->reach / (float)work->state->steps;
    float horizon = work->bias, occlusion = 0.0f; /* the horizon above the tangent plane */
    float sine = sinf(horizon), cosine = cosf(horizon);
    for (int64_t i = 0; i < work->state->steps; i++) {
        struct sample sample;
        float distance = ps_max(((float)i + shift) * step, 1.0f);
        if (!take_sample(work, screen, receiver, receiver->x + distance * u,
                         receiver->y + distance * v, &sample))
            continue;
        /* Sine and cosine of the height above the tangent plane, times a length: arcs are for the
         * few that rise. */
        float rise = sample.up * receiver->view_normal + sample.across * sample.across_normal;
        float along = sample.across * receiver->view_normal - sample.up * sample.across_normal;
        if (!(rise * cosine > along * sine))
            continue;
        float tangent = atan2f(-sample.across_normal, receiver->view_normal);
        float angle = atan2f(sample.up, sample.across);
        occlusion += sample.weight * (light_below(work, receiver, &sample, angle) -
                                      light_below(work, receiver, &sample, tangent + horizon));
        horizon = angle - tangent;
        sine = sinf(horizon);
        cosine = cosf(horizon);
    }
    return occlusion;
}

/* Whether the way from the viewer to a pixel's point is straight: the point then projects to that
 * pixel. */
static int is_seen_straight(const struct receiver *receiver)
{
    return fabsf(receiver->shown[0] - receiver->x) < 1.0f &&
           fabsf(receiver->shown[1] - receiver->y) < 1.0f;
}

static ps_vec3 direction_to_viewer(const struct work *work, ps_vec3 position)
{
    if (work->camera.projection == PS_ORTHOGRAPHIC)
        return ps_scale(work->camera.forward, -1.0f);
    return ps_normalize(ps_subtract(work->camera.position, position));
}

/* The direction in the picture, of length 1, in which a direction across the view shows; 0 where it
 * shows none. */
static int project_direction(const struct work *work, const struct receiver *receiver, ps_vec3 w,
                             float direction[2])
{
    const struct screen_point *point = &receiver->point;
    ps_vec3 aside = ps_add_scaled(point->position, STEP_ASIDE * point->depth, w);
    float pixel[1][2];
    work->host->project(work->host, &aside, 1, pixel);
    float x = pixel[0][0] - receiver->shown[0], y = pixel[0][1] - receiver->shown[1];
    float length = sqrtf(x * x + y * y);
    if (!(length > 0.0f))
        return 0;
    direction[0] = x / length;
    direction[1] = y / length;
    return 1;
}

static float visibility(const void *user, const struct screen *screen,
                        const struct screen_point *point, uint32_t x, uint32_t y,
                        const float numbers[4])
{
    const struct work *work = user;
    int64_t count = work->state->slices;
    struct receiver receiver = {
        .point = *point,
        .view = point->normal,
        .x = (float)x + 0.5f,
        .y = (float)y + 0.5f,
        .reach = screen_extent(screen, point, x, y, work->radius),
    };
    float sum = 0.0f;
    work->host->project(work->host, &point->position, 1, &receiver.shown);
    int straight = is_seen_straight(&receiver);
    if (straight)
        receiver.view = direction_to_viewer(work, point->position);
    receiver.view_normal = ps_dot(point->normal, receiver.view);
    if (!(receiver.reach > 0.0f && receiver.view_normal > 0.0f))
        return 1.0f;
    ps_vec3 u, v;
    ps_frame(receiver.view, &u, &v);
    for (int64_t i = 0; i < count; i++) {
        float azimuth = 2.0f * PS_PI * ((float)i + numbers[0]) / (float)count;
        float direction[2] = {cosf(azimuth), sinf(azimuth)};
        float shift = numbers[1] + (float)i * 0.618034f; /* of the golden ratio */
        ps_vec3 w = ps_add_scaled(ps_scale(u, direction[0]), direction[1], v);
        if (!straight || project_direction(work, &receiver, w, direction))
            sum += occlude_slice(work, screen, &receiver, direction[0], direction[1],
                                 shift - floorf(shift));
    }
    return ps_max(1.0f - sum / (float)count, 0.0f);
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    const struct state *state = opaque;
    struct work work = {
        .state = state,
        .host = host,
        .camera = {.size = sizeof work.camera},
        .radius = ambient_occlusion_radius(host, state->radius),
        .bias = (float)state->bias * PS_PI / 180.0f,
    };
    host->camera(host, &work.camera);
    return ambient_occlusion_light(host, pass, state->irradiance, visibility, &work);
}

static const ps_param params[] = {
    AMBIENT_OCCLUSION_IRRADIANCE(struct state),
    AMBIENT_OCCLUSION_RADIUS(struct state),
    PS_INT(struct state, slices, "4", 1, 4096, "slices",
           "directions looked into for each pixel and pass"),
    PS_INT(struct state, steps, "6", 1, 65536, "pixels", "pixels looked at in each direction"),
    PS_ROW(struct state, cosine, PS_PARAM_BOOL, "yes", 0, 1, PS_PARAM_EXPERT, NULL, "",
           "weigh light by the cosine to the normal; no: all the same, as in the paper"),
    PS_NUMBER(struct state, bias, "2", 0, 89, PS_PARAM_EXPERT, "degrees",
              "angle above the surface that does not yet occlude"),
};

static const ps_estimator_vtable vtable = {.size = sizeof vtable, .accumulate = accumulate};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "hbao",
    .version = "1.0",
    .summary = "ambient light, less below the horizons that the picture shows",
    .paper = "Bavoil et al. 2008, Image-space horizon-based ambient occlusion",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, hbao, &descriptor)
