/* reference.h: the picture that views are measured against.
 *
 * A file, a picture that a view had, or one that is path traced meanwhile, as a third view that
 * nobody sees and that other threads go before.
 */
#ifndef EXPLORE_REFERENCE_H
#define EXPLORE_REFERENCE_H

#include "explore/option_list.h"
#include "explore/shown_picture.h"

struct explorer;

enum reference_kind { REFERENCE_NONE, REFERENCE_FILE, REFERENCE_VIEW, REFERENCE_PATHS };

#define MOST_REFERENCE_SAMPLES 1048576

/* Guarded by the explorer's lock. */
struct reference {
    enum reference_kind kind;
    char *file;                  /* of REFERENCE_FILE; owned */
    uint32_t samples;            /* of REFERENCE_PATHS */
    struct shown_picture *shown; /* of REFERENCE_FILE and _VIEW */
};

/* Each takes the place of the reference before, where it succeeds. A path that is not absolute
 * begins at the scene's folder. */
ps_result reference_put_file(struct explorer *explorer, const char *path, struct error *error);
ps_result reference_put_view(struct explorer *explorer, int view, struct error *error);

/* Of what view a shows, by so many paths a pixel. */
ps_result reference_put_paths(struct explorer *explorer, uint32_t samples, struct error *error);

void reference_delete(struct explorer *explorer);

/* What view a shows may have changed: path tracing begins anew where that matters. Under the
 * lock. */
void reference_follow(struct explorer *explorer);

/* Its picture, to be released, or NULL. Under the lock. */
struct shown_picture *reference_picture(const struct explorer *explorer);

/* Frees what it holds. */
void reference_release(struct reference *reference);

/* Writes null, or {"kind": "file" | "view" | "path_tracer", ...}. Under the lock. */
void reference_write(const struct explorer *explorer, struct json_writer *writer);

#endif
