/* file.h: reads a whole file. */
#ifndef BASE_FILE_H
#define BASE_FILE_H

#include "base/error.h"
#include <stddef.h>

#define FILE_LARGEST ((size_t)256 * 1024 * 1024)

struct file_text {
    char *bytes;
    size_t length;
    /* Of the file system: two names with the same pair are one file. Both 0: not known. */
    uint64_t device, serial;
};

/* Reads the file, or standard input where the path is "-", up to FILE_LARGEST bytes. `text` must be
 * zeroed, and released in any case. */
ps_result file_read(const char *path, struct file_text *text, struct error *error);

/* The same for a file that a scene names: a regular one of at most `most` bytes, and where `folder`
 * is not NULL, one that lies in that folder (input_file_open). */
ps_result file_read_regular(const char *path, const char *folder, size_t most,
                            struct file_text *text, struct error *error);

void file_release(struct file_text *text);

#endif
