/* ahead.h: a mesh file that is read before the scene that names it.
 *
 * The scene around a lone model (model/model.h) is written by what is in the model. When that scene
 * is read, the file need not be read again.
 */
#ifndef IMPORT_AHEAD_H
#define IMPORT_AHEAD_H

#include "import/import.h"

struct mesh_ahead {
    bool is_there;
    struct mesh_request request; /* borrows its texts */
    struct scene_description fragment;
    struct mesh_report report;
};

/* As mesh_import. `ahead` is to be released, and holds nothing after a failure. */
ps_result mesh_read_ahead(const struct mesh_request *request, struct mesh_ahead *ahead,
                          struct error *error);

/* Hands out what was read ahead if the same is asked for, as mesh_import would: once, with the
 * request's origin. False, and nothing else, where it is another request, or `ahead` is NULL. */
bool mesh_take_ahead(struct mesh_ahead *ahead, const struct mesh_request *request,
                     struct scene_description *fragment, struct mesh_report *report);

void mesh_ahead_release(struct mesh_ahead *ahead);

#endif
