/* arena.h: memory that is taken piece by piece and freed all at once.
 *
 * A scene's tree is millions of small nodes with one lifetime.
 */
#ifndef BASE_ARENA_H
#define BASE_ARENA_H

#include <stddef.h>

struct arena {
    struct arena_chunk *chunks; /* the newest first */
};

/* Zeroed, aligned for any type; NULL when out of memory. */
void *arena_allocate(struct arena *arena, size_t size);

/* A terminated copy of `length` bytes; NULL when out of memory. */
char *arena_copy(struct arena *arena, const char *bytes, size_t length);

void arena_release(struct arena *arena);

#endif
