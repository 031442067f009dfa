/* callbacks.h: how a render talks to its user. */
#ifndef RENDER_CALLBACKS_H
#define RENDER_CALLBACKS_H

#include <psplat/host.h>
#include <stdbool.h>

struct render;

/* All members may be NULL; all are called on the calling thread but `log`, which any thread may call. */
struct render_callbacks {
    void *user;
    void (*progress)(void *user, const char *stage,
                     double fraction); /* of the whole render, 0..1 */
    void (*log)(void *user, ps_log_level level, const char *message);
    bool (*cancelled)(void *user); /* any thread */
    /* Before each pass: whether there is to be another; it is the first of the settings' that the film lacks. May
     * look at the picture so far (pipeline/render.h). */
    bool (*go_on)(void *user, struct render *render);
};

#endif
