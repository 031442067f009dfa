#include "compare/ssim.h"

#include "compare/filter.h"
#include "image/tonemap.h"
#include <stdlib.h>

#define WINDOW_RADIUS 5 /* 11 pixels */
#define WINDOW_SIGMA 1.5
#define C1 (0.01 * 0.01)
#define C2 (0.03 * 0.03)

/* Planes; filtering turns them into the windows' means. */
enum moment { MOMENT_X, MOMENT_Y, MOMENT_XX, MOMENT_YY, MOMENT_XY, SCRATCH, PLANES };

static double luminance(float *const planes[3], size_t channel_count, size_t pixel)
{
    if (channel_count == 1)
        return (double)tonemap_srgb(planes[0][pixel]);
    return 0.2126 * (double)tonemap_srgb(planes[0][pixel]) +
           0.7152 * (double)tonemap_srgb(planes[1][pixel]) +
           0.0722 * (double)tonemap_srgb(planes[2][pixel]);
}

static void fill_moments(const struct picture_pair *pair, double *const planes[PLANES])
{
    for (size_t i = 0; i < pair->width * pair->height; i++) {
        double x = luminance(pair->reference, pair->channel_count, i);
        double y = luminance(pair->test, pair->channel_count, i);
        planes[MOMENT_X][i] = x;
        planes[MOMENT_Y][i] = y;
        planes[MOMENT_XX][i] = x * x;
        planes[MOMENT_YY][i] = y * y;
        planes[MOMENT_XY][i] = x * y;
    }
}

/* (2 mx my + C1)(2 sxy + C2) / ((mx^2 + my^2 + C1)(sx^2 + sy^2 + C2)) */
static double similarity(double *const planes[PLANES], size_t pixel)
{
    double x = planes[MOMENT_X][pixel], y = planes[MOMENT_Y][pixel];
    double variances = (planes[MOMENT_XX][pixel] - x * x) + (planes[MOMENT_YY][pixel] - y * y);
    double covariance = planes[MOMENT_XY][pixel] - x * y;
    return (2.0 * x * y + C1) * (2.0 * covariance + C2) / ((x * x + y * y + C1) * (variances + C2));
}

static size_t margin(size_t length)
{
    return length > 2 * WINDOW_RADIUS ? WINDOW_RADIUS : 0;
}

ps_result ssim_mean(const struct picture_pair *pair, double *number, struct error *error)
{
    size_t width = pair->width, height = pair->height;
    size_t bytes = PLANES * width * height * sizeof(double);
    double *memory = malloc(bytes), *planes[PLANES];
    if (!memory)
        return error_memory(error, bytes, "SSIM");
    for (size_t i = 0; i < PLANES; i++)
        planes[i] = memory + i * width * height;
    fill_moments(pair, planes);
    struct filter window = filter_gaussian(WINDOW_SIGMA, WINDOW_RADIUS);
    for (size_t i = 0; i < SCRATCH; i++)
        filter_plane(planes[i], width, height, &window, &window, planes[SCRATCH], planes[i],
                     pair->workers);
    double sum = 0.0;
    size_t count = 0;
    for (size_t y = margin(height); y < height - margin(height); y++)
        for (size_t x = margin(width); x < width - margin(width); x++, count++)
            sum += similarity(planes, y * width + x);
    *number = sum / (double)count;
    free(memory);
    return PS_OK;
}
