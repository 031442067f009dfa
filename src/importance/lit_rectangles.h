/* lit_rectangles.h: rectangles that hold the places by which rays leave a box for the sky. */
#ifndef IMPORTANCE_LIT_RECTANGLES_H
#define IMPORTANCE_LIT_RECTANGLES_H

#include "direct/portals.h"

/* How many rays left a box by each bin of its faces: axis, side, row, column. */
struct exit_counts {
    uint32_t bins[3][2][PORTAL_BINS][PORTAL_BINS];
};

void exit_counts_add(struct exit_counts *counts, const struct portal_exit *exit);

/* Makes rectangles of bins that were met, and of those beside them, the portals of a box. Bins are
 * taken together until there are a few rays in each that was met, so that windows have no holes by
 * chance, and few enough rectangles; large ones are split. `rays`: the sum of the counts. False,
 * and no portals, where no such bins are fine enough. */
bool lit_rectangles(const struct exit_counts *counts, size_t rays, struct portals *portals);

#endif
