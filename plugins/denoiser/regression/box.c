#include "box.h"

#define COLUMNS 64 /* that a worker sums at a time */

static void sum_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct regression_box *box = user;
    size_t width = box->width, radius = box->radius;
    const float *from = box->plane + row * width;
    float *to = box->room + row * width;
    double sum = 0.0; /* of floats: what was added leaves little rounding when it is subtracted */
    for (size_t x = 0; x < radius && x < width; x++)
        sum += (double)from[x];
    for (size_t x = 0; x < width; x++) {
        sum += x + radius < width ? (double)from[x + radius] : 0.0;
        sum -= x > radius ? (double)from[x - radius - 1] : 0.0;
        to[x] = (float)sum;
    }
}

static void sum_columns(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct regression_box *box = user;
    size_t width = box->width, height = box->height, radius = box->radius, first = index * COLUMNS;
    size_t n = width - first < COLUMNS ? width - first : COLUMNS;
    const float *from = box->room + first;
    double sums[COLUMNS] = {0};
    for (size_t y = 0; y < radius && y < height; y++)
        for (size_t i = 0; i < n; i++)
            sums[i] += (double)from[y * width + i];
    for (size_t y = 0; y < height; y++) {
        float *to = box->plane + y * width + first;
        for (size_t i = 0; i < n; i++) {
            sums[i] += y + radius < height ? (double)from[(y + radius) * width + i] : 0.0;
            sums[i] -= y > radius ? (double)from[(y - radius - 1) * width + i] : 0.0;
            to[i] = ps_max((float)sums[i], 0.0f);
        }
    }
}

void regression_box_sums(const ps_host *host, const struct regression_box *box)
{
    struct regression_box of = *box;
    host->parallel_for(host, of.height, sum_row, &of);
    host->parallel_for(host, (of.width + COLUMNS - 1) / COLUMNS, sum_columns, &of);
}
