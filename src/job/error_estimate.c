#include "job/error_estimate.h"

#include <math.h>

static double ratio_of(double squared_error, double squares)
{
    return squares > 0.0 ? sqrt(squared_error / squares) : 0.0;
}

double error_estimate_of_picture(const struct image *image)
{
    const float *error = image_channel(image, "error");
    const float *r = image_channel(image, "indirect.R"), *g = image_channel(image, "indirect.G"),
                *b = image_channel(image, "indirect.B");
    double squared_error = 0.0, squares = 0.0;
    if (!error || !r || !g || !b)
        return -1.0;
    for (size_t i = 0; i < image->width * image->height; i++) {
        double mean = ((double)r[i] + (double)g[i] + (double)b[i]) / 3.0;
        squared_error += (double)error[i] * (double)error[i];
        squares += mean * mean;
    }
    return ratio_of(squared_error, squares);
}

double error_estimate_of_film(const struct film_sum *film)
{
    double n = pass_set_size(&film->passes), squared_error = 0.0, squares = 0.0;
    const double *r = film->planes[FILM_COLOR_R].high, *g = film->planes[FILM_COLOR_G].high,
                 *b = film->planes[FILM_COLOR_B].high;
    const double *of_passes = film->planes[FILM_SUM_OF_SQUARES].high;
    if (n < 2.0)
        return -1.0;
    for (size_t i = 0; i < film->width * film->height; i++) {
        double square = (r[i] * r[i] + g[i] * g[i] + b[i] * b[i]) / (n * n);
        squared_error += fmax(of_passes[i] / n - square, 0.0) / (n - 1.0);
        squares += square;
    }
    return ratio_of(squared_error, squares);
}
