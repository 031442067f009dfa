/* callbacks.h: how a render talks to its user. */
#ifndef RENDER_CALLBACKS_H
#define RENDER_CALLBACKS_H

#include "base/error.h"
#include <psplat/host.h>
#include <stdbool.h>

struct render;

/* All members may be NULL; all are called on the calling thread but `log`, which any thread may
 * call. */
struct render_callbacks {
    void *user;
    void (*progress)(void *user, const char *stage,
                     double fraction); /* of the whole render, 0..1 */
    void (*log)(void *user, ps_log_level level, const char *message);
    bool (*cancelled)(void *user); /* any thread */
    /* Before each pass: its number, which the film must lack; false: there is to be no other.
     * Without it, those of the settings are made in their order. May look at the picture so far
     * (pipeline/render.h). */
    bool (*next_pass)(void *user, struct render *render, uint32_t *number);
    /* After the last one, before the picture is made; `result` is what they ended with. */
    ps_result (*end_passes)(void *user, ps_result result, struct error *error);
};

#endif
