/* selection.h: a fixed number out of a stream of things whose length nobody knows yet.
 *
 * Each thing gets a hash of its place in the stream, and those with the smallest stay (bottom-k
 * sampling; Cohen and Kaplan 2007, "Summarizing data using bottom-k sketches"). So every thing is
 * as likely, memory goes by what is kept, and a larger selection holds a smaller one of the same
 * stream.
 */
#ifndef DEBUG_SELECTION_H
#define DEBUG_SELECTION_H

#include "base/error.h"

struct selection {
    size_t wanted, item_size;
    uint64_t offered; /* how many things came by */
    size_t count;
    struct selection_entry *entries; /* owned */
    unsigned char *items;            /* owned; entries say which place is whose */
};

/* For up to `wanted` > 0 things of `item_size` bytes each. */
ps_result selection_create(struct selection *selection, size_t wanted, size_t item_size,
                           struct error *error);
void selection_release(struct selection *selection);

/* Copies the thing, or passes it by. */
void selection_offer(struct selection *selection, const void *item);

/* Ends the choice: `count` things are left, in the order that they came in. */
void selection_finish(struct selection *selection);
const void *selection_item(const struct selection *selection, size_t index);

#endif
