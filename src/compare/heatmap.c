#include "compare/heatmap.h"

#include <math.h>
#include <stdlib.h>

#define LEAST_DECADE (-3.0) /* 0.1 % */
#define DARK_SHARE 0.01

/* Nine colours of "magma" (N. Smith, S. van der Walt, for matplotlib, 2015), evenly spaced. */
static const uint8_t magma[][3] = {{0, 0, 4},      {28, 16, 68},    {79, 18, 123},
                                   {129, 37, 129}, {181, 54, 122},  {229, 80, 100},
                                   {251, 135, 97}, {254, 194, 135}, {252, 253, 191}};
enum { STEPS = sizeof magma / sizeof magma[0] - 1 };

void heatmap_colour(double position, uint8_t rgb[3])
{
    double scaled = fmin(fmax(position, 0.0), 1.0) * (double)STEPS;
    size_t step = scaled < (double)STEPS ? (size_t)scaled : STEPS - 1;
    double fraction = scaled - (double)step;
    for (int c = 0; c < 3; c++)
        rgb[c] = (uint8_t)((1.0 - fraction) * magma[step][c] + fraction * magma[step + 1][c] + 0.5);
}

static double reference_length(const struct picture_pair *pair, size_t pixel)
{
    double sum = 0.0;
    for (size_t c = 0; c < pair->channel_count; c++)
        sum += (double)pair->reference[c][pixel] * (double)pair->reference[c][pixel];
    return sqrt(sum);
}

static double difference_length(const struct picture_pair *pair, size_t pixel)
{
    double sum = 0.0;
    for (size_t c = 0; c < pair->channel_count; c++) {
        double difference = (double)pair->test[c][pixel] - (double)pair->reference[c][pixel];
        sum += difference * difference;
    }
    return sqrt(sum);
}

ps_result heatmap_write(const struct picture_pair *pair, const char *path, struct error *error)
{
    size_t pixels = pair->width * pair->height;
    ps_result result = picture_pair_check_reference(pair, "the heat map's error", error);
    if (result != PS_OK)
        return result;
    uint8_t *rgb = malloc(3 * pixels);
    if (!rgb)
        return error_memory(error, 3 * pixels, "the heat map");
    double squares = 0.0;
    for (size_t i = 0; i < pixels; i++)
        squares += pow(reference_length(pair, i), 2.0);
    double dark = DARK_SHARE * sqrt(squares / (double)pixels);
    for (size_t i = 0; i < pixels; i++) {
        double relative = difference_length(pair, i) / (reference_length(pair, i) + dark);
        heatmap_colour(1.0 - log10(relative) / LEAST_DECADE, rgb + 3 * i);
    }
    result = image_write_png(path, pair->width, pair->height, rgb, NULL, 0, error);
    free(rgb);
    return result;
}
