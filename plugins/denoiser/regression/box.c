#include "box.h"

#include <psplat/isa.h>

/* That a worker sums at a time. */
#define ROWS 8
#define COLUMNS 64

/* Running sums of some rows at a time, each of which waits for its last addition. */
static void sum_rows(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct regression_box *box = user;
    size_t width = box->width, radius = box->radius, first = index * ROWS;
    size_t n = box->height - first < ROWS ? box->height - first : ROWS;
    const float *from[ROWS];
    float *to[ROWS];
    double sums[ROWS] = {0}; /* of floats: what was added leaves little when it is subtracted */
    for (size_t i = 0; i < ROWS; i++) {
        size_t row = first + (i < n ? i : 0); /* what there is too much of is done twice */
        from[i] = box->plane + row * width;
        to[i] = box->room + row * width;
    }
    for (size_t x = 0; x < radius && x < width; x++)
        for (size_t i = 0; i < ROWS; i++)
            sums[i] += (double)from[i][x];
    for (size_t x = 0; x < width; x++) {
        if (x + radius < width)
            for (size_t i = 0; i < ROWS; i++)
                sums[i] += (double)from[i][x + radius];
        if (x > radius)
            for (size_t i = 0; i < ROWS; i++)
                sums[i] -= (double)from[i][x - radius - 1];
        for (size_t i = 0; i < ROWS; i++)
            to[i][x] = (float)sums[i];
    }
}

PS_EVERY_ISA static void sum_columns(void *user, uint64_t index, uint32_t worker)
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
    host->parallel_for(host, (of.height + ROWS - 1) / ROWS, sum_rows, &of);
    host->parallel_for(host, (of.width + COLUMNS - 1) / COLUMNS, sum_columns, &of);
}
