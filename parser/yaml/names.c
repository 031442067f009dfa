/* names.c: a crit-bit tree (D. J. Bernstein).
 *
 * A lookup costs at most the bits of the name, whatever names were chosen. A hash table would be
 * as short, but names chosen to collide make it quadratic, and scenes may be hostile.
 */
#include "parser/yaml/names.h"

#include <stdint.h>
#include <string.h>

/* A leaf has a name; an inner branch splits by one bit of one byte of the names below it. */
struct names_branch {
    const char *name;
    size_t byte;
    unsigned bit; /* as a mask */
    struct names_branch *sides[2];
    void *value;
};

static int side_of(const struct names_branch *branch, const char *name, size_t length)
{
    unsigned byte = branch->byte < length ? (unsigned char)name[branch->byte] : 0;
    return (byte & branch->bit) != 0;
}

/* The one leaf that can be equal. */
static struct names_branch *nearest_leaf(const struct names *names, const char *name)
{
    size_t length = strlen(name);
    struct names_branch *branch = names->root;
    while (branch && !branch->name)
        branch = branch->sides[side_of(branch, name, length)];
    return branch;
}

void *names_get(const struct names *names, const char *name)
{
    const struct names_branch *leaf = nearest_leaf(names, name);
    return leaf && strcmp(leaf->name, name) == 0 ? leaf->value : NULL;
}

/* Finds the first bit in which two different names differ. */
static void set_split(struct names_branch *branch, const char *name, const char *other)
{
    while (name[branch->byte] == other[branch->byte])
        branch->byte++;
    unsigned difference =
        (unsigned char)name[branch->byte] ^ (unsigned)(unsigned char)other[branch->byte];
    branch->bit = 0x80;
    while (!(difference & branch->bit))
        branch->bit >>= 1;
}

static bool splits_before(const struct names_branch *a, const struct names_branch *b)
{
    return a->byte < b->byte || (a->byte == b->byte && a->bit > b->bit);
}

bool names_put(struct names *names, struct arena *arena, const char *name, void *value)
{
    struct names_branch *nearest = nearest_leaf(names, name);
    if (nearest && strcmp(nearest->name, name) == 0) {
        nearest->value = value;
        return true;
    }
    struct names_branch *leaf = arena_allocate(arena, sizeof *leaf);
    if (!leaf)
        return false;
    leaf->name = name;
    leaf->value = value;
    if (!nearest) {
        names->root = leaf;
        return true;
    }
    struct names_branch *split = arena_allocate(arena, sizeof *split);
    if (!split)
        return false;
    set_split(split, name, nearest->name);
    size_t length = strlen(name);
    struct names_branch **link = &names->root;
    while (!(*link)->name && splits_before(*link, split))
        link = &(*link)->sides[side_of(*link, name, length)];
    int side = side_of(split, name, length);
    split->sides[side] = leaf;
    split->sides[!side] = *link;
    *link = split;
    return true;
}
