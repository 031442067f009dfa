/* alias.c: the alias method (Walker 1977; Vose 1991).
 *
 * Inversion of a cumulative sum (scene/distribution.h) would keep neighbouring numbers on
 * neighbouring entries, at a logarithmic search for each choice.
 */
#include "host/alias.h"
#include <assert.h>

static double build(const float *weights, uint32_t n, ps_alias *table, uint32_t *order)
{
    double total = 0.0;
    for (uint32_t i = 0; i < n; i++)
        total += (double)weights[i];
    if (!(total > 0.0))
        return 0.0;
    double scale = (double)n / total;
    /* Entries of less than a cell are a stack at the front of `order`, the others one at its
     * back. */
    uint32_t small = 0, large = n;
    for (uint32_t i = 0; i < n; i++) {
        double share = (double)weights[i] * scale;
        table[i] = (ps_alias){(float)share, i};
        order[share < 1.0 ? small++ : --large] = i;
    }
    uint32_t donor = 0;
    while (large < n) {
        donor = order[large++];
        /* What the donor still has; in double, as it may fill many cells. */
        double left = (double)weights[donor] * scale;
        while (left >= 1.0 && small > 0) {
            ps_alias *cell = &table[order[--small]];
            cell->other = donor;
            left -= 1.0 - (double)cell->own;
        }
        table[donor].own = left < 1.0 ? (float)left : 1.0f;
        if (left < 1.0)
            order[small++] = donor;
    }
    /* What rounding left over fills its cell, but for entries of weight 0. */
    while (small > 0) {
        uint32_t i = order[--small];
        table[i] = weights[i] > 0.0f ? (ps_alias){1.0f, i} : (ps_alias){0.0f, donor};
    }
    return total;
}

static uint32_t choose(const ps_alias *table, uint32_t n, double place, float number)
{
    assert(n > 0 && place >= 0.0 && place <= (double)n);
    uint32_t i = (uint32_t)place;
    i = i < n ? i : n - 1;
    return number < table[i].own ? i : table[i].other;
}

const ps_alias_service alias_service = {
    .size = sizeof alias_service,
    .build = build,
    .choose = choose,
};
