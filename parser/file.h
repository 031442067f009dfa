/* file.h: reads a whole file. */
#ifndef PARSER_FILE_H
#define PARSER_FILE_H

#include "base/error.h"

#define FILE_LARGEST ((size_t)256 * 1024 * 1024)

struct file_text {
    char *bytes;
    size_t length;
};

/* Reads the file, or standard input where the path is "-", up to FILE_LARGEST bytes. `text` must be
 * zeroed, and released in any case. */
ps_result file_read(const char *path, struct file_text *text, struct error *error);
void file_release(struct file_text *text);

#endif
