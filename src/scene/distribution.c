#include "scene/distribution.h"

#include <assert.h>
#include <psplat/math.h>
#include <stdlib.h>

/* The largest float below 1. */
#define LAST (1.0f - 0x1p-24f)

/* Fills the cumulative shares of `count` weights and returns their sum. */
static double accumulate(const float *weights, size_t count, float *cumulative)
{
    double total = 0.0, sum = 0.0;
    for (size_t i = 0; i < count; i++)
        total += (double)weights[i];
    for (size_t i = 0; i < count; i++) {
        sum += (double)weights[i];
        cumulative[i] =
            total > 0.0 ? (float)(sum / total) : (float)((double)(i + 1) / (double)count);
    }
    return total;
}

/* The first entry whose cumulative share is above u: never one of share 0. */
static size_t search(const float *cumulative, size_t count, float u)
{
    size_t first = 0, last = count - 1;
    while (first < last) {
        size_t middle = first + (last - first) / 2;
        if (cumulative[middle] > u)
            last = middle;
        else
            first = middle + 1;
    }
    return first;
}

static float share_before(const float *cumulative, size_t entry)
{
    return entry ? cumulative[entry - 1] : 0.0f;
}

static float share(const float *cumulative, size_t entry)
{
    return cumulative[entry] - share_before(cumulative, entry);
}

static size_t choose(const float *cumulative, size_t count, float u, float *rest)
{
    u = ps_min(u, LAST);
    size_t entry = search(cumulative, count, u);
    float place = (u - share_before(cumulative, entry)) / share(cumulative, entry);
    *rest = ps_min(place, LAST);
    return entry;
}

ps_result distribution_create(const float *weights, size_t count, struct distribution *distribution,
                              struct error *error)
{
    assert(count > 0);
    *distribution = (struct distribution){.count = count};
    distribution->cumulative = calloc(count, sizeof *distribution->cumulative);
    if (!distribution->cumulative)
        return error_memory(error, count * sizeof *distribution->cumulative, "a distribution");
    distribution->total = accumulate(weights, count, distribution->cumulative);
    return PS_OK;
}

void distribution_release(struct distribution *distribution)
{
    free(distribution->cumulative);
    *distribution = (struct distribution){.cumulative = NULL};
}

size_t distribution_choose(const struct distribution *distribution, float u, float *rest)
{
    assert(u >= 0.0f && u <= 1.0f);
    return choose(distribution->cumulative, distribution->count, u, rest);
}

float distribution_probability(const struct distribution *distribution, size_t entry)
{
    assert(entry < distribution->count);
    return share(distribution->cumulative, entry);
}

ps_result distribution_2d_create(const float *weights, size_t width, size_t height,
                                 struct distribution_2d *distribution, struct error *error)
{
    assert(width > 0 && height > 0);
    ps_result result;
    float *totals = calloc(height, sizeof *totals);
    float *cumulative = calloc(width * height, sizeof *cumulative);
    *distribution = (struct distribution_2d){.cumulative = cumulative, .width = width};
    if (totals && cumulative) {
        for (size_t row = 0; row < height; row++)
            totals[row] = (float)accumulate(weights + row * width, width, cumulative + row * width);
        result = distribution_create(totals, height, &distribution->rows, error);
    } else {
        result = error_memory(error, width * height * sizeof *totals, "a distribution");
    }
    free(totals);
    if (result != PS_OK)
        distribution_2d_release(distribution);
    return result;
}

void distribution_2d_release(struct distribution_2d *distribution)
{
    distribution_release(&distribution->rows);
    free(distribution->cumulative);
    *distribution = (struct distribution_2d){.cumulative = NULL};
}

static const float *row_of(const struct distribution_2d *distribution, size_t row)
{
    return distribution->cumulative + row * distribution->width;
}

struct distribution_cell distribution_2d_choose(const struct distribution_2d *distribution,
                                                float u_column, float u_row)
{
    struct distribution_cell cell;
    cell.row = distribution_choose(&distribution->rows, u_row, &cell.rest_row);
    cell.column =
        choose(row_of(distribution, cell.row), distribution->width, u_column, &cell.rest_column);
    cell.probability = distribution_2d_probability(distribution, cell.column, cell.row);
    return cell;
}

float distribution_2d_probability(const struct distribution_2d *distribution, size_t column,
                                  size_t row)
{
    return distribution_probability(&distribution->rows, row) *
           share(row_of(distribution, row), column);
}
