/* include.h: reads a scene's file, and the files that it includes, into one tree. */
#ifndef PARSER_LANGUAGE_INCLUDE_H
#define PARSER_LANGUAGE_INCLUDE_H

#include "base/file.h"
#include "parser/sections/reader.h"
#include "parser/yaml/builder.h"

/* Bounds on what a scene may include. */
#define MOST_FILES 256
#define MOST_INCLUDES 4096 /* how often they may be named */
#define DEEPEST_INCLUDE 16

/* Where included files come from. */
struct psd_files {
    void *user;
    /* Reads a file of at most `most` bytes, as file_read_regular. */
    ps_result (*read)(void *user, const char *path, size_t most, struct file_text *text,
                      struct error *error);
};

/* The main file's text, which was read already; `reader->file` is its name. */
struct main_text {
    const char *text;
    size_t length;
    uint64_t device, serial; /* as in file.h */
};

/* A file is read once, whoever includes it. The tree may be looked at where PS_OK is returned,
 * though errors may have been reported; else PS_ERROR_INVALID or PS_ERROR_MEMORY (which is not
 * reported). */
ps_result include_read(struct reader *reader, const struct psd_files *files, struct budget *budget,
                       const struct main_text *main, const struct node **root);

#endif
