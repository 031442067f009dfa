/* alias.h: choosing one of many entries by weight, each time in constant time: an optional service.
 *
 * The alias method: n cells of equal chance, each shared by at most two entries (Walker 1977; built
 * in linear time after Vose 1991, "A linear algorithm for generating random numbers with a given
 * distribution").
 */
#ifndef PSPLAT_ALIAS_H
#define PSPLAT_ALIAS_H

#include <psplat/types.h>

#define PS_ALIAS_EXTENSION "psplat.alias/1"

/* A cell: how much of it is its own entry's, 0..1, and whose the rest is. */
typedef struct ps_alias {
    float own;
    uint32_t other;
} ps_alias;

/* What host->extension gives for the name; pure functions. [any thread] */
typedef struct ps_alias_service {
    uint32_t size;
    uint32_t reserved;
    /* Fills the table for n weights, each finite and at least 0, and returns their sum; 0: there is
     * nothing to choose, and the table is not set. `order` is room for n numbers, free again
     * afterwards. */
    double (*build)(const float *weights, uint32_t n, ps_alias *table, uint32_t *order);
    /* The entry for a place in [0, n), which chooses a cell, and a number in [0, 1) within it. */
    uint32_t (*choose)(const ps_alias *table, uint32_t n, double place, float number);
} ps_alias_service;

#endif
