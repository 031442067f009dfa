/* bands.c: B = F_R - F_2R of each bandwidth, multiplied by k = max(0, 1 - (c <N^2> / <B^2>)^2) and
 * added up; regression.c has the formula and its papers. */
#include "bands.h"

#include "box.h"

#include <psplat/isa.h>
#include <psplat/math.h>

/* c of that formula: where the wider band was kept, and where it was not. Past the first band of a
 * single pass, whose noise contains some of the light, GUESSED_THRESHOLD takes the place of
 * THRESHOLD; in the last band, of the pixels themselves, PIXELS_THRESHOLD, and ALONE_THRESHOLD
 * where each is judged by itself. */
#define THRESHOLD 2.0f
#define THRESHOLD_ALONE 4.0f
#define GUESSED_THRESHOLD 1.2f
#define PIXELS_THRESHOLD 1.5f
#define ALONE_THRESHOLD 3.0f

/* Bands of R up to NARROW take what is larger, the mean of the noise over the wider square or that
 * over the square of the signal: which counts for so much, being that of few blobs, and for half of
 * it where the signal's mean square, relative to the light, is 1 / SIGNAL_NEAR. */
#define NARROW 6
#define NOISE_NEAR 1.25f
#define SIGNAL_NEAR 30.0f

#define PIXELS_WINDOW 4        /* R of the window of the last band */
#define BROAD_AMONG_THIN 0.03f /* weight of a BROAD pixel in the means of THIN ones */
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

/* A row of pixels, and the kind under way. */
struct row {
    const struct denoised_image *image;
    size_t first;
    float own;         /* its number */
    float broad_share; /* of those of another kind, what BROAD ones count for */
};

static struct row row_of(const struct denoised_image *image, uint64_t row)
{
    return (struct row){
        .image = image,
        .first = row * image->width,
        .own = (float)image->current_kind,
        .broad_share = image->current_kind == THIN ? BROAD_AMONG_THIN : 0.0f,
    };
}

/* What a pixel of that kind counts for in the means of the kind under way. */
static PS_INLINED float share_of(const struct row *row, float kind)
{
    return kind == row->own ? 1.0f : kind == (float)BROAD ? row->broad_share : 0.0f;
}

PS_EVERY_ISA static void measure(const struct row row)
{
    const struct denoised_image *image = row.image;
    const float *restrict kind = image->kind + row.first, *restrict inverse_square =
                                                              image->inverse_square + row.first;
    const float *restrict fine[VALUES], *restrict coarse[VALUES];
    float *restrict signal = image->signal + row.first, *restrict noise = image->noise + row.first;
    float *restrict noise_near = image->noise_near + row.first;
    for (int c = 0; c < VALUES; c++) {
        fine[c] = image->fine[c] + row.first;
        coarse[c] = image->coarse[c] + row.first;
    }
#pragma omp simd
    for (size_t i = 0; i < image->width; i++) {
        float weight = share_of(&row, kind[i]) * inverse_square[i];
        float band = fine[0][i] + fine[1][i] + fine[2][i];
        band -= coarse[0][i] + coarse[1][i] + coarse[2][i];
        float chance = fine[NOISE][i] - coarse[NOISE][i];
        signal[i] = band * band * weight;
        noise[i] = noise_near[i] = chance * chance * weight;
    }
}

static void measure_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    measure(row_of(user, row));
}

PS_EVERY_ISA static void count(const struct row row)
{
    const float *restrict kind = row.image->kind + row.first;
    float *restrict signal_weight = row.image->signal_weight + row.first;
    float *restrict noise_weight = row.image->noise_weight + row.first;
#pragma omp simd
    for (size_t i = 0; i < row.image->width; i++)
        signal_weight[i] = noise_weight[i] = share_of(&row, kind[i]);
}

static void count_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    count(row_of(user, row));
}

/* Replaces values by their sums over a square around. */
static void sum_over_square(const struct denoised_image *image, int radius, float *plane)
{
    struct regression_box box = {image->width, image->height, (size_t)radius, plane,
                                 image->scratch};
    regression_box_sums(image->host, &box);
}

/* Sums over pixels that count for so much in all become means; where there are none, sums are 0. */
static PS_INLINED float mean_of(float sum, float count)
{
    return sum / (count > 0.0f ? count : 1.0f);
}

/* The larger mean square of the noise over both squares, as a sum over the wider one. */
PS_EVERY_ISA static void take_larger_noise(const struct row row)
{
    const struct denoised_image *image = row.image;
    const float *restrict signal = image->signal + row.first;
    const float *restrict noise_near = image->noise_near + row.first;
    const float *restrict signal_weight = image->signal_weight + row.first;
    const float *restrict noise_weight = image->noise_weight + row.first;
    float *restrict noise = image->noise + row.first;
#pragma omp simd
    for (size_t i = 0; i < image->width; i++) {
        float squares = mean_of(signal[i], signal_weight[i]);
        float near = mean_of(noise_near[i], signal_weight[i]);
        near *= NOISE_NEAR / (1.0f + SIGNAL_NEAR * squares);
        noise[i] = ps_max(noise[i], near * noise_weight[i]);
    }
}

static void take_larger_noise_of_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    take_larger_noise(row_of(user, row));
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
PS_EVERY_ISA static void shrink(const struct row row)
{
    const struct denoised_image *image = row.image;
    const float *restrict kind = image->kind + row.first;
    const float *restrict signal_weight = image->signal_weight + row.first;
    const float *restrict noise_weight = image->noise_weight + row.first;
    float *restrict shrinkage = image->shrinkage + row.first;
    float *restrict signal = image->signal + row.first, *restrict noise = image->noise + row.first;
    float least = image->threshold, own = row.own;
#pragma omp simd
    for (size_t i = 0; i < image->width; i++) {
        float squares = mean_of(signal[i], signal_weight[i]),
              chance = mean_of(noise[i], noise_weight[i]);
        float threshold = THRESHOLD_ALONE + (least - THRESHOLD_ALONE) * shrinkage[i];
        float keep = keep_of(squares, threshold * chance);
        float risk = risk_of_band(squares, chance, threshold, keep);
        bool is_own = kind[i] == own;
        shrinkage[i] = is_own ? keep : shrinkage[i];
        signal[i] = is_own ? keep : 0.0f;
        noise[i] = is_own ? risk : 0.0f;
    }
}

PS_EVERY_ISA static void add(const struct row row)
{
    const struct denoised_image *image = row.image;
    const float *restrict keep = image->signal + row.first, *restrict risk =
                                                                image->noise + row.first;
    for (int c = 0; c < REGRESSION_COLOURS; c++) {
        const float *restrict fine = image->fine[c] + row.first;
        const float *restrict coarse = image->coarse[c] + row.first;
        float *restrict sum = image->sum[c] + row.first;
#pragma omp simd
        for (size_t i = 0; i < image->width; i++)
            sum[i] += keep[i] * (fine[i] - coarse[i]);
    }
    if (!image->error)
        return;
    float *restrict error = image->error + row.first;
#pragma omp simd
    for (size_t i = 0; i < image->width; i++)
        error[i] += risk[i];
}

static void add_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    shrink(row_of(user, row));
    add(row_of(user, row));
}

/* Puts sums over squares around in place of B^2 and N^2, whose square is twice as wide. */
static void sum_squares(struct denoised_image *image, int radius)
{
    sum_over_square(image, radius, image->signal);
    sum_over_square(image, 2 * radius, image->noise);
    if (radius > NARROW || !image->view->even_r)
        return;
    sum_over_square(image, radius, image->noise_near);
    image->host->parallel_for(image->host, image->height, take_larger_noise_of_row, image);
}

/* Adds the difference of `fine` and `coarse` of the first `count` images to the pixels of one
 * kind. */
static void add_band_of_kind(struct denoised_images *images, int count, int radius,
                             enum pixel_kind kind)
{
    struct denoised_image *first = &images->of[0];
    for (int i = 0; i < count; i++)
        images->of[i].current_kind = kind;
    first->host->parallel_for(first->host, first->height, count_row, first);
    sum_over_square(first, radius, first->signal_weight);
    sum_over_square(first, 2 * radius, first->noise_weight);
    for (int i = 0; i < count; i++) {
        struct denoised_image *image = &images->of[i];
        image->host->parallel_for(image->host, image->height, measure_row, image);
        sum_squares(image, radius);
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

void regression_add_bands(struct denoised_images *images)
{
    regression_fit_all(images, bandwidths[0], clamped_of, coarse_of);
    regression_for_each_row(images, begin_row);
    for (size_t k = 1; k < sizeof bandwidths / sizeof bandwidths[0]; k++) {
        regression_fit_steered(images, bandwidths[k], clamped_of, fine_of);
        for (int i = 0; i < images->count; i++)
            images->of[i].threshold = k > 1 && i >= images->halved ? GUESSED_THRESHOLD : THRESHOLD;
        add_band(images, images->count, bandwidths[k]);
        for (int i = 0; i < images->count; i++)
            swap_fits(&images->of[i]);
    }
    add_pixels(images);
    add_known_pixels(images);
}
