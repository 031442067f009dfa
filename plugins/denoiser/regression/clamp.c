#include "clamp.h"

#include <psplat/math.h>

#define DARKEST 1e-3f      /* albedo below which a channel tells nothing about the irradiance */
#define FAR_ABOVE 2.0f     /* of the first fit: what is brighter may be left out of the bands */
#define OUTLIER_NOISE 1.5f /* times the largest noise within NOISY: outliers may be so bright */
#define NOISY 8            /* pixels to each side */
#define NEAR 3             /* pixels to each side are near by */
#define NEXT 1             /* and so many are next to it */
#define FEW 4 /* pixels near by, with itself, that are half as bright as an outlier, at most */
#define FEW_IN_GLOSS 6 /* the same in gloss, where chance has more to say */
#define LEAST_USUAL 5  /* pixels near by, with itself, that can tell what is usual */
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

static void take_pixel(const struct denoised_image *image, size_t pixel, size_t at)
{
    const ps_image_view *view = image->view;
    const struct regression *guides = &image->guides;
    ps_vec3 normal = {view->normal_x[pixel], view->normal_y[pixel], view->normal_z[pixel]};
    const float light[3] = {view->r[pixel], view->g[pixel], view->b[pixel]};
    const float albedo[3] = {view->albedo_r[pixel], view->albedo_g[pixel], view->albedo_b[pixel]};
    float length = ps_length(normal), most = ps_max(albedo[0], ps_max(albedo[1], albedo[2]));
    float irradiance[3];
    if (!(ps_image_has_surface(view, pixel) && length > 0.0f && most >= DARKEST))
        return;
    guides->normal[0][at] = normal.x / length;
    guides->normal[1][at] = normal.y / length;
    guides->normal[2][at] = normal.z / length;
    guides->position[0][at] = view->position_x[pixel];
    guides->position[1][at] = view->position_y[pixel];
    guides->position[2][at] = view->position_z[pixel];
    guides->gloss[at] = view->gloss ? view->gloss[pixel] : 0.0f;
    guides->size[at] = ps_pixel_size(&image->camera, view->depth[pixel]);
    irradiance_of(light, albedo, irradiance);
    for (int c = 0; c < 3; c++)
        image->light[c][at] = irradiance[c];
}

void regression_take_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct denoised_image *image = user;
    for (size_t x = 0; x < image->width; x++)
        take_pixel(image, row * image->width + x, regression_at(&image->guides, (int)x, (int)row));
}

/* --- outliers and noise --- */

static float mean_brightness(const struct denoised_image *image, float *const planes[])
{
    double sum = 0.0, count = 1.0;
    for (size_t y = 0; y < image->height; y++)
        for (size_t x = 0; x < image->width; x++)
            if (regression_shows_surface(&image->guides, (int)x, (int)y)) {
                sum += (double)brightness_at(planes, y * image->width + x);
                count += 1.0;
            }
    return (float)(sum / count);
}

/* The noise of a pixel from its halves: with the share s of the samples in `odd`, sqrt(s (1 - s))
 * (even - odd) has the standard deviation of the mean. */
static float noise_of_halves(const ps_image_view *view, size_t pixel)
{
    const float even[3] = {view->even_r[pixel], view->even_g[pixel], view->even_b[pixel]};
    const float odd[3] = {view->odd_r[pixel], view->odd_g[pixel], view->odd_b[pixel]};
    const float albedo[3] = {view->albedo_r[pixel], view->albedo_g[pixel], view->albedo_b[pixel]};
    float share = view->odd_share, a[3], b[3];
    irradiance_of(even, albedo, a);
    irradiance_of(odd, albedo, b);
    return sqrtf(share * (1.0f - share)) * (brightness(a) - brightness(b));
}

static float random_sign(uint32_t number)
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

static float sign_of_noise(const struct denoised_image *image, size_t x, size_t y)
{
    const float *gloss = image->view->gloss;
    bool shared = image->camera.aperture > 0.0f || (gloss && gloss[y * image->width + x] > 0.0f) ||
                  (image->view->edge_samples > 1 && is_at_edge(&image->guides, (int)x, (int)y));
    size_t side = shared ? SHARED : 1;
    return random_sign((uint32_t)(y / side * side * image->width + x / side * side));
}

/* The noise by halves. */
static void take_noise_of_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct denoised_image *image = user;
    size_t first = row * image->width;
    for (size_t x = 0; x < image->width; x++)
        image->noise[first + x] = regression_shows_surface(&image->guides, (int)x, (int)row)
                                      ? noise_of_halves(image->view, first + x)
                                      : 0.0f;
}

static float largest_noise_near(const struct denoised_image *image, size_t x, size_t y)
{
    size_t left = x > NOISY ? x - NOISY : 0, right = x + NOISY + 1;
    size_t top = y > NOISY ? y - NOISY : 0, bottom = y + NOISY + 1;
    float most = 0.0f;
    for (size_t row = top; row < bottom && row < image->height; row++)
        for (size_t i = left; i < right && i < image->width; i++)
            most = ps_max(most, fabsf(image->noise[row * image->width + i]));
    return most;
}

/* Of the pixels around one, itself included: how many are half as bright as it, how many show its
 * surface, and how many do both. */
struct around {
    int bright, own, own_bright;
};

static struct around look_around(const struct denoised_image *image, size_t x, size_t y,
                                 float bright, int reach)
{
    struct around near = {0, 0, 0};
    size_t middle = regression_at(&image->guides, (int)x, (int)y);
    for (int dy = -reach; dy <= reach; dy++)
        for (int dx = -reach; dx <= reach; dx++) {
            size_t at = regression_at(&image->guides, (int)x + dx, (int)y + dy);
            bool is_bright = brightness_at(image->light, at) > 0.5f * bright;
            bool is_own = regression_is_like(&image->guides, middle, at);
            near.bright += is_bright;
            near.own += is_own;
            near.own_bright += is_bright && is_own;
        }
    return near;
}

/* Whether hardly any pixels near it are half as bright. */
static bool is_alone(const struct denoised_image *image, size_t x, size_t y, float bright)
{
    int few = image->kind[y * image->width + x] == (float)GLOSSY ? FEW_IN_GLOSS : FEW;
    return look_around(image, x, y, bright, NEAR).bright <= few;
}

/* Whether most pixels of its surface near by are half as bright, or two thirds of the others next
 * to it, as at the border of a caustic. Then it is the first fit that is wrong: there it is too
 * low. */
static bool is_usual(const struct denoised_image *image, size_t x, size_t y, float bright)
{
    struct around next = look_around(image, x, y, bright, NEXT);
    if (next.own >= LEAST_USUAL && 3 * (next.own_bright - 1) > 2 * (next.own - 1))
        return true;
    struct around near = look_around(image, x, y, bright, NEAR);
    return near.own >= LEAST_USUAL && 2 * near.own_bright > near.own;
}

/* Limits a pixel to FAR_ABOVE times the first fit, in `fine`, unless its brightness cannot be noise
 * or pixels near it share it: where the noise is known several, and a patch of sun is kept, else
 * most of them. */
static void clamp_pixel(const struct denoised_image *image, size_t x, size_t y, size_t at)
{
    size_t pixel = y * image->width + x;
    float first = brightness_at(image->fine, pixel), bright = brightness_at(image->light, at);
    bool known = image->view->even_r != NULL;
    float limit = FAR_ABOVE * ps_max(first, image->least);
    if (known && bright > limit)
        limit = ps_max(limit, bright - OUTLIER_NOISE * largest_noise_near(image, x, y));
    bool is_outlier =
        bright > limit && (known ? is_alone(image, x, y, bright) : !is_usual(image, x, y, bright));
    float keep = is_outlier ? limit / bright : 1.0f;
    for (int c = 0; c < REGRESSION_COLOURS; c++)
        image->clamped[c][at] = keep * image->light[c][at];
    image->clamped[NOISE][at] =
        known ? keep * image->noise[pixel] : sign_of_noise(image, x, y) * (keep * bright - first);
}

static void clamp_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct denoised_image *image = user;
    for (size_t x = 0; x < image->width; x++) {
        size_t at = regression_at(&image->guides, (int)x, (int)row);
        if (image->guides.size[at] > 0.0f)
            clamp_pixel(image, x, row, at);
    }
}

void regression_clamp_outliers(struct denoised_image *image)
{
    const ps_host *host = image->host;
    image->least = 0.1f * mean_brightness(image, image->fine) + 1e-18f; /* its square is no 0 */
    if (image->view->even_r)
        host->parallel_for(host, image->height, take_noise_of_row, image);
    host->parallel_for(host, image->height, clamp_row, image);
}
