#include "debug/selection.h"

#include "base/sample.h"
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

struct selection_entry {
    uint64_t order;
    size_t place; /* of its item */
    uint32_t hash;
};

static bool comes_after(const struct selection_entry *a, const struct selection_entry *b)
{
    return a->hash != b->hash ? a->hash > b->hash : a->order > b->order;
}

ps_result selection_create(struct selection *selection, size_t wanted, size_t item_size,
                           struct error *error)
{
    *selection = (struct selection){
        .wanted = wanted,
        .item_size = item_size,
        .entries = malloc(wanted * sizeof *selection->entries),
        .items = malloc(wanted * item_size),
    };
    if (selection->entries && selection->items)
        return PS_OK;
    selection_release(selection);
    return error_memory(error, wanted * (item_size + sizeof *selection->entries), "a selection");
}

void selection_release(struct selection *selection)
{
    free(selection->entries);
    free(selection->items);
    *selection = (struct selection){.wanted = 0};
}

/* A heap with the largest hash, the next to go, on top. */
static void sink(struct selection *selection, size_t index)
{
    struct selection_entry *entries = selection->entries;
    for (size_t child; (child = 2 * index + 1) < selection->count; index = child) {
        if (child + 1 < selection->count && comes_after(&entries[child + 1], &entries[child]))
            child++;
        if (!comes_after(&entries[child], &entries[index]))
            return;
        struct selection_entry moved = entries[child];
        entries[child] = entries[index];
        entries[index] = moved;
    }
}

static void rise(struct selection *selection, size_t index)
{
    struct selection_entry *entries = selection->entries;
    while (index > 0 && comes_after(&entries[index], &entries[(index - 1) / 2])) {
        struct selection_entry moved = entries[index];
        entries[index] = entries[(index - 1) / 2];
        index = (index - 1) / 2;
        entries[index] = moved;
    }
}

void selection_offer(struct selection *selection, const void *item)
{
    struct selection_entry entry = {.order = selection->offered++, .place = selection->count};
    entry.hash = sample_hash(entry.order);
    bool full = selection->count == selection->wanted;
    if (full && !comes_after(&selection->entries[0], &entry))
        return;
    if (full)
        entry.place = selection->entries[0].place;
    memcpy(selection->items + entry.place * selection->item_size, item, selection->item_size);
    if (full) {
        selection->entries[0] = entry;
        sink(selection, 0);
    } else {
        selection->entries[selection->count++] = entry;
        rise(selection, selection->count - 1);
    }
}

static int by_order(const void *a, const void *b)
{
    const struct selection_entry *first = a, *second = b;
    return (first->order > second->order) - (first->order < second->order);
}

void selection_finish(struct selection *selection)
{
    qsort(selection->entries, selection->count, sizeof *selection->entries, by_order);
}

const void *selection_item(const struct selection *selection, size_t index)
{
    return selection->items + selection->entries[index].place * selection->item_size;
}
