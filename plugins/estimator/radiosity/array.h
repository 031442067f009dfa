/* array.h: arrays of the host's memory that grow. */
#ifndef PSPLAT_ESTIMATOR_RADIOSITY_ARRAY_H
#define PSPLAT_ESTIMATOR_RADIOSITY_ARRAY_H

#include <psplat/plugin.h>
#include <stdbool.h>
#include <string.h>

struct array {
    void *items;
    size_t count, capacity;
};

/* Makes room for `more` items of `size` bytes; false, and the array as it was, where there is no
 * memory. */
static inline bool array_reserve(const ps_host *host, struct array *array, size_t more, size_t size,
                                 const char *what)
{
    if (array->capacity - array->count >= more)
        return true;
    size_t capacity = array->capacity + array->capacity / 2;
    capacity = capacity < array->count + more ? array->count + more : capacity;
    void *items = capacity <= SIZE_MAX / size ? host->allocate(host, capacity * size, what) : NULL;
    if (!items)
        return false;
    if (array->count > 0)
        memcpy(items, array->items, array->count * size);
    host->release(host, array->items);
    array->items = items;
    array->capacity = capacity;
    return true;
}

#endif
