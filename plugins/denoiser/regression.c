/* regression.c: planes fitted to the irradiance, as wide as its noise asks for.
 *
 * regression/fit.h fits planes to the irradiance E of the pixels around, along the surfaces that they show. One
 * bandwidth cannot do: a wide one blurs, a narrow one leaves noise. So fits F_R of five bandwidths R make bands, and
 * each band is added as far as it is signal, neighbourhood by neighbourhood (shrinkage: James and Stein 1961;
 * Donoho and Johnstone 1994):
 *
 *     E' = F_48 + sum over R = 24, 12, 6, 3 of k_R B,   B = F_R - F_2R,   k_R = max(0, 1 - (c <N^2> / <B^2>)^2)
 *
 * N is the band of a picture of the noise alone, and <> a mean over a square around. So few blobs of noise fit into
 * such a square that now and then they seem to be signal. But edges of light show in all bands, and chance in one: the
 * caution c is 2 where the band before was kept, 4 where none of it was, and in proportion between (bivariate
 * shrinkage does the same to wavelets: Sendur and Selesnick 2002).
 *
 * Where two halves of the light are known, of passes or of shadow rays, their difference is the noise, and the pixels
 * themselves are a last band: light without noise stays as it is, with its hard shadows. Of a single pass of indirect
 * light the noise is what pixels differ from a first fit, with signs drawn by lot (the wild bootstrap, Wu 1986). That
 * needs noise that is independent from pixel to pixel, as that of paths is and that of splats is not. In gloss, and
 * behind a lens, where samples of a pixel share the light of those around it (src/view/edges.h), blocks of pixels take
 * one sign (the dependent wild bootstrap, Shao 2010).
 *
 * Bright samples that few pixels found would leave speckles in narrow bands. So what exceeds twice the first fit, and
 * may be noise, is left out of the bands. At last the rest, E - E', gets a fit as wide as possible, and is added: with
 * it what was left out, so that nothing is lost as clamping loses it, and what all fits are too dark or too bright by
 * (twicing, Tukey 1977).
 *
 * E is radiance over albedo, so that colours of surfaces stay sharp. A channel that a surface hardly reflects says
 * nothing about the light, and is taken for the mean of its other channels. What gloss mirrors is fitted along
 * the glossy surface, as if it were irradiance, and is blurred as far as noise asks.
 */
#include "regression/bounds.h"
#include "regression/box.h"
#include "regression/fit.h"

#include <psplat/plugin.h>
#include <stdbool.h>
#include <string.h>

#define DARKEST 1e-3f       /* albedo below which light is not judged by */
#define FIRST 24            /* bandwidth of the first fit */
#define FAR_ABOVE 2.0f      /* of the first fit: what is brighter may be left out of the bands */
#define OUTLIER_NOISE 1.5f  /* times the noise near by, by which outliers may be too bright */
#define NEAR 3              /* pixels to each side are near by */
#define CAUTION 2.0f        /* times the noise that a band must exceed */
#define ALONE 4.0f          /* the same, where nothing of the band before was kept */
#define PIXELS_CAUTION 1.5f /* in place of CAUTION for the last band, of the pixels themselves */
#define PIXELS_WINDOW 4     /* R of the window of that band */
#define SHARED 4            /* pixels along a block whose noise may be one */
/* Errors of the bands are not independent, and what is finer than the narrowest fit is none of them: against path-traced
 * references of seven scenes errors are larger than the sum over bands by so much. */
#define UNSEEN 1.4f
#define GLOSSY 0.125f             /* share of gloss from which on a pixel is of that class */
#define WIDEST REGRESSION_LARGEST /* bandwidth of the rest */

static const int bandwidths[] = {48, 24, 12, 6, 3}; /* of the bands */

enum { NOISE = REGRESSION_COLOURS, VALUES = REGRESSION_VALUES };

static const char *const automatic[] = {"auto", NULL};

struct state {
    double normal;
    ps_number_or_choice distance;
};

struct work {
    const ps_host *host;
    const ps_image_view *image;
    size_t width, height;
    struct regression guides;
    ps_camera camera;
    /* With a margin: irradiance / pi, and what of it is fitted, with its noise: the sum of the channels'. */
    float *light[VALUES], *body[VALUES];
    /* Without: two fits, their sum so far, and for the bands 1 / F_48^2, B^2, N^2 and room to smooth those in. Before
     * the bands `noise` holds N, where halves tell it. */
    float *fine[VALUES], *coarse[VALUES], *sum[REGRESSION_COLOURS];
    float *scale, *signal, *noise, *room;
    float *around;   /* pixels of the class in a square */
    float *kept;     /* k of the band before */
    float *averaged; /* the plane under way */
    float *error;    /* where it is asked for: its square, times `scale` */
    float caution;   /* with the band under way */
    bool glossy;     /* the class of pixels under way */
    float least;     /* brightness that counts as dark */
};

struct works {
    struct work of[REGRESSION_IMAGES];
    int count;
};

static float brightness(const float colour[REGRESSION_COLOURS])
{
    return colour[0] + colour[1] + colour[2];
}

static float brightness_at(float *const planes[], size_t at)
{
    return planes[0][at] + planes[1][at] + planes[2][at];
}

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

static void take_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    for (size_t x = 0; x < work->width; x++)
        take_pixel(work, row * work->width + x, regression_at(&work->guides, x, row));
}

/* --- what the bands are made of --- */

static float mean_brightness(const struct work *work, float *const planes[])
{
    double sum = 0.0, count = 1.0;
    for (size_t y = 0; y < work->height; y++)
        for (size_t x = 0; x < work->width; x++)
            if (work->guides.size[regression_at(&work->guides, x, y)] > 0.0f) {
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

static float sign_of_noise(const struct work *work, size_t x, size_t y)
{
    const float *gloss = work->image->gloss;
    bool shared = work->camera.aperture > 0.0f || (gloss && gloss[y * work->width + x] > 0.0f);
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
        work->noise[first + x] = work->guides.size[regression_at(&work->guides, x, row)] > 0.0f
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

/* From the first fit, in `fine`. What is bright without noise is no outlier. */
static void make_body(const struct work *work, size_t x, size_t y, size_t at)
{
    size_t pixel = y * work->width + x;
    float first = brightness_at(work->fine, pixel), bright = brightness_at(work->light, at);
    bool known = work->image->even_r != NULL;
    float noise = known ? largest_noise_near(work, x, y) : bright;
    float limit = ps_max(FAR_ABOVE * ps_max(first, work->least), bright - OUTLIER_NOISE * noise);
    float keep = bright > limit ? limit / bright : 1.0f;
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
        size_t at = regression_at(&work->guides, x, row);
        if (work->guides.size[at] > 0.0f)
            make_body(work, x, row, at);
    }
}

/* --- bands --- */

/* The widest fit, by whose square all is measured: a neighbourhood's dark corner must not be ruled by its lamp. */
static void begin_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    for (size_t i = row * work->width; i < (row + 1) * work->width; i++) {
        float bright = brightness_at(work->coarse, i);
        work->scale[i] = 1.0f / (bright * bright + work->least * work->least);
        work->kept[i] = 1.0f;
        if (work->error)
            work->error[i] = work->coarse[NOISE][i] * work->coarse[NOISE][i] * work->scale[i];
        for (int c = 0; c < REGRESSION_COLOURS; c++)
            work->sum[c][i] = work->coarse[c][i];
    }
}

static bool is_in_class(const struct work *work, size_t pixel)
{
    const float *gloss = work->image->gloss;
    return (gloss && gloss[pixel] > GLOSSY) == work->glossy;
}

static void measure_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    for (size_t i = row * work->width; i < (row + 1) * work->width; i++) {
        if (!is_in_class(work, i)) {
            work->signal[i] = work->noise[i] = 0.0f;
            continue;
        }
        float noise = work->fine[NOISE][i] - work->coarse[NOISE][i];
        float band = brightness_at(work->fine, i) - brightness_at(work->coarse, i);
        work->signal[i] = band * band * work->scale[i];
        work->noise[i] = noise * noise * work->scale[i];
    }
}

static void count_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    for (size_t x = 0; x < work->width; x++) {
        size_t i = row * work->width + x;
        bool shown = work->guides.size[regression_at(&work->guides, x, row)] > 0.0f;
        work->around[i] = shown && is_in_class(work, i) ? 1.0f : 0.0f;
    }
}

static void divide_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    for (size_t i = row * work->width; i < (row + 1) * work->width; i++)
        work->averaged[i] *= work->around[i] > 0.0f ? 1.0f / work->around[i] : 0.0f;
}

static void sum_around(struct work *work, int radius, float *plane)
{
    const struct regression_box box = {work->width, work->height, (size_t)radius, plane,
                                       work->room};
    regression_box_sums(work->host, &box);
}

/* Replaces values of the class by their means over its pixels in a square around. */
static void average_around(struct work *work, int radius, float *plane)
{
    sum_around(work, radius, plane);
    work->host->parallel_for(work->host, work->height, count_row, work);
    sum_around(work, radius, work->around);
    work->averaged = plane;
    work->host->parallel_for(work->host, work->height, divide_row, work);
}

/* Of a band of mean square S of which N is noise, and of which the share k is kept: k^2 N + (1 - k)^2 (S - N), Stein's
 * estimate of the risk. Of what S exceeds N by, as much as half of the caution is taken for chance. */
static float risk_of_band(const struct work *work, size_t i, float caution, float keep)
{
    float noise = work->noise[i];
    float lost = ps_max(work->signal[i] - 0.5f * caution * noise, 0.0f);
    return keep * keep * noise + (1.0f - keep) * (1.0f - keep) * lost;
}

static void add_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    for (size_t i = row * work->width; i < (row + 1) * work->width; i++) {
        if (!is_in_class(work, i))
            continue;
        float caution = ALONE + (work->caution - ALONE) * work->kept[i];
        float noise = caution * work->noise[i], signal = work->signal[i];
        float share = signal > noise ? noise / signal : 1.0f, keep = 1.0f - share * share;
        work->kept[i] = keep;
        for (int c = 0; c < REGRESSION_COLOURS; c++)
            work->sum[c][i] += keep * (work->fine[c][i] - work->coarse[c][i]);
        if (work->error)
            work->error[i] += risk_of_band(work, i, caution, keep);
    }
}

/* The difference of `fine` and `coarse`, to the pixels of one class: what gloss mirrors has noise of its own, which
 * says nothing about the walls around. One picture of the noise may have less of it than there is: of that, more
 * pixels are asked. */
static void add_band_of_class(struct work *work, int radius)
{
    work->host->parallel_for(work->host, work->height, measure_row, work);
    average_around(work, radius, work->signal);
    average_around(work, 2 * radius, work->noise);
    work->host->parallel_for(work->host, work->height, add_row, work);
}

static void add_band(struct work *work, int radius, float caution)
{
    work->caution = caution;
    work->glossy = false;
    add_band_of_class(work, radius);
    work->glossy = true;
    if (work->image->gloss)
        add_band_of_class(work, radius);
}

static void copy_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    for (size_t x = 0; x < work->width; x++)
        for (int c = 0; c < VALUES; c++)
            work->fine[c][row * work->width + x] =
                work->body[c][regression_at(&work->guides, x, row)];
}

static void swap_fits(struct work *work)
{
    for (int c = 0; c < VALUES; c++) {
        float *plane = work->fine[c];
        work->fine[c] = work->coarse[c];
        work->coarse[c] = plane;
    }
}

/* Of each image by itself. */
static void for_each_row(struct works *works, ps_body body)
{
    const ps_host *host = works->of[0].host;
    for (int i = 0; i < works->count; i++)
        host->parallel_for(host, works->of[i].height, body, &works->of[i]);
}

/* Fits one of their sets of values by another, all images together. */
typedef float **(*planes_of)(struct work *work);

static float **light_of(struct work *work)
{
    return work->light;
}

static float **body_of(struct work *work)
{
    return work->body;
}

static float **fine_of(struct work *work)
{
    return work->fine;
}

static float **coarse_of(struct work *work)
{
    return work->coarse;
}

static void fit_all(struct works *works, int bandwidth, planes_of from, planes_of to)
{
    float *values[REGRESSION_MOST], *fitted[REGRESSION_MOST];
    for (int i = 0; i < works->count; i++)
        for (int c = 0; c < VALUES; c++) {
            values[i * VALUES + c] = from(&works->of[i])[c];
            fitted[i * VALUES + c] = to(&works->of[i])[c];
        }
    regression_fit(&works->of[0].guides, bandwidth, works->count * VALUES, values, fitted);
}

static void add_bands(struct works *works)
{
    fit_all(works, bandwidths[0], body_of, coarse_of);
    for_each_row(works, begin_row);
    for (size_t k = 1; k < sizeof bandwidths / sizeof bandwidths[0]; k++) {
        fit_all(works, bandwidths[k], body_of, fine_of);
        for (int i = 0; i < works->count; i++) {
            add_band(&works->of[i], bandwidths[k], CAUTION);
            swap_fits(&works->of[i]);
        }
    }
    for (int i = 0; i < works->count; i++) {
        struct work *work = &works->of[i];
        if (!work->image->even_r)
            continue;
        work->host->parallel_for(work->host, work->height, copy_row, work);
        add_band(work, PIXELS_WINDOW, PIXELS_CAUTION);
    }
}

/* --- the rest --- */

static void take_rest_of_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    for (size_t x = 0; x < work->width; x++) {
        size_t at = regression_at(&work->guides, x, row);
        for (int c = 0; c < REGRESSION_COLOURS && work->guides.size[at] > 0.0f; c++)
            work->body[c][at] = work->light[c][at] - work->sum[c][row * work->width + x];
    }
}

static void store_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    const ps_image_view *image = work->image;
    float *const out[3] = {image->r, image->g, image->b};
    const float *const albedo[3] = {image->albedo_r, image->albedo_g, image->albedo_b};
    for (size_t x = 0; x < work->width; x++) {
        size_t i = row * work->width + x;
        for (int c = 0; c < 3 && work->guides.size[regression_at(&work->guides, x, row)] > 0.0f;
             c++)
            out[c][i] = albedo[c][i] * ps_max(work->sum[c][i] + work->fine[c][i], 0.0f);
    }
}

/* That of the sum of the irradiance's channels becomes that of the mean of the radiance's. */
static void store_error_of_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    const ps_image_view *image = work->image;
    for (size_t x = 0; x < work->width; x++) {
        size_t i = row * work->width + x;
        if (!(work->guides.size[regression_at(&work->guides, x, row)] > 0.0f))
            continue;
        float off = UNSEEN * sqrtf(work->error[i] / work->scale[i]);
        float irradiance = brightness_at(work->sum, i) + brightness_at(work->fine, i);
        float radiance = (image->r[i] + image->g[i] + image->b[i]) * (1.0f / 3.0f);
        float albedo =
            (image->albedo_r[i] + image->albedo_g[i] + image->albedo_b[i]) * (1.0f / 9.0f);
        image->error[i] = off * (irradiance > 0.0f ? radiance / irradiance : albedo);
    }
}

/* From the light to the body, with its noise. */
static void prepare(struct work *work)
{
    const ps_host *host = work->host;
    work->least = 0.1f * mean_brightness(work, work->fine) + 1e-18f; /* its square is no 0 */
    if (work->image->even_r)
        host->parallel_for(host, work->height, take_noise_of_row, work);
    host->parallel_for(host, work->height, make_body_of_row, work);
}

static void denoise(struct works *works)
{
    for_each_row(works, take_row);
    regression_bounds_find(&works->of[0].guides);
    fit_all(works, FIRST, light_of, fine_of);
    for (int i = 0; i < works->count; i++)
        prepare(&works->of[i]);
    add_bands(works);
    for_each_row(works, take_rest_of_row);
    fit_all(works, WIDEST, body_of, fine_of);
    for_each_row(works, store_row);
    for (int i = 0; i < works->count; i++)
        if (works->of[i].error)
            works->of[i].host->parallel_for(works->of[i].host, works->of[i].height,
                                            store_error_of_row, &works->of[i]);
}

/* --- the strategy --- */

/* Points `planes` to the next `count` planes of memory. */
static float *lay_out(float *memory, size_t size, int count, float *planes[])
{
    for (int i = 0; i < count; i++)
        planes[i] = memory + (size_t)i * size;
    return memory + (size_t)count * size;
}

/* Planes that all images share, with a margin and without, and those of each. */
enum { GUIDES = 8, SCRATCH = 3 };
enum { IMAGE_WITH_MARGIN = 2 * VALUES, IMAGE = 2 * VALUES + REGRESSION_COLOURS + 4 };

#define IMAGE_BYTES ((IMAGE_WITH_MARGIN + IMAGE) * sizeof(float) + REGRESSION_PLANES_PIXEL)

static float *lay_out_shared(struct work *work, float *next, size_t with_margin, size_t pixels)
{
    next = lay_out(next, with_margin, 3, work->guides.normal);
    next = lay_out(next, with_margin, 3, work->guides.position);
    next = lay_out(next, with_margin, 1, &work->guides.gloss);
    next = lay_out(next, with_margin, 1, &work->guides.size);
    next = lay_out(next, pixels, 1, &work->signal);
    next = lay_out(next, pixels, 1, &work->room);
    return lay_out(next, pixels, 1, &work->around);
}

static float *lay_out_image(struct work *work, float *next, size_t with_margin, size_t pixels)
{
    next = lay_out(next, with_margin, VALUES, work->light);
    next = lay_out(next, with_margin, VALUES, work->body);
    next = lay_out(next, pixels, VALUES, work->fine);
    next = lay_out(next, pixels, VALUES, work->coarse);
    next = lay_out(next, pixels, REGRESSION_COLOURS, work->sum);
    next = lay_out(next, pixels, 1, &work->scale);
    next = lay_out(next, pixels, 1, &work->noise);
    next = lay_out(next, pixels, 1, &work->kept);
    float *error, *end = lay_out(next, pixels, 1, &error);
    work->error = work->image->error ? error : NULL;
    return end;
}

static size_t floats_of(size_t width, size_t height, int count)
{
    size_t with_margin = regression_plane_size(width, height), pixels = width * height;
    return (GUIDES + (size_t)count * IMAGE_WITH_MARGIN) * with_margin +
           (SCRATCH + (size_t)count * IMAGE) * pixels;
}

/* Images with halves may show means over several passes, and come first. The first one's guides are all of them's. */
static void lay_out_all(struct works *works, const struct work *shared, float *memory,
                        const ps_image_view *images)
{
    size_t with_margin = regression_plane_size(shared->width, shared->height);
    size_t pixels = shared->width * shared->height;
    struct work each = *shared;
    int count = works->count, halved = 0;
    float *next = lay_out_shared(&each, memory, with_margin, pixels);
    for (int i = 0; i < count; i++)
        halved += images[i].even_r != NULL;
    each.guides.narrow = halved * VALUES;
    for (int i = 0, with = 0, without = halved; i < count; i++) {
        struct work *work = &works->of[images[i].even_r ? with++ : without++];
        *work = each;
        work->image = &images[i];
        next = lay_out_image(work, next, with_margin, pixels);
    }
}

static ps_result filter_all(const void *opaque, const ps_host *host, const ps_image_view *images,
                            uint32_t count)
{
    const struct state *state = opaque;
    struct works works = {.count = (int)count};
    struct work shared = {.host = host, .width = images->width, .height = images->height};
    size_t width = shared.width, height = shared.height;
    size_t floats = floats_of(width, height, works.count);
    float *memory = host->allocate(host, floats * sizeof *memory, "denoiser");
    shared.guides = (struct regression){
        .host = host,
        .width = width,
        .height = height,
        .bend_scale = (float)(1 / (1 - cos(state->normal * (double)PS_PI / 180))),
        .distance = state->distance.choice >= 0 ? 0.0f : (float)state->distance.number,
        .bounds = host->allocate(host, regression_bounds_bytes(width, height), "denoiser"),
        .fits = host->allocate(host, regression_fits_bytes(width, height), "denoiser"),
        .planes = host->allocate(host, regression_planes_bytes(width, height, works.count * VALUES),
                                 "denoiser"),
    };
    const struct regression *guides = &shared.guides;
    bool good = memory && guides->bounds && guides->fits && guides->planes;
    ps_result result = good ? PS_OK : PS_ERROR_MEMORY;
    if (result == PS_OK) {
        memset(memory, 0, floats * sizeof *memory);
        shared.camera = (ps_camera){.size = sizeof shared.camera};
        host->camera(host, &shared.camera);
        lay_out_all(&works, &shared, memory, images);
        denoise(&works);
        result = host->cancelled(host) ? PS_CANCELLED : PS_OK;
    }
    host->release(host, shared.guides.planes);
    host->release(host, shared.guides.fits);
    host->release(host, shared.guides.bounds);
    host->release(host, memory);
    return result;
}

static ps_result filter(const void *opaque, const ps_host *host, const ps_image_view *image)
{
    return filter_all(opaque, host, image, 1);
}

static const ps_param params[] = {
    PS_NUMBER(struct state, normal, "30", 1, 90, PS_PARAM_EXPERT, "degrees",
              "angle between normals from which on nothing crosses"),
    PS_NUMBER_OR(struct state, distance, "auto", 0, INFINITY, PS_PARAM_OPEN_MIN | PS_PARAM_EXPERT,
                 automatic, "scene units",
                 "distance from the tangent plane from which on nothing crosses; auto: a fifth of "
                 "the bandwidth"),
};

static const ps_denoiser_vtable vtable = {
    .size = sizeof vtable,
    .flags = PS_DENOISER_HALVES | PS_DENOISER_DIRECT | PS_DENOISER_ERROR,
    .filter = filter,
    .pixel_bytes = (GUIDES + SCRATCH) * sizeof(float) + REGRESSION_BOUNDS_PIXEL +
                   REGRESSION_FITS_PIXEL + IMAGE_BYTES,
    .filter_all = filter_all,
    .image_bytes = IMAGE_BYTES,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_DENOISER,
    .name = "regression",
    .version = "1.0",
    .summary = "fits planes to the irradiance of surfaces, as wide as its noise asks for",
    .paper = "Moon et al. 2014, Adaptive rendering based on weighted local regression; Bitterli et "
             "al. 2016, Nonlinearly weighted first-order regression for denoising Monte Carlo "
             "renderings",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(denoiser, regression, &descriptor)
