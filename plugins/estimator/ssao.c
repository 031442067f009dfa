/* ssao.c: ambient light that corners and grooves get less of: screen-space ambient occlusion.
 *
 * The cheap end of what splatting is compared with (Hoet 2014, section 2.1; Mittring 2007). This is
 * the estimator of McGuire et al. 2011, "The Alchemy screen-space ambient obscurance algorithm", which
 * needs nothing but positions and normals. Samples q lie in the disc of pixels that a
 * ball of radius r around the pixel's point p covers; with v = q - p, normal n and bias b,
 *
 *     A(p) = max(0, 1 - 2 intensity r / s * sum over s samples of
 *                       max(0, v.n - b r) / (v.v + e) * max(0, 1 - v.v / r^2))
 *     E(p) = irradiance * A(p)          W/m^2
 *
 * Lengths in units of r, with e = (r / 10)^2, make A free of units: a scene twice as large looks the
 * same. The paper's bias grows with the distance from the camera, as errors of a depth buffer do;
 * positions here are exact, and a long lens would lose the effect. The last factor lets it end at r,
 * so that what passes far in front of a surface casts no halo.
 *
 * Where nothing is near, A is exactly 1 and the picture that of the estimator `ambient`. No ray is
 * traced: what the picture does not show does not occlude.
 *
 * The camera is not asked either. How wide a pixel is at p follows from its neighbours: of the offset
 * to one of them, the part along the view is the difference in depth, the rest is a pixel's width.
 */
#include <psplat/plugin.h>

#define GOLDEN_ANGLE 2.39996323f

static const char *const automatic[] = {"auto", NULL};

struct state {
    ps_rgb irradiance;
    ps_number_or_choice radius;
    int64_t samples;
    double intensity;
    double bias;
};

struct work {
    const struct state *state;
    const ps_host *host;
    const ps_pass *pass;
    float radius;
    uint32_t width, height; /* of the picture */
    uint32_t *places;       /* for each pixel, row-major: tile * PS_TILE_PIXELS + lane */
};

/* What a pixel sees. */
struct point {
    ps_vec3 position, normal;
    float depth;
};

/* --- from pixels to tiles --- */

static void measure_picture(struct work *work)
{
    for (uint32_t tile = 0; tile < work->pass->tile_count; tile++)
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            uint32_t x, y;
            if (!work->host->pixel(work->host, tile, lane, &x, &y))
                continue;
            work->width = x + 1 > work->width ? x + 1 : work->width;
            work->height = y + 1 > work->height ? y + 1 : work->height;
        }
}

static void place_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    uint32_t tile = (uint32_t)index, x, y;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        if (work->host->pixel(work->host, tile, lane, &x, &y))
            work->places[(size_t)y * work->width + x] = tile * PS_TILE_PIXELS + lane;
}

static struct point point_of(const ps_tile *tile, uint32_t lane)
{
    return (struct point){
        ps_tile_position(tile, lane),
        ps_tile_normal(tile, lane),
        tile->depth[lane],
    };
}

/* What lies at a place in the picture; 0 outside of it, and where a pixel sees nothing. */
static int look(const struct work *work, float x, float y, struct point *point)
{
    if (!(x >= 0.0f && y >= 0.0f && x < (float)work->width && y < (float)work->height))
        return 0;
    uint32_t place = work->places[(size_t)y * work->width + (size_t)x];
    const ps_tile *tile = work->host->tile(work->host, place / PS_TILE_PIXELS);
    *point = point_of(tile, place % PS_TILE_PIXELS);
    return tile->object[place % PS_TILE_PIXELS] != PS_NO_OBJECT;
}

/* --- the estimate --- */

/* Width of a pixel at the point that it sees, in scene units; 0 if it has no neighbour. Neighbours far
 * off, across a silhouette, count little. */
static float pixel_width(const struct work *work, const struct point *point, uint32_t x, uint32_t y)
{
    static const float offsets[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    float across = 0.0f, weight = 0.0f;
    for (int i = 0; i < 4; i++) {
        struct point next;
        if (!look(work, (float)x + offsets[i][0], (float)y + offsets[i][1], &next))
            continue;
        ps_vec3 v = ps_subtract(next.position, point->position);
        float length2 = ps_dot(v, v), along = next.depth - point->depth;
        if (!(length2 > 0.0f))
            continue;
        across += 1.0f - along * along / length2;
        weight += 1.0f / length2;
    }
    return weight > 0.0f ? sqrtf(fmaxf(0.0f, across / weight)) : 0.0f;
}

/* How much what one sample sees occludes the point, times the radius. */
static float obscurance(const struct work *work, const struct point *point, ps_vec3 sample)
{
    float radius2 = work->radius * work->radius;
    ps_vec3 v = ps_subtract(sample, point->position);
    float length2 = ps_dot(v, v);
    float height = ps_dot(v, point->normal) - (float)work->state->bias * work->radius;
    if (!(height > 0.0f && length2 < radius2))
        return 0.0f;
    return work->radius * height / (length2 + 0.01f * radius2) * (1.0f - length2 / radius2);
}

/* Samples along a spiral over the disc, all of the same share of its area; `numbers` turn it and shift
 * it outwards. */
static float visibility(const struct work *work, const struct point *point, uint32_t x, uint32_t y,
                        const float numbers[4])
{
    float width = pixel_width(work, point, x, y), sum = 0.0f;
    if (!(width > 0.0f))
        return 1.0f;
    float across = (float)work->width + (float)work->height; /* all of the picture */
    float reach = fminf(work->radius / width, across);
    int64_t count = work->state->samples;
    float angle = 2.0f * PS_PI * numbers[1];
    float u = cosf(angle), v = sinf(angle);
    const float turn_u = cosf(GOLDEN_ANGLE), turn_v = sinf(GOLDEN_ANGLE);
    for (int64_t i = 0; i < count; i++) {
        float radius = reach * sqrtf(((float)i + numbers[0]) / (float)count);
        float turned = u * turn_u - v * turn_v;
        struct point sample;
        if (look(work, (float)x + 0.5f + radius * u, (float)y + 0.5f + radius * v, &sample))
            sum += obscurance(work, point, sample.position);
        v = u * turn_v + v * turn_u;
        u = turned;
    }
    return fmaxf(0.0f, 1.0f - 2.0f * (float)work->state->intensity / (float)count * sum);
}

static void light_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    const ps_host *host = work->host;
    ps_tile *tile = host->tile(host, (uint32_t)index);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        uint32_t x, y;
        float numbers[1][4];
        uint64_t sample = ps_sample_block(index, lane) + work->pass->number;
        if (tile->object[lane] == PS_NO_OBJECT || !host->pixel(host, (uint32_t)index, lane, &x, &y))
            continue;
        host->samples(host, PS_STREAM_ESTIMATOR, 0, &sample, 1, numbers);
        struct point point = point_of(tile, lane);
        float visible = visibility(work, &point, x, y, numbers[0]);
        ps_add_irradiance(tile, lane, ps_rgb_scale(work->state->irradiance, visible));
    }
}

static float occlusion_radius(const struct state *state, const ps_host *host)
{
    ps_vec3 center;
    float radius;
    host->scene_bounds(host, &center, &radius);
    return state->radius.choice >= 0 ? 0.2f * radius : (float)state->radius.number;
}

static ps_result accumulate(void *state, const ps_host *host, const ps_pass *pass)
{
    struct work work = {
        .state = state,
        .host = host,
        .pass = pass,
        .radius = occlusion_radius(state, host),
    };
    measure_picture(&work);
    work.places = host->allocate(host, sizeof(uint32_t) * work.width * work.height, "pixel places");
    if (!work.places)
        return PS_ERROR_MEMORY;
    host->parallel_for(host, pass->tile_count, place_tile, &work);
    ps_result result = host->for_each_tile(host, light_tile, &work);
    host->release(host, work.places);
    return result;
}

static const ps_param params[] = {
    PS_COLOR(struct state, irradiance, "1", 0, INFINITY, "W/m^2",
             "indirect irradiance of a surface that nothing occludes"),
    PS_NUMBER_OR(struct state, radius, "auto", 0, INFINITY, PS_PARAM_OPEN_MIN, automatic,
                 "scene units", "how far things occlude; auto: 20 % of the scene's radius"),
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
