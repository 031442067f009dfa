#include "body.h"

#include <psplat/math.h>

#define DARKEST 1e-3f      /* albedo below which light is not judged by */
#define FAR_ABOVE 2.0f     /* of the first fit: what is brighter may be left out of the bands */
#define OUTLIER_NOISE 1.5f /* times the noise near by, by which outliers may be too bright */
#define NEAR 3             /* pixels to each side are near by */
#define FEW 4 /* pixels near by, with itself, that are half as bright as an outlier, at most */
#define FEW_IN_GLOSS 6 /* the same in gloss, where chance has more to say */
#define SHARED 4       /* pixels along a block whose noise may be one */

/* --- irradiance and surfaces --- */

static void irradiance_of(const float light[3], const float albedo[3], float irradiance[3])
{
    float sum = 0.0f, count = 0.0f;
    for (int c = 0; c < 3; c++)
        if (albedo[c] >= DARKEST) {
            sum += light[c] / albedo[c];
            count += 1.0f;
        }
    for (int c = 0; c < 3; c++)
        irradiance[c] = albedo[c] >= DARKEST ? light[c] / albedo[c]
                        : count > 0.0f       ? sum / count
                                             : 0.0f;
}

static float pixel_size(const ps_camera *camera, float depth)
{
    float across = ps_length(camera->across);
    return camera->projection == PS_ORTHOGRAPHIC
               ? across
               : depth * across / ps_dot(camera->forward, camera->corner);
}

static void take_pixel(const struct work *work, size_t pixel, size_t at)
{
    const ps_image_view *image = work->image;
    const struct regression *guides = &work->guides;
    ps_vec3 normal = {image->normal_x[pixel], image->normal_y[pixel], image->normal_z[pixel]};
    const float light[3] = {image->r[pixel], image->g[pixel], image->b[pixel]};
    const float albedo[3] = {image->albedo_r[pixel], image->albedo_g[pixel],
                             image->albedo_b[pixel]};
    float length = ps_length(normal), most = ps_max(albedo[0], ps_max(albedo[1], albedo[2]));
    float irradiance[3];
    if (!(ps_image_has_surface(image, pixel) && length > 0.0f && most >= DARKEST))
        return;
    guides->normal[0][at] = normal.x / length;
    guides->normal[1][at] = normal.y / length;
    guides->normal[2][at] = normal.z / length;
    guides->position[0][at] = image->position_x[pixel];
    guides->position[1][at] = image->position_y[pixel];
    guides->position[2][at] = image->position_z[pixel];
    guides->gloss[at] = image->gloss ? image->gloss[pixel] : 0.0f;
    guides->size[at] = pixel_size(&work->camera, image->depth[pixel]);
    irradiance_of(light, albedo, irradiance);
    for (int c = 0; c < 3; c++)
        work->light[c][at] = irradiance[c];
}

void regression_take_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    for (size_t x = 0; x < work->width; x++)
        take_pixel(work, row * work->width + x, regression_at(&work->guides, (int)x, (int)row));
}

/* --- what the bands are made of --- */

static float mean_brightness(const struct work *work, float *const planes[])
{
    double sum = 0.0, count = 1.0;
    for (size_t y = 0; y < work->height; y++)
        for (size_t x = 0; x < work->width; x++)
            if (regression_shows_surface(&work->guides, (int)x, (int)y)) {
                sum += (double)brightness_at(planes, y * work->width + x);
                count += 1.0;
            }
    return (float)(sum / count);
}

/* For the mean of n samples of which m are odd, the difference of both parts' means, times sqrt(m (n - m)) / n, is as
 * large as the noise. */
static float noise_of_halves(const ps_image_view *image, size_t pixel)
{
    const float even[3] = {image->even_r[pixel], image->even_g[pixel], image->even_b[pixel]};
    const float odd[3] = {image->odd_r[pixel], image->odd_g[pixel], image->odd_b[pixel]};
    const float albedo[3] = {image->albedo_r[pixel], image->albedo_g[pixel],
                             image->albedo_b[pixel]};
    float share = image->odd_share, a[3], b[3];
    irradiance_of(even, albedo, a);
    irradiance_of(odd, albedo, b);
    return sqrtf(share * (1.0f - share)) * (brightness(a) - brightness(b));
}

static float sign_by_lot(uint32_t number)
{
    uint32_t x = (number ^ (number >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return (x ^ (x >> 16)) & 1u ? 1.0f : -1.0f;
}

static bool is_at_edge(const struct regression *guides, int x, int y)
{
    size_t at = regression_at(guides, x, y);
    return !regression_is_like(guides, at, regression_at(guides, x - 1, y)) ||
           !regression_is_like(guides, at, regression_at(guides, x + 1, y)) ||
           !regression_is_like(guides, at, regression_at(guides, x, y - 1)) ||
           !regression_is_like(guides, at, regression_at(guides, x, y + 1));
}

static float sign_of_noise(const struct work *work, size_t x, size_t y)
{
    const float *gloss = work->image->gloss;
    bool shared = work->camera.aperture > 0.0f || (gloss && gloss[y * work->width + x] > 0.0f) ||
                  (work->image->edge_samples > 1 && is_at_edge(&work->guides, (int)x, (int)y));
    size_t side = shared ? SHARED : 1;
    return sign_by_lot((uint32_t)(y / side * side * work->width + x / side * side));
}

/* Where halves tell it. And the largest near by along the row, into `room`. */
static void take_noise_of_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    size_t first = row * work->width;
    for (size_t x = 0; x < work->width; x++)
        work->noise[first + x] = regression_shows_surface(&work->guides, (int)x, (int)row)
                                     ? noise_of_halves(work->image, first + x)
                                     : 0.0f;
    for (size_t x = 0; x < work->width; x++) {
        size_t from = x > NEAR ? x - NEAR : 0, end = x + NEAR + 1;
        float most = 0.0f;
        for (size_t i = from; i < end && i < work->width; i++)
            most = ps_max(most, fabsf(work->noise[first + i]));
        work->room[first + x] = most;
    }
}

static float largest_noise_near(const struct work *work, size_t x, size_t y)
{
    size_t from = y > NEAR ? y - NEAR : 0, end = y + NEAR + 1;
    float most = 0.0f;
    for (size_t i = from; i < end && i < work->height; i++)
        most = ps_max(most, work->room[i * work->width + x]);
    return most;
}

/* Whether few pixels near by are about as bright. */
static bool is_alone(const struct work *work, size_t x, size_t y, float bright)
{
    int like = 0;
    for (int dy = -NEAR; dy <= NEAR; dy++)
        for (int dx = -NEAR; dx <= NEAR; dx++) {
            size_t at = regression_at(&work->guides, (int)x + dx, (int)y + dy);
            like += brightness_at(work->light, at) > 0.5f * bright;
        }
    return like <= (work->kind[y * work->width + x] == (float)GLOSSY ? FEW_IN_GLOSS : FEW);
}

/* From the first fit, in `fine`. What is bright without noise is no outlier, nor, where the noise is known, is what several
 * pixels show: a patch of sun is as bright as it is, whatever the noise of its penumbra. */
static void make_body(const struct work *work, size_t x, size_t y, size_t at)
{
    size_t pixel = y * work->width + x;
    float first = brightness_at(work->fine, pixel), bright = brightness_at(work->light, at);
    bool known = work->image->even_r != NULL;
    float noise = known ? largest_noise_near(work, x, y) : bright;
    float limit = ps_max(FAR_ABOVE * ps_max(first, work->least), bright - OUTLIER_NOISE * noise);
    bool is_outlier = bright > limit && (!known || is_alone(work, x, y, bright));
    float keep = is_outlier ? limit / bright : 1.0f;
    for (int c = 0; c < REGRESSION_COLOURS; c++)
        work->body[c][at] = keep * work->light[c][at];
    work->body[NOISE][at] =
        known ? keep * work->noise[pixel] : sign_of_noise(work, x, y) * (keep * bright - first);
}

static void make_body_of_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    for (size_t x = 0; x < work->width; x++) {
        size_t at = regression_at(&work->guides, (int)x, (int)row);
        if (work->guides.size[at] > 0.0f)
            make_body(work, x, row, at);
    }
}

void regression_make_body(struct work *work)
{
    const ps_host *host = work->host;
    work->least = 0.1f * mean_brightness(work, work->fine) + 1e-18f; /* its square is no 0 */
    if (work->image->even_r)
        host->parallel_for(host, work->height, take_noise_of_row, work);
    host->parallel_for(host, work->height, make_body_of_row, work);
}
