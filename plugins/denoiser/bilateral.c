/* bilateral.c: a blur of the indirect light that stops at edges of the geometry.
 *
 * A cross bilateral filter (Tomasi and Manduchi 1998; Eisemann and Durand 2004): what stops it is
 * the G-buffer, which has no noise, and not the light itself, whose noise it would take for edges.
 * For pixel p and its neighbours q, with positions x, normals n and Tukey's biweight b(s) = max(0,
 * 1 - s)^2,
 *
 *     w(p, q) = exp(-|p - q|^2 / (2 sigma^2)) * b((1 - n_p.n_q) / (1 - cos(normal)))
 *                                             * b(h^2 / distance^2)
 *     h^2     = sum of squares of either point's distance from the other's tangent plane
 *     E'(p)   = sum_q w(p, q) E(q) / sum_q w(p, q)
 *
 * The biweight ends: past the angle or the distance, nothing crosses at all (Durand and Dorsey
 * 2002), and it needs no exponential, so the loop runs in vectors. The plane's distance, and not
 * that of the points, keeps floors that recede from the camera smooth; surfaces in one plane do
 * mix.
 *
 * E is the irradiance: the radiance is divided by albedo and multiplied again, channel by channel,
 * so that colours of surfaces stay sharp. A channel that a surface hardly reflects says nothing
 * about the light: it neither gives nor changes.
 */
#include <psplat/plugin.h>
#include <stdio.h>
#include <string.h>

#define LARGEST 33
#define BLOCK 64      /* pixels of a row at a time: their sums stay in the first-level cache */
#define DARKEST 1e-3f /* albedo below which a channel tells nothing about the irradiance */

static const char *const automatic[] = {"auto", NULL};

struct state {
    int64_t size;
    ps_number_or_choice sigma;
    double normal;
    ps_number_or_choice distance;
};

enum plane {
    NORMAL_X,
    NORMAL_Y,
    NORMAL_Z,
    LIGHT_R, /* irradiance / pi where `given`, else 0 */
    LIGHT_G,
    LIGHT_B,
    GIVEN_R, /* 1 where the channel says something about the light, else 0 */
    GIVEN_G,
    GIVEN_B,
    PLANES
};

struct work {
    const ps_host *host;
    const ps_image_view *image;
    float *planes[PLANES];
    int radius;
    float near[LARGEST]; /* the spatial weight along one axis */
    float bend_scale;    /* 1 / (1 - cos(normal)) */
    float height_scale;  /* 1 / distance^2 */
};

/* --- what the loop reads --- */

static void guide_pixel(const struct work *work, size_t pixel)
{
    const ps_image_view *image = work->image;
    ps_vec3 normal = {image->normal_x[pixel], image->normal_y[pixel], image->normal_z[pixel]};
    float length = ps_length(normal);
    int surface = ps_image_has_surface(image, pixel) && length > 0.0f;
    normal = surface ? ps_scale(normal, 1.0f / length) : (ps_vec3){0, 0, 0};
    work->planes[NORMAL_X][pixel] = normal.x;
    work->planes[NORMAL_Y][pixel] = normal.y;
    work->planes[NORMAL_Z][pixel] = normal.z;
    const float light[3] = {image->r[pixel], image->g[pixel], image->b[pixel]};
    const float albedo[3] = {image->albedo_r[pixel], image->albedo_g[pixel],
                             image->albedo_b[pixel]};
    for (int c = 0; c < 3; c++) {
        int given = surface && albedo[c] >= DARKEST;
        work->planes[GIVEN_R + c][pixel] = given ? 1.0f : 0.0f;
        work->planes[LIGHT_R + c][pixel] = given ? light[c] / albedo[c] : 0.0f;
    }
}

static void guide_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    size_t first = row * work->image->width;
    for (size_t x = 0; x < work->image->width; x++)
        guide_pixel(work, first + x);
}

/* --- the filter --- */

/* Sums over the neighbours of a block of pixels. */
struct sums {
    float light[3][BLOCK], weight[3][BLOCK];
};

/* (1 - s)^2, 0 from s = 1 on: the maximum with 0 without a comparison, which would keep compilers
 * from making the loop around it a vector loop. */
static inline float biweight(float s)
{
    float rest = 0.5f * (1.0f - s + fabsf(1.0f - s));
    return rest * rest;
}

/* Edge-stopping weight of the pixels [at, at + n) and their neighbours [from, from + n). */
static inline void stop_at_edges(const struct work *work, size_t at, size_t from, int n,
                                 float weight[BLOCK])
{
    const float *nx = work->planes[NORMAL_X], *ny = work->planes[NORMAL_Y];
    const float *nz = work->planes[NORMAL_Z], *x = work->image->position_x;
    const float *y = work->image->position_y, *z = work->image->position_z;
    for (int i = 0; i < n; i++) {
        size_t p = at + (size_t)i, q = from + (size_t)i;
        float cosine = nx[p] * nx[q] + ny[p] * ny[q] + nz[p] * nz[q];
        float dx = x[q] - x[p], dy = y[q] - y[p], dz = z[q] - z[p];
        float over = dx * nx[p] + dy * ny[p] + dz * nz[p];
        float under = dx * nx[q] + dy * ny[q] + dz * nz[q];
        float height2 = over * over + under * under;
        weight[i] =
            biweight((1.0f - cosine) * work->bend_scale) * biweight(height2 * work->height_scale);
    }
}

static inline void add_products(float *restrict sums, float scale, const float *restrict a,
                                const float *restrict b, int n)
{
    for (int i = 0; i < n; i++)
        sums[i] += scale * a[i] * b[i];
}

/* Adds the neighbours (dx, dy) of the pixels at columns [x, x + n) of a row. */
static void add_neighbours(const struct work *work, int x, int row, int n, int dx, int dy,
                           struct sums *sums)
{
    int width = (int)work->image->width;
    int skip = x + dx < 0 ? -(x + dx) : 0;
    int past = x + n + dx - width, end = past > 0 ? n - past : n;
    if (row + dy < 0 || row + dy >= (int)work->image->height || skip >= end)
        return;
    size_t at = (size_t)row * (size_t)width + (size_t)(x + skip);
    size_t from = (size_t)(row + dy) * (size_t)width + (size_t)(x + skip + dx);
    float space = work->near[dx + work->radius] * work->near[dy + work->radius], weight[BLOCK];
    stop_at_edges(work, at, from, end - skip, weight);
    for (int c = 0; c < 3; c++) {
        const float *light = work->planes[LIGHT_R + c] + from;
        const float *given = work->planes[GIVEN_R + c] + from;
        add_products(sums->light[c] + skip, space, weight, light, end - skip);
        add_products(sums->weight[c] + skip, space, weight, given, end - skip);
    }
}

static void store_block(const struct work *work, size_t first, int n, const struct sums *sums)
{
    float *const out[3] = {work->image->r, work->image->g, work->image->b};
    const float *const albedo[3] = {work->image->albedo_r, work->image->albedo_g,
                                    work->image->albedo_b};
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < n; i++) {
            size_t pixel = first + (size_t)i;
            if (work->planes[GIVEN_R + c][pixel] > 0.0f)
                out[c][pixel] = albedo[c][pixel] * (sums->light[c][i] / sums->weight[c][i]);
        }
}

static void filter_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    if (work->host->cancelled(work->host))
        return;
    int width = (int)work->image->width, radius = work->radius;
    for (int x = 0; x < width; x += BLOCK) {
        int n = width - x < BLOCK ? width - x : BLOCK;
        struct sums sums;
        memset(&sums, 0, sizeof sums);
        for (int dy = -radius; dy <= radius; dy++)
            for (int dx = -radius; dx <= radius; dx++)
                add_neighbours(work, x, (int)row, n, dx, dy, &sums);
        store_block(work, row * work->image->width + (size_t)x, n, &sums);
    }
}

/* --- the strategy --- */

static double farthest(const struct state *state, const ps_host *host)
{
    ps_vec3 center;
    float radius;
    host->scene_bounds(host, &center, &radius);
    return state->distance.choice >= 0 ? 0.01 * radius : state->distance.number;
}

/* The same rule for the deviation that fits a size as the denoiser gaussian has. */
static double deviation(const struct state *state)
{
    double radius = 0.5 * (double)(state->size - 1);
    return state->sigma.choice >= 0 ? 0.3 * (radius - 1) + 0.8 : state->sigma.number;
}

static void prepare(const struct state *state, const ps_host *host, struct work *work)
{
    double sigma = deviation(state), distance = farthest(state, host);
    work->radius = (int)(state->size / 2);
    for (int i = -work->radius; i <= work->radius; i++)
        work->near[i + work->radius] = (float)exp(-0.5 * i * i / (sigma * sigma));
    work->bend_scale = (float)(1 / (1 - cos(state->normal * (double)PS_PI / 180)));
    work->height_scale = (float)(1 / (distance * distance));
}

static ps_result filter(const void *state, const ps_host *host, const ps_image_view *image)
{
    struct work work = {.host = host, .image = image};
    size_t pixels = (size_t)image->width * image->height;
    float *memory = host->allocate(host, PLANES * pixels * sizeof(float), "denoiser");
    if (!memory)
        return PS_ERROR_MEMORY;
    for (size_t plane = 0; plane < PLANES; plane++)
        work.planes[plane] = memory + plane * pixels;
    prepare(state, host, &work);
    host->parallel_for(host, image->height, guide_row, &work);
    host->parallel_for(host, image->height, filter_row, &work);
    host->release(host, memory);
    return host->cancelled(host) ? PS_CANCELLED : PS_OK;
}

static ps_result init(void *opaque, const ps_host *host)
{
    const struct state *state = opaque;
    char why[60];
    if (state->size % 2 == 1)
        return PS_OK;
    snprintf(why, sizeof why, "size must be odd, got %lld", (long long)state->size);
    return host->fail(host, PS_ERROR_INVALID, why);
}

static const ps_param params[] = {
    PS_INT(struct state, size, "9", 3, LARGEST, "pixels",
           "side of the square of pixels that are averaged; odd"),
    PS_NUMBER_OR(struct state, sigma, "auto", 0.1, 100, PS_PARAM_EXPERT, automatic, "pixels",
                 "standard deviation of the blur; auto: by the size"),
    PS_NUMBER(struct state, normal, "30", 1, 90, PS_PARAM_EXPERT, "degrees",
              "angle between normals from which on nothing crosses"),
    PS_NUMBER_OR(struct state, distance, "auto", 0, INFINITY, PS_PARAM_OPEN_MIN | PS_PARAM_EXPERT,
                 automatic, "scene units",
                 "distance from the tangent plane from which on nothing crosses; auto: 1 % of the "
                 "scene's radius"),
};

static const ps_denoiser_vtable vtable = {
    .size = sizeof vtable, .filter = filter, .pixel_bytes = PLANES * sizeof(float)};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_DENOISER,
    .name = "bilateral",
    .version = "1.0",
    .summary = "blurs the indirect light within smooth surfaces, whatever their colours",
    .paper = "Tomasi and Manduchi 1998; Eisemann and Durand 2004, Flash photography enhancement",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .init = init,
    .vtable = &vtable,
};

PS_MODULE(denoiser, bilateral, &descriptor)
