/* output_file.h: a file that appears whole or not at all. */
#ifndef BASE_OUTPUT_FILE_H
#define BASE_OUTPUT_FILE_H

#include "base/error.h"
#include <stdbool.h>

/* Open between output_file_open and the one call of output_file_commit or output_file_discard that
 * must follow it. One thread at a time. */
struct output_file {
    char *path;      /* owned; as the caller gave it, for messages */
    char *target;    /* owned; what `path` leads to once links are followed */
    char *temporary; /* owned; beside the target, or NULL where bytes go straight to a device */
    int descriptor;
    bool is_new; /* replaces nothing */
};

/* Starts a file that will replace `path`. Character devices such as /dev/null are written directly;
 * pipes, sockets, directories and read-only files are refused. */
ps_result output_file_open(struct output_file *file, const char *path, struct error *error);

/* Starts a file that takes the place of no other: PS_ERROR_INVALID where there is something of that
 * name, here or, if it came in between, at the commit. */
ps_result output_file_open_new(struct output_file *file, const char *path, struct error *error);

/* Writes `size` bytes at `offset` from the start. */
ps_result output_file_write(const struct output_file *file, uint64_t offset, const void *data,
                            size_t size, struct error *error);

/* Puts the file in its place; where that fails, what was there stays. Closes and releases. */
ps_result output_file_commit(struct output_file *file, struct error *error);

/* Removes what was written. Closes and releases. */
void output_file_discard(struct output_file *file);

#endif
