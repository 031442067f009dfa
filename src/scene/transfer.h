/* transfer.h: a scene description as a stream of bytes, from one process to another.
 *
 * One walk over the description serves both ends: structs go as they are in memory, and each array
 * that a pointer owns goes after the struct that holds the pointer. So both ends have to be the
 * same program. Names that origins refer to are not owned by what holds them: see transfer_names.
 */
#ifndef SCENE_TRANSFER_H
#define SCENE_TRANSFER_H

#include "scene/description.h"

struct transfer {
    /* Writes the bytes, which it leaves as they are, or reads so many; false: that fails. */
    bool (*move)(void *user, void *bytes, size_t size);
    void *user;
    bool receives;
    bool failed; /* nothing more is moved, and pointers that were not received become NULL */
};

void transfer_bytes(struct transfer *transfer, void *bytes, size_t size);

/* An array of *count structs, whose own arrays follow by further calls; `member` is the address of
 * the pointer that owns it. NULL stays NULL. Where it is not received, *count becomes 0. */
void transfer_structs(struct transfer *transfer, void *member, size_t *count, size_t size);

/* A string that *text owns, or NULL. */
void transfer_text(struct transfer *transfer, char **text);

/* What the members of a description own; the struct itself has gone before. What was received in
 * part can be released. */
void transfer_description(struct transfer *transfer, struct scene_description *description);

/* After a description was received from another process: its origins and meshes hold addresses
 * of that process's names, which were at old[0] to old[file_count - 1]; they become those of
 * `files`. */
void transfer_names(struct scene_description *description, const char *const old[]);

#endif
