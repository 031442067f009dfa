#include "compare/filter.h"

#include "base/parallel.h"
#include <math.h>

struct pass {
    const double *in;
    double *out;
    size_t width, height;
    const struct filter *filter;
};

struct filter filter_gaussian(double sigma, int radius)
{
    struct filter filter = {.radius = radius};
    double sum = 0.0;
    for (int i = -radius; i <= radius; i++)
        sum += filter.weights[i + radius] = exp(-i * i / (2.0 * sigma * sigma));
    for (int i = 0; i <= 2 * radius; i++)
        filter.weights[i] /= sum;
    return filter;
}

/* The nearest index below `count` to position + offset. */
static size_t replicate(size_t position, int offset, size_t count)
{
    if (offset < 0)
        return position > (size_t)-offset ? position - (size_t)-offset : 0;
    return position + (size_t)offset < count ? position + (size_t)offset : count - 1;
}

static void filter_row_across(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct pass *pass = user;
    const double *in = pass->in + row * pass->width;
    int radius = pass->filter->radius;
    for (size_t x = 0; x < pass->width; x++) {
        double sum = 0.0;
        for (int i = -radius; i <= radius; i++)
            sum += pass->filter->weights[i + radius] * in[replicate(x, i, pass->width)];
        pass->out[row * pass->width + x] = sum;
    }
}

/* Tap by tap over the whole row, which reads memory in its order. */
static void filter_row_down(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct pass *pass = user;
    double *out = pass->out + row * pass->width;
    int radius = pass->filter->radius;
    for (size_t x = 0; x < pass->width; x++)
        out[x] = 0.0;
    for (int i = -radius; i <= radius; i++) {
        const double *in = pass->in + replicate((size_t)row, i, pass->height) * pass->width;
        double weight = pass->filter->weights[i + radius];
        for (size_t x = 0; x < pass->width; x++)
            out[x] += weight * in[x];
    }
}

void filter_plane(const double *in, size_t width, size_t height, const struct filter *horizontal,
                  const struct filter *vertical, double *scratch, double *out,
                  struct workers *workers)
{
    struct pass across = {in, scratch, width, height, horizontal};
    struct pass down = {scratch, out, width, height, vertical};
    parallel_for(workers, height, filter_row_across, &across);
    parallel_for(workers, height, filter_row_down, &down);
}
