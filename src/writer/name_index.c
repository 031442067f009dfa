/* name_index.c: see name_index.h. A hash table of chains, each from its latest entry to its
 * first. */
#include "writer/name_index.h"

#include "base/digest.h"
#include <stdlib.h>
#include <string.h>

#define FEWEST_BUCKETS 64

uint64_t name_index_hash(const char *name)
{
    uint64_t hash = DIGEST_START;
    digest_add(&hash, name, strlen(name));
    return hash;
}

static size_t *bucket_of(const struct name_index *index, uint64_t hash)
{
    return &index->buckets[(hash ^ hash >> 32) & (index->bucket_count - 1)];
}

static void link_entry(struct name_index *index, size_t entry)
{
    size_t *bucket = bucket_of(index, index->hashes[entry]);
    index->before[entry] = *bucket;
    *bucket = entry;
}

/* As many buckets as there is room for entries. */
static bool grow(struct name_index *index)
{
    size_t wanted = index->capacity ? 2 * index->capacity : FEWEST_BUCKETS;
    size_t *buckets = malloc(wanted * sizeof *buckets);
    size_t *before = realloc(index->before, wanted * sizeof *before);
    index->before = before ? before : index->before;
    uint64_t *hashes = realloc(index->hashes, wanted * sizeof *hashes);
    index->hashes = hashes ? hashes : index->hashes;
    if (!buckets || !before || !hashes) {
        free(buckets);
        return false;
    }
    free(index->buckets);
    index->buckets = buckets;
    index->bucket_count = index->capacity = wanted;
    for (size_t i = 0; i < wanted; i++)
        buckets[i] = NAME_INDEX_NONE;
    for (size_t i = 0; i < index->count; i++)
        link_entry(index, i);
    return true;
}

bool name_index_add(struct name_index *index, uint64_t hash)
{
    if (index->count == index->capacity && !grow(index))
        return false;
    index->hashes[index->count] = hash;
    link_entry(index, index->count++);
    return true;
}

void name_index_cut(struct name_index *index, size_t count)
{
    while (index->count > count) {
        size_t last = --index->count;
        *bucket_of(index, index->hashes[last]) = index->before[last];
    }
}

static size_t same_hash(const struct name_index *index, size_t entry, uint64_t hash)
{
    while (entry != NAME_INDEX_NONE && index->hashes[entry] != hash)
        entry = index->before[entry];
    return entry;
}

size_t name_index_find(const struct name_index *index, uint64_t hash)
{
    return index->count > 0 ? same_hash(index, *bucket_of(index, hash), hash) : NAME_INDEX_NONE;
}

size_t name_index_before(const struct name_index *index, size_t entry)
{
    return same_hash(index, index->before[entry], index->hashes[entry]);
}

void name_index_release(struct name_index *index)
{
    free(index->buckets);
    free(index->hashes);
    free(index->before);
    *index = (struct name_index){0};
}
