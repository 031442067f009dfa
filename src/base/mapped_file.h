/* mapped_file.h: files that are read where they are looked at, and of which memory holds no more
 * than was agreed.
 *
 * A file is mapped (mmap(2)): the system reads pages when they are first looked at. Which blocks
 * were looked at lately is marked, and when the files of a budget hold more than it, those that
 * were not are given back, as the clock algorithm chooses them (Corbato, "A paging experiment with
 * the Multics system", 1969). Who looks at what is there needs no lock: what is given back under
 * its eyes is read again. Not a cache of read blocks, whose every look-up would have to lock or
 * count references.
 *
 * A file must not become shorter as long as it is mapped (SIGBUS); one that is replaced
 * (output_file.h) stays as it was.
 */
#ifndef BASE_MAPPED_FILE_H
#define BASE_MAPPED_FILE_H

#include "base/error.h"
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What is given back at a time: 64 KiB, which Linux also maps at a time. */
#define MAPPED_BLOCK_SHIFT 16
#define MAPPED_BLOCK ((size_t)1 << MAPPED_BLOCK_SHIFT)

/* Of several files, which it must outlive. Any thread. */
struct mapped_budget;

/* `bytes`: how much of the files may lie in memory, but for a block of each thread. NULL when out
 * of memory. */
struct mapped_budget *mapped_budget_create(double bytes);
void mapped_budget_destroy(struct mapped_budget *budget);

/* Bytes of its files that lie in memory, in whole blocks, and those that may yet come. */
size_t mapped_budget_held(const struct mapped_budget *budget);
double mapped_budget_to_come(const struct mapped_budget *budget);

enum mapped_mark { MAPPED_ABSENT, MAPPED_STALE, MAPPED_RECENT };

struct mapped_file {
    const unsigned char *bytes;
    void *mapping; /* the same, for the system */
    size_t size;
    uintptr_t first;        /* number of the block that `bytes` lies in, counted from address 0 */
    _Atomic uint8_t *marks; /* of each block: enum mapped_mark */
    struct mapped_budget *budget;
    struct mapped_file *next; /* of the budget's */
};

/* NULL with a reason that starts in lower case and does not name the path: PS_ERROR_IO,
 * PS_ERROR_MEMORY. */
struct mapped_file *mapped_file_open(const char *path, struct mapped_budget *budget,
                                     struct error *error);
void mapped_file_close(struct mapped_file *file);

/* For mapped_file_touch. */
void mapped_file_mark(const struct mapped_file *file, size_t block);

/* To be called before some bytes of the file are looked at, at most 64 KiB from `at` on. */
static inline void mapped_file_touch(const struct mapped_file *file, const void *at, size_t size)
{
    size_t block = ((uintptr_t)at >> MAPPED_BLOCK_SHIFT) - file->first;
    size_t last = (((uintptr_t)at + size - 1) >> MAPPED_BLOCK_SHIFT) - file->first;
    if (atomic_load_explicit(&file->marks[block], memory_order_relaxed) != MAPPED_RECENT)
        mapped_file_mark(file, block);
    if (last != block)
        mapped_file_mark(file, last);
}

#endif
