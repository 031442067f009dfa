/* strata.h: filling ps_strata, and searching them, for stratifications. */
#ifndef PSPLAT_STRATA_H
#define PSPLAT_STRATA_H

#include <psplat/cells.h>

/* Photon `index` lies in the cell of `key`. */
static inline void ps_strata_add(ps_strata *strata, size_t index, uint64_t key)
{
    strata->entries[strata->entry_count++] = (ps_key_entry){key, index};
}

/* Sorts what was added by key, each key's in the order in which they were added. */
static inline void ps_strata_sort(const ps_cells *cells, ps_strata *strata)
{
    ps_key_entry *sorted = cells->sort(strata->entries, strata->spare, strata->entry_count);
    if (sorted != strata->entries) {
        strata->spare = strata->entries;
        strata->entries = sorted;
    }
}

/* Makes the entries up to `end`, from where the last stratum ended, the next stratum. */
static inline void ps_strata_end_at(ps_strata *strata, size_t end)
{
    strata->starts[++strata->count] = end;
}

/* Makes each run of entries with the same key a stratum. */
static inline void ps_strata_from_keys(ps_strata *strata)
{
    for (size_t i = 1; i <= strata->entry_count; i++)
        if (i == strata->entry_count || strata->entries[i].key != strata->entries[i - 1].key)
            ps_strata_end_at(strata, i);
}

/* The first entry of that key or a larger one, where they are sorted; their number where there is
 * none. */
static inline size_t ps_strata_find(const ps_strata *strata, uint64_t key)
{
    size_t low = 0, high = strata->entry_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (strata->entries[middle].key < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* The stratum that an entry lies in. */
static inline size_t ps_stratum_of(const ps_strata *strata, size_t entry)
{
    size_t low = 0, high = strata->count;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (strata->starts[middle] <= entry)
            low = middle;
        else
            high = middle;
    }
    return low;
}

#endif
