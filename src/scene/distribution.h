/* distribution.h: chances by weight: a table that is chosen from in proportion to its entries.
 *
 * Inversion of the cumulative sum (Pharr, Jakob and Humphreys, "Physically based rendering", the
 * chapters on piecewise-constant functions), in one dimension and, by row and then column, in two.
 * An alias table would choose faster, but sends neighbouring numbers to distant cells, which undoes
 * stratified samples.
 *
 * Probabilities are read off the table that is searched, so that what is said of a cell is what
 * happens to it, rounding included. A cell whose share of the whole is below 2^-25 may be left out.
 * A table whose weights are all 0 chooses evenly. Constant once made: any thread may read it.
 */
#ifndef SCENE_DISTRIBUTION_H
#define SCENE_DISTRIBUTION_H

#include "base/error.h"

struct distribution {
    float *cumulative; /* share of the entries up to and with this one; the last is 1 */
    size_t count;
    double total; /* of the weights */
    /* Where the search for numbers from k / guides on begins: the guide table of Chen and Asau
     * 1974, "On generating random variates from an empirical distribution". A bisection of all
     * entries goes by branches that no processor foresees. */
    uint32_t *guide;
    size_t guides;
};

/* `weights`: `count` > 0 numbers, each at least 0. PS_ERROR_MEMORY, or PS_OK: release it. */
ps_result distribution_create(const float *weights, size_t count, struct distribution *distribution,
                              struct error *error);
void distribution_release(struct distribution *distribution);

/* The entry for u in [0,1). `rest` is the place of u within the entry's share: again a number in
 * [0,1), uniform and independent of the entry, with as many fewer bits as the choice took. */
size_t distribution_choose(const struct distribution *distribution, float u, float *rest);

/* The chance of an entry. */
float distribution_probability(const struct distribution *distribution, size_t entry);

/* Cells of a grid, row by row. */
struct distribution_2d {
    struct distribution rows;
    float *cumulative; /* of each row by itself */
    size_t width;
};

/* `weights`: `width` * `height` > 0 numbers, each at least 0, with finite sums in single precision.
 * PS_ERROR_MEMORY, or PS_OK: release it. */
ps_result distribution_2d_create(const float *weights, size_t width, size_t height,
                                 struct distribution_2d *distribution, struct error *error);
void distribution_2d_release(struct distribution_2d *distribution);

struct distribution_cell {
    size_t column, row;
    float rest_column, rest_row; /* place within the cell, each in [0,1) */
    float probability;
};

/* The cell for two numbers in [0,1): the first chooses the column, the second the row. */
struct distribution_cell distribution_2d_choose(const struct distribution_2d *distribution,
                                                float u_column, float u_row);

float distribution_2d_probability(const struct distribution_2d *distribution, size_t column,
                                  size_t row);

#endif
