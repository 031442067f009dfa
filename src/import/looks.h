/* looks.h: what an import asked of the disk, and what the disk said.
 *
 * An import makes the same of a file as long as all the answers are the same. Digests are XXH3
 * (Collet; libxxhash), 64 bits: fast beside reading a mesh, and not against forgery.
 */
#ifndef IMPORT_LOOKS_H
#define IMPORT_LOOKS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum mesh_look_kind {
    LOOK_WHOLE,  /* the file's bytes; or it cannot be read */
    LOOK_EXISTS, /* whether there is such a file */
    LOOK_FIRST,  /* its first bytes */
    LOOK_CASE    /* the file whose path has other letter case */
};

struct mesh_look {
    int32_t kind; /* enum mesh_look_kind */
    bool there;
    char *path;      /* as it was asked for; owned */
    size_t size;     /* LOOK_FIRST: bytes asked for; LOOK_CASE: of the folder's name */
    uint64_t digest; /* of the bytes; LOOK_CASE: of the path that was found */
};

/* Zeroed: none. */
struct mesh_looks {
    bool incomplete; /* out of memory: not all are there */
    struct mesh_look *items;
    size_t count;
};

/* Adds one; `path` is copied. NULL: nothing is kept. */
void mesh_looks_add(struct mesh_looks *looks, struct mesh_look look, const char *path);
void mesh_looks_release(struct mesh_looks *looks);

uint64_t mesh_digest(const void *bytes, size_t size);

/* The digest of what follows in an open file, and how much it is. False: out of memory, or it
 * cannot be read. */
bool mesh_digest_rest(int file, uint64_t *size, uint64_t *digest);

/* The digest of a whole file in the folder (input_file.h), which is read for it alone; false: it
 * cannot be read. */
bool mesh_file_digest(const char *path, const char *folder, uint64_t *digest);

/* Whether the disk says the same of all of them now. The digest of one file is known. */
bool mesh_looks_hold(const struct mesh_looks *looks, const char *folder, const char *known,
                     uint64_t known_digest);

#endif
