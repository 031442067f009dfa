/* squares.c: see squares.h. */
#include "squares.h"

#include "box.h"

#include <psplat/isa.h>
#include <psplat/math.h>

#define BROAD_AMONG_THIN 0.03f /* weight of a BROAD pixel in the sums of THIN ones */

/* Where halves tell the noise, bands of R up to REGRESSION_NARROW take what is larger, its mean
 * over the wider square or that over the square of the signal: which counts for so much, being that
 * of few blobs, and for half of it where the signal's mean square, relative to the light, is 1 /
 * SIGNAL_NEAR. */
#define NOISE_NEAR 1.25f
#define SIGNAL_NEAR 30.0f

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

/* The weight of a pixel's squares, 1 / F_48^2, where light is `least` by the lowest of its fits. A
 * fit below zero is wrong by that much at least, and F_48, which was led astray by the same bright
 * light near by, may be next to nothing: so the light counts for so much. */
static PS_INLINED float weight_of(float inverse_square, float least)
{
    float below = ps_max(-least, 0.0f);
    return inverse_square / (1.0f + inverse_square * below * below);
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
        float narrow = fine[0][i] + fine[1][i] + fine[2][i];
        float wide = coarse[0][i] + coarse[1][i] + coarse[2][i];
        float band = narrow - wide;
        float weight = weight_of(inverse_square[i], ps_min(narrow, wide));
        weight *= share_of(&row, kind[i]);
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

/* The larger mean square of the noise over both squares, as a sum over the wider one. */
PS_EVERY_ISA static void take_larger(const struct row row)
{
    const struct denoised_image *image = row.image;
    const float *restrict signal = image->signal + row.first;
    const float *restrict noise_near = image->noise_near + row.first;
    const float *restrict signal_weight = image->signal_weight + row.first;
    const float *restrict noise_weight = image->noise_weight + row.first;
    float *restrict noise = image->noise + row.first;
#pragma omp simd
    for (size_t i = 0; i < image->width; i++) {
        float squares = regression_mean_of(signal[i], signal_weight[i]);
        float near = regression_mean_of(noise_near[i], signal_weight[i]);
        near *= NOISE_NEAR / (1.0f + SIGNAL_NEAR * squares);
        noise[i] = ps_max(noise[i], near * noise_weight[i]);
    }
}

static void take_larger_of_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    take_larger(row_of(user, row));
}

static void take_larger_noise(struct denoised_image *image, int radius)
{
    sum_over_square(image, radius, image->noise_near);
    image->host->parallel_for(image->host, image->height, take_larger_of_row, image);
}

/* Of the pixels, not of their fits: squares of what was guessed to be noise from the first fit, and
 * of what the sum of bands so far leaves. */
static void measure_guesses_of_row(void *user, uint64_t y, uint32_t worker)
{
    (void)worker;
    const struct denoised_image *image = user;
    struct row row = row_of(image, y);
    for (size_t x = 0; x < image->width; x++) {
        size_t i = row.first + x, at = regression_at(&image->guides, (int)x, (int)y);
        float sum = brightness_at(image->sum, i);
        float newer = brightness_at(image->clamped, at) - sum;
        float weight = share_of(&row, image->kind[i]) * weight_of(image->inverse_square[i], sum);
        float first = image->clamped[NOISE][at];
        image->noise_near[i] = first * first * weight;
        image->newer_near[i] = newer * newer * weight;
    }
}

static void lower_noise_of_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct denoised_image *image = user;
    for (size_t i = row * image->width; i < (row + 1) * image->width; i++)
        if (image->newer_near[i] < image->noise_near[i])
            image->noise[i] *= image->newer_near[i] / image->noise_near[i];
}

/* Where light changes fast, what pixels differ from the first fit by is light, too; bands that are
 * kept leave less of it. */
static void correct_guessed_noise(struct denoised_image *image, int radius)
{
    image->host->parallel_for(image->host, image->height, measure_guesses_of_row, image);
    sum_over_square(image, radius, image->noise_near);
    sum_over_square(image, radius, image->newer_near);
    image->host->parallel_for(image->host, image->height, lower_noise_of_row, image);
}

void regression_count_squares(struct denoised_image *image, int radius)
{
    image->host->parallel_for(image->host, image->height, count_row, image);
    sum_over_square(image, radius, image->signal_weight);
    sum_over_square(image, 2 * radius, image->noise_weight);
}

void regression_measure_squares(struct denoised_image *image, int radius)
{
    image->host->parallel_for(image->host, image->height, measure_row, image);
    sum_over_square(image, radius, image->signal);
    sum_over_square(image, 2 * radius, image->noise);
    if (radius > REGRESSION_NARROW)
        return;
    if (image->view->even_r)
        take_larger_noise(image, radius);
    else
        correct_guessed_noise(image, radius);
}
