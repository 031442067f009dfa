/* transfer.h: a mesh file's content by way of a file in memory, from the child that read it.
 *
 * The way of scene/transfer.h. Both ends are one program, and pointers to what the caller had
 * before the fork (names in origins) hold on both sides.
 */
#ifndef IMPORT_TRANSFER_H
#define IMPORT_TRANSFER_H

#include "import/import.h"
#include "import/looks.h"

/* What an import gives. */
struct mesh_outcome {
    ps_result result;
    struct error error;
    struct mesh_report report;
    struct scene_description fragment;
    struct mesh_looks looks; /* empty where the request names no cache */
};

/* An open file without a name, in memory where the system has such; -1: none. */
int mesh_transfer_open(void);

/* Writes all of it; false: not all could be written. */
bool mesh_outcome_send(struct mesh_outcome *outcome, int file);

/* Reads it from where the file stands. False where not all is there, or there is no memory for it;
 * `outcome` then holds nothing. */
bool mesh_outcome_receive(struct mesh_outcome *outcome, int file);

void mesh_outcome_release(struct mesh_outcome *outcome);

/* Sets the origins of objects, materials, textures, cameras and lights, where they are another
 * request's: of another process, or of an earlier reading. */
void mesh_fragment_set_origins(struct scene_description *fragment, struct origin origin);

#endif
