/* files.h: the files of one mesh import, each read whole and kept until its end. */
#ifndef IMPORT_FILES_H
#define IMPORT_FILES_H

#include "import/import.h"
#include "import/looks.h"

#define MESH_FILE_LARGEST ((size_t)4 * 1024 * 1024 * 1024)
#define MESH_PEEK_MOST 64 /* bytes */

struct workers;

struct mesh_file {
    struct mesh_file *next;
    char *path;
    char *bytes; /* a zero follows; may be changed */
    size_t length;
    bool made; /* by mesh_files_add */
};

/* Zeroed but for `memory`: files on the disk. */
struct mesh_files {
    const struct mesh_memory_file *memory; /* NULL: the disk */
    size_t memory_count;
    const char *folder;       /* the only one to read from (input_file.h), or NULL */
    struct mesh_file *read;   /* the newest first */
    struct mesh_looks *looks; /* what is asked of the disk goes there; NULL: nowhere */
};

/* The file of that path, read once. PS_ERROR_IO (absent, not a regular file), _INVALID (too large)
 * or _MEMORY. */
ps_result mesh_files_read(struct mesh_files *files, const char *path, struct mesh_file **file,
                          struct error *error);

/* As many threads as reading the file keeps busy: one for each MiB, and no more than there are
 * processors. */
ps_result mesh_file_workers(const struct mesh_file *file, struct workers **workers,
                            struct error *error);

/* Adds one of that path, which hides one that may be there; `bytes` come from malloc, with a zero
 * after them, and are taken over in any case. */
ps_result mesh_files_add(struct mesh_files *files, const char *path, char *bytes, size_t length,
                         struct error *error);

/* Whether there is a regular file of that path. */
bool mesh_files_exist(struct mesh_files *files, const char *path);

/* Whether there is one whose path has other letter case beyond the first `folder` bytes; `path`
 * becomes that: of several the first by strcmp. */
bool mesh_files_match_case(struct mesh_files *files, char *path, size_t folder);

/* The first bytes of such a file, at most `size` (up to MESH_PEEK_MOST): how many. */
size_t mesh_files_peek(struct mesh_files *files, const char *path, unsigned char *bytes,
                       size_t size);

void mesh_files_release(struct mesh_files *files);

#endif
