/* name_index.h: finds entries of a growing list by their hash, the latest first.
 *
 * The list is the caller's, who compares what is found. Entries are added and removed at the end.
 * One thread at a time.
 */
#ifndef WRITER_NAME_INDEX_H
#define WRITER_NAME_INDEX_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define NAME_INDEX_NONE SIZE_MAX

/* Zeroed: empty. Owns its arrays. */
struct name_index {
    size_t *buckets, bucket_count; /* a power of 2 */
    uint64_t *hashes;              /* of the entries */
    size_t *before;                /* the entry before it in its bucket */
    size_t count, capacity;
};

uint64_t name_index_hash(const char *name);

/* Of the entry behind the last. False: out of memory, and it is not added. */
bool name_index_add(struct name_index *index, uint64_t hash);
/* Removes the last ones. */
void name_index_cut(struct name_index *index, size_t count);

/* The latest entry of that hash; then the one before an entry, of the same hash. NAME_INDEX_NONE:
 * there is none. */
size_t name_index_find(const struct name_index *index, uint64_t hash);
size_t name_index_before(const struct name_index *index, size_t entry);

void name_index_release(struct name_index *index);

#endif
