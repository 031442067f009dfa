/* bands.c: B = F_R - F_2R of each bandwidth, multiplied by k = max(0, 1 - (c <N^2> / <B^2>)^2) and
 * added up; regression.c has the formula and its papers. */
#include "bands.h"

#include "squares.h"

#include <psplat/isa.h>
#include <psplat/math.h>

/* c of that formula: where the wider band was kept, and where it was not. Past the first band of a
 * single pass, whose noise contains some of the light, GUESSED_THRESHOLD takes the place of
 * THRESHOLD, and in narrow bands, where it contains less, NARROW_THRESHOLD; in the last band, of
 * the pixels themselves, PIXELS_THRESHOLD, and ALONE_THRESHOLD where each is judged by itself. */
#define THRESHOLD 2.0f
#define THRESHOLD_ALONE 4.0f
#define GUESSED_THRESHOLD 1.2f
#define NARROW_THRESHOLD 1.4f
#define PIXELS_THRESHOLD 1.5f
#define ALONE_THRESHOLD 3.0f

#define PIXELS_WINDOW 4 /* R of the window of the last band */
#define SURROUNDINGS                                                                               \
    0.25f /* of F_48, relative to which a pixel of the last band is measured at least */

static const int bandwidths[] = {48, 24, 12, 6, 3}; /* of the bands */

/* Starts with the widest fit, F_48. Squares of bands are weighted by 1 / (F_48^2 + least^2),
 * that is, relative to the light: else the bright pixels of a window would decide about its dark
 * ones. */
static void begin_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct denoised_image *image = user;
    for (size_t i = row * image->width; i < (row + 1) * image->width; i++) {
        float bright = brightness_at(image->coarse, i);
        image->inverse_square[i] = 1.0f / (bright * bright + image->least * image->least);
        image->shrinkage[i] = 1.0f;
        if (image->error)
            image->error[i] =
                image->coarse[NOISE][i] * image->coarse[NOISE][i] * image->inverse_square[i];
        for (int c = 0; c < REGRESSION_COLOURS; c++)
            image->sum[c][i] = image->coarse[c][i];
    }
}

/* What is kept of a band of mean square S, of which N is noise: 1 - (c N / S)^2, with the limit c
 * N. */
static PS_INLINED float keep_of(float signal, float limit)
{
    bool some = signal > limit;
    float share = (some ? limit : 1.0f) / (some ? signal : 1.0f);
    return 1.0f - share * share;
}

/* Of a band of mean square S of which N is noise, and of which the share k is kept: k^2 N + (1 -
 * k)^2 (S - N), Stein's estimate of the risk. Of what S exceeds N by, as much as half of the
 * threshold is taken for chance. */
static PS_INLINED float risk_of_band(float signal, float noise, float threshold, float keep)
{
    float lost = ps_max(signal - 0.5f * threshold * noise, 0.0f);
    return keep * keep * noise + (1.0f - keep) * (1.0f - keep) * lost;
}

/* Replaces S and N by k and its risk for pixels of the current kind, by 0 for the others. */
PS_EVERY_ISA static void shrink(const struct denoised_image *image, size_t first)
{
    const float *restrict kind = image->kind + first;
    const float *restrict signal_weight = image->signal_weight + first;
    const float *restrict noise_weight = image->noise_weight + first;
    float *restrict shrinkage = image->shrinkage + first;
    float *restrict signal = image->signal + first, *restrict noise = image->noise + first;
    float least = image->threshold, own = (float)image->current_kind;
#pragma omp simd
    for (size_t i = 0; i < image->width; i++) {
        float squares = regression_mean_of(signal[i], signal_weight[i]),
              chance = regression_mean_of(noise[i], noise_weight[i]);
        float threshold = THRESHOLD_ALONE + (least - THRESHOLD_ALONE) * shrinkage[i];
        float keep = keep_of(squares, threshold * chance);
        float risk = risk_of_band(squares, chance, threshold, keep);
        bool is_own = kind[i] == own;
        shrinkage[i] = is_own ? keep : shrinkage[i];
        signal[i] = is_own ? keep : 0.0f;
        noise[i] = is_own ? risk : 0.0f;
    }
}

PS_EVERY_ISA static void add(const struct denoised_image *image, size_t first)
{
    const float *restrict keep = image->signal + first, *restrict risk = image->noise + first;
    for (int c = 0; c < REGRESSION_COLOURS; c++) {
        const float *restrict fine = image->fine[c] + first;
        const float *restrict coarse = image->coarse[c] + first;
        float *restrict sum = image->sum[c] + first;
#pragma omp simd
        for (size_t i = 0; i < image->width; i++)
            sum[i] += keep[i] * (fine[i] - coarse[i]);
    }
    if (!image->error)
        return;
    float *restrict error = image->error + first;
#pragma omp simd
    for (size_t i = 0; i < image->width; i++)
        error[i] += risk[i];
}

static void add_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct denoised_image *image = user;
    shrink(image, row * image->width);
    add(image, row * image->width);
}

/* Adds the difference of `fine` and `coarse` of the first `count` images to the pixels of one
 * kind. */
static void add_band_of_kind(struct denoised_images *images, int count, int radius,
                             enum pixel_kind kind)
{
    for (int i = 0; i < count; i++)
        images->of[i].current_kind = kind;
    regression_count_squares(&images->of[0], radius);
    for (int i = 0; i < count; i++) {
        struct denoised_image *image = &images->of[i];
        regression_measure_squares(image, radius);
        image->host->parallel_for(image->host, image->height, add_row, image);
    }
}

static void add_band(struct denoised_images *images, int count, int radius)
{
    for (int kind = NO_KIND + 1; kind < KINDS; kind++)
        if (images->has[kind])
            add_band_of_kind(images, count, radius, (enum pixel_kind)kind);
}

static void copy_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct denoised_image *image = user;
    for (size_t x = 0; x < image->width; x++)
        for (int c = 0; c < VALUES; c++)
            image->fine[c][row * image->width + x] =
                image->clamped[c][regression_at(&image->guides, (int)x, (int)row)];
}

static void swap_fits(struct denoised_image *image)
{
    for (int c = 0; c < VALUES; c++) {
        float *plane = image->fine[c];
        image->fine[c] = image->coarse[c];
        image->coarse[c] = plane;
    }
}

/* The last band is measured relative to F_3, the light at the pixel itself: on the dark side of an
 * edge F_48 is mostly the bright side's. A part of F_48 counts at least, since F_3 may be wrong
 * where it is dark. */
static void rescale_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct denoised_image *image = user;
    for (size_t i = row * image->width; i < (row + 1) * image->width; i++) {
        float bright = ps_max(brightness_at(image->coarse, i), 0.0f),
              before = image->inverse_square[i];
        image->inverse_square[i] = 1.0f / (bright * bright + SURROUNDINGS * SURROUNDINGS / before);
        if (image->error)
            image->error[i] *= image->inverse_square[i] / before;
    }
}

/* The pixels themselves, of images whose noise is known. */
static void add_pixels(struct denoised_images *images)
{
    for (int i = 0; i < images->halved; i++) {
        struct denoised_image *image = &images->of[i];
        image->host->parallel_for(image->host, image->height, copy_row, image);
        image->host->parallel_for(image->host, image->height, rescale_row, image);
        image->threshold = PIXELS_THRESHOLD;
    }
    if (images->halved > 0)
        add_band(images, images->halved, PIXELS_WINDOW);
}

/* A pixel whose variance is known, in a picture that has no halves. The noise of the sum of the
 * light's channels follows from the variance of the mean of the irradiance's. */
static void add_known_pixel(const struct denoised_image *image, size_t i, size_t at)
{
    float noise = 9.0f / (PS_PI * PS_PI) * image->view->variance[i];
    float off = brightness_at(image->light, at) - brightness_at(image->sum, i);
    float keep = keep_of(off * off, ALONE_THRESHOLD * noise);
    for (int c = 0; c < REGRESSION_COLOURS; c++)
        image->sum[c][i] += keep * (image->light[c][at] - image->sum[c][i]);
    if (image->error)
        image->error[i] = keep * keep * noise * image->inverse_square[i] +
                          (1.0f - keep) * (1.0f - keep) * image->error[i];
}

static void add_known_of_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct denoised_image *image = user;
    for (size_t x = 0; x < image->width; x++) {
        size_t i = row * image->width + x;
        if (image->view->variance[i] > 0.0f &&
            regression_shows_surface(&image->guides, (int)x, (int)row))
            add_known_pixel(image, i, regression_at(&image->guides, (int)x, (int)row));
    }
}

static void add_known_pixels(struct denoised_images *images)
{
    for (int i = images->halved; i < images->count; i++)
        if (images->of[i].view->variance)
            images->of[i].host->parallel_for(images->of[i].host, images->of[i].height,
                                             add_known_of_row, &images->of[i]);
}

static float least_threshold(bool halved, size_t band)
{
    if (halved || band == 1)
        return THRESHOLD;
    return bandwidths[band] > REGRESSION_NARROW ? GUESSED_THRESHOLD : NARROW_THRESHOLD;
}

void regression_add_bands(struct denoised_images *images)
{
    regression_fit_all(images, bandwidths[0], clamped_of, coarse_of);
    regression_for_each_row(images, begin_row);
    for (size_t k = 1; k < sizeof bandwidths / sizeof bandwidths[0]; k++) {
        regression_fit_steered(images, bandwidths[k], clamped_of, fine_of);
        for (int i = 0; i < images->count; i++)
            images->of[i].threshold = least_threshold(i < images->halved, k);
        add_band(images, images->count, bandwidths[k]);
        for (int i = 0; i < images->count; i++)
            swap_fits(&images->of[i]);
    }
    add_pixels(images);
    add_known_pixels(images);
}
