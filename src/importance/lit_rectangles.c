#include "importance/lit_rectangles.h"

#include <string.h>

#define RAYS_OF_BIN 4 /* at least, in the mean over those that were met */
#define ENOUGH 24     /* rectangles: fewer are split */
#define FEWEST_BINS 4 /* of a face, across and down */

void exit_counts_add(struct exit_counts *counts, const struct portal_exit *exit)
{
    counts->bins[exit->face.axis][exit->face.high][exit->bin[1]][exit->bin[0]]++;
}

/* Bins of one face, `count` across and down. */
struct face_bins {
    struct portal_face face;
    uint32_t count;
    bool lit[PORTAL_BINS][PORTAL_BINS];
};

static bool is_met(const struct exit_counts *counts, const struct face_bins *bins, uint32_t row,
                   uint32_t column)
{
    uint32_t size = PORTAL_BINS / bins->count;
    for (uint32_t y = row * size; y < (row + 1) * size; y++)
        for (uint32_t x = column * size; x < (column + 1) * size; x++)
            if (counts->bins[bins->face.axis][bins->face.high][y][x] > 0)
                return true;
    return false;
}

/* A window ends somewhere in a bin, and few rays may have missed that one: a bin beside one that
 * was met is lit, too. */
static void light_around(struct face_bins *bins, uint32_t row, uint32_t column)
{
    uint32_t top = row > 0 ? row - 1 : 0, left = column > 0 ? column - 1 : 0;
    for (uint32_t y = top; y <= row + 1 && y < bins->count; y++)
        for (uint32_t x = left; x <= column + 1 && x < bins->count; x++)
            bins->lit[y][x] = true;
}

/* How many were met. */
static size_t light_bins(const struct exit_counts *counts, struct face_bins *bins)
{
    size_t met = 0;
    for (uint32_t row = 0; row < bins->count; row++)
        for (uint32_t column = 0; column < bins->count; column++)
            if (is_met(counts, bins, row, column)) {
                light_around(bins, row, column);
                met++;
            }
    return met;
}

static bool row_is_lit(const struct face_bins *bins, uint32_t row, uint32_t first, uint32_t end)
{
    for (uint32_t column = first; column < end; column++)
        if (!bins->lit[row][column])
            return false;
    return true;
}

/* The widest rectangle with a corner in a lit bin, and as many rows of it as are lit; puts them
 * out. */
static struct portal_bins take_rectangle(struct face_bins *bins, uint32_t row, uint32_t column)
{
    uint32_t end = column, bottom = row, size = PORTAL_BINS / bins->count;
    while (end < bins->count && bins->lit[row][end])
        end++;
    while (bottom < bins->count && row_is_lit(bins, bottom, column, end))
        bottom++;
    for (uint32_t y = row; y < bottom; y++)
        memset(&bins->lit[y][column], 0, (end - column) * sizeof(bool));
    return (struct portal_bins){
        bins->face, {column * size, row * size}, {end * size, bottom * size}};
}

/* Rectangles that lie in no other. */
struct rectangles {
    size_t count;
    struct portal_bins of[PORTALS_MOST];
};

/* Adds the face's; false where there is no room for them. */
static bool add_rectangles(struct face_bins *bins, struct rectangles *rectangles)
{
    for (uint32_t row = 0; row < bins->count; row++)
        for (uint32_t column = 0; column < bins->count; column++) {
            if (!bins->lit[row][column])
                continue;
            if (rectangles->count == PORTALS_MOST)
                return false;
            rectangles->of[rectangles->count++] = take_rectangle(bins, row, column);
        }
    return true;
}

/* With so many bins across a face: false where too few rays are in each, or too many rectangles. */
static bool try_bins(const struct exit_counts *counts, size_t rays, uint32_t count,
                     struct rectangles *rectangles)
{
    size_t met = 0;
    rectangles->count = 0;
    for (uint32_t face = 0; face < 6; face++) {
        struct face_bins bins = {.face = {face / 2, face % 2 != 0}, .count = count};
        met += light_bins(counts, &bins);
        if (!add_rectangles(&bins, rectangles))
            return false;
    }
    return met * RAYS_OF_BIN <= rays;
}

static uint32_t side(const struct portal_bins *bins, uint32_t k)
{
    return bins->end[k] - bins->first[k];
}

/* Halves the largest, so that points choose among parts that are near and that they see: true where
 * it can be. */
static bool split_largest(struct rectangles *rectangles)
{
    size_t largest = 0;
    for (size_t i = 1; i < rectangles->count; i++) {
        const struct portal_bins *most = &rectangles->of[largest], *bins = &rectangles->of[i];
        if (side(bins, 0) * side(bins, 1) > side(most, 0) * side(most, 1))
            largest = i;
    }
    struct portal_bins *bins = &rectangles->of[largest];
    uint32_t k = side(bins, 0) >= side(bins, 1) ? 0 : 1;
    if (side(bins, k) < 2)
        return false;
    struct portal_bins *half = &rectangles->of[rectangles->count++];
    *half = *bins;
    half->first[k] = bins->end[k] = bins->first[k] + side(bins, k) / 2;
    return true;
}

bool lit_rectangles(const struct exit_counts *counts, size_t rays, struct portals *portals)
{
    struct rectangles rectangles = {.count = 0};
    bool found = false;
    portals_begin(portals, portals->low, portals->high);
    for (uint32_t count = PORTAL_BINS; count >= FEWEST_BINS && !found; count /= 2)
        found = try_bins(counts, rays, count, &rectangles);
    if (!found || rectangles.count == 0)
        return false;
    while (rectangles.count < ENOUGH && split_largest(&rectangles))
        continue;
    for (size_t i = 0; i < rectangles.count; i++)
        portals_add(portals, &rectangles.of[i]);
    return true;
}
