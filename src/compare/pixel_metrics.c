/* pixel_metrics.c: sums over pixels, serial and in double: a picture of ten million pixels takes
 * tenths of a second, and the same number comes out whatever the thread count. */
#include "compare/pixel_metrics.h"

#include "image/tonemap.h"
#include <math.h>
#include <stdlib.h>

#define RELMSE_OFFSET 0.01 /* keeps dark pixels from ruling the mean */

static double squared(double x)
{
    return x * x;
}

/* Pixels that count; those left out are 0 in both pictures and add nothing to a sum. */
static size_t counted_pixels(const struct picture_pair *pair)
{
    return pair->width * pair->height - pair->left_out;
}

/* Sum of (I-R)^2 over a channel's display values. */
static double sum_display_error(const struct picture_pair *pair, size_t channel)
{
    double sum = 0.0;
    for (size_t i = 0; i < pair->width * pair->height; i++)
        sum += squared((double)tonemap_srgb(pair->test[channel][i]) -
                       (double)tonemap_srgb(pair->reference[channel][i]));
    return sum;
}

static double sum_plane(const float *plane, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++)
        sum += (double)plane[i];
    return sum;
}

/* The channels' largest |I-R| at a pixel. */
static double pixel_difference(const struct picture_pair *pair, size_t pixel)
{
    double largest = 0.0;
    for (size_t c = 0; c < pair->channel_count; c++)
        largest =
            fmax(largest, fabs((double)pair->test[c][pixel] - (double)pair->reference[c][pixel]));
    return largest;
}

ps_result pixel_thesis_rmse(const struct picture_pair *pair, double *numbers, struct error *error)
{
    (void)error;
    double pixels = (double)counted_pixels(pair);
    numbers[0] = 0.0;
    for (size_t c = 0; c < pair->channel_count; c++)
        numbers[0] += 255.0 * sqrt(sum_display_error(pair, c) / pixels);
    return PS_OK;
}

ps_result pixel_rel_rmse(const struct picture_pair *pair, double *numbers, struct error *error)
{
    ps_result result = picture_pair_check_reference(pair, "rel_rmse", error);
    if (result != PS_OK)
        return result;
    double differences = 0.0, references = 0.0;
    for (size_t c = 0; c < pair->channel_count; c++)
        for (size_t i = 0; i < pair->width * pair->height; i++) {
            double reference = (double)pair->reference[c][i];
            differences += squared((double)pair->test[c][i] - reference);
            references += squared(reference);
        }
    numbers[0] = sqrt(differences / references);
    return PS_OK;
}

ps_result pixel_relmse(const struct picture_pair *pair, double *numbers, struct error *error)
{
    (void)error;
    double sum = 0.0;
    for (size_t c = 0; c < pair->channel_count; c++)
        for (size_t i = 0; i < pair->width * pair->height; i++) {
            double reference = (double)pair->reference[c][i];
            sum += squared((double)pair->test[c][i] - reference) /
                   (squared(reference) + RELMSE_OFFSET);
        }
    numbers[0] = sum / (double)(pair->channel_count * counted_pixels(pair));
    return PS_OK;
}

/* A channel that is zero in the reference alone gives infinity, one that is in both NaN. */
ps_result pixel_bias(const struct picture_pair *pair, double *numbers, struct error *error)
{
    ps_result result = picture_pair_check_reference(pair, "bias", error);
    if (result != PS_OK)
        return result;
    size_t pixels = pair->width * pair->height;
    for (size_t c = 0; c < pair->channel_count; c++)
        numbers[c] = sum_plane(pair->test[c], pixels) / sum_plane(pair->reference[c], pixels);
    return PS_OK;
}

ps_result pixel_psnr(const struct picture_pair *pair, double *numbers, struct error *error)
{
    (void)error;
    double sum = 0.0;
    for (size_t c = 0; c < pair->channel_count; c++)
        sum += sum_display_error(pair, c);
    double mean = sum / (double)(pair->channel_count * counted_pixels(pair));
    numbers[0] = mean > 0.0 ? -10.0 * log10(mean) : INFINITY;
    return PS_OK;
}

ps_result pixel_max(const struct picture_pair *pair, double *numbers, struct error *error)
{
    (void)error;
    numbers[0] = 0.0;
    for (size_t i = 0; i < pair->width * pair->height; i++)
        numbers[0] = fmax(numbers[0], pixel_difference(pair, i));
    return PS_OK;
}

static int compare_numbers(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Nearest rank: the smallest difference that at least 99 % of the pixels don't exceed. Pixels that
 * are left out come first. */
ps_result pixel_p99(const struct picture_pair *pair, double *numbers, struct error *error)
{
    size_t pixels = pair->width * pair->height;
    double *differences = malloc(pixels * sizeof *differences);
    if (!differences)
        return error_memory(error, pixels * sizeof *differences, "the percentile");
    for (size_t i = 0; i < pixels; i++)
        differences[i] = pixel_difference(pair, i);
    qsort(differences, pixels, sizeof *differences, compare_numbers);
    numbers[0] = differences[pixels - 1 - counted_pixels(pair) / 100];
    free(differences);
    return PS_OK;
}
