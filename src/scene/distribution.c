#include "scene/distribution.h"

#include <assert.h>
#include <psplat/math.h>
#include <stdbool.h>
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

/* Among first..last, the first entry whose cumulative share is above u: never one of share 0. */
static size_t search(const float *cumulative, size_t first, size_t last, float u)
{
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

static size_t take(const float *cumulative, size_t entry, float u, float *rest)
{
    float place = (u - share_before(cumulative, entry)) / share(cumulative, entry);
    *rest = ps_min(place, LAST);
    return entry;
}

/* --- the guide
 * ---------------------------------------------------------------------------------------- */

#define MOST_GUIDES 65536u
#define ENTRY_GUIDES 4u
#define ROUNDING 0x1p-20f /* more than u * guides is off by, less than the width of a guide */

/* guide[k] is the first entry that a number from k / guides on chooses, or one before it; u *
 * guides may be rounded up to `guides` itself. */
static void make_guide(struct distribution *distribution)
{
    size_t last = distribution->count - 1;
    for (size_t k = 0; k <= distribution->guides; k++) {
        float u = (float)k / (float)distribution->guides * (1.0f - ROUNDING);
        distribution->guide[k] = (uint32_t)search(distribution->cumulative, 0, last, u);
    }
    distribution->guide[distribution->guides + 1] = (uint32_t)last;
    distribution->guide[distribution->guides + 2] = (uint32_t)last;
}

static size_t search_by_guide(const struct distribution *distribution, float u)
{
    const uint32_t *guide = distribution->guide + (size_t)(u * (float)distribution->guides);
    bool is_first = distribution->cumulative[guide[0]] > u; /* as mostly */
    return is_first ? guide[0] : search(distribution->cumulative, guide[0] + 1, guide[2], u);
}

/* ---------------------------------------------------------------------------------------------- */

ps_result distribution_create(const float *weights, size_t count, struct distribution *distribution,
                              struct error *error)
{
    assert(count > 0);
    *distribution = (struct distribution){.count = count};
    distribution->guides = count < MOST_GUIDES / ENTRY_GUIDES ? count * ENTRY_GUIDES : MOST_GUIDES;
    distribution->cumulative = calloc(count, sizeof *distribution->cumulative);
    distribution->guide = calloc(distribution->guides + 3, sizeof *distribution->guide);
    if (!distribution->cumulative || !distribution->guide) {
        distribution_release(distribution);
        return error_memory(error, count * sizeof *distribution->cumulative, "a distribution");
    }
    distribution->total = accumulate(weights, count, distribution->cumulative);
    make_guide(distribution);
    return PS_OK;
}

void distribution_release(struct distribution *distribution)
{
    free(distribution->cumulative);
    free(distribution->guide);
    *distribution = (struct distribution){.cumulative = NULL};
}

size_t distribution_choose(const struct distribution *distribution, float u, float *rest)
{
    assert(u >= 0.0f && u <= 1.0f);
    u = ps_min(u, LAST);
    return take(distribution->cumulative, search_by_guide(distribution, u), u, rest);
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
    const float *row = row_of(distribution, cell.row);
    float u = ps_min(u_column, LAST);
    size_t column = search(row, 0, distribution->width - 1, u);
    cell.column = take(row, column, u, &cell.rest_column);
    cell.probability = distribution_2d_probability(distribution, cell.column, cell.row);
    return cell;
}

float distribution_2d_probability(const struct distribution_2d *distribution, size_t column,
                                  size_t row)
{
    return distribution_probability(&distribution->rows, row) *
           share(row_of(distribution, row), column);
}
