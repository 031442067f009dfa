/* rendering.h: what goes on within a call that renders: settings, callbacks and statistics of its
 * own. */
#ifndef API_RENDERING_H
#define API_RENDERING_H

#include "api/handles.h"
#include "base/statistics.h"
#include "pipeline/render.h"
#include <pthread.h>

struct psplat_rendering {
    const psplat_scene *scene;
    bool is_preview; /* of draft quality */
    struct psplat_callbacks callbacks;
    struct render_settings settings;
    struct statistics statistics;
    pthread_mutex_t listening;
    struct render *render; /* between passes */
};

typedef ps_result (*rendering_work)(psplat_rendering *rendering, void *user, struct error *error);

/* Checks what psplat_render is given, and does the work with that; `rendering` has the scene, and
 * whether it is a preview. */
ps_result rendering_do(psplat_rendering *rendering, const psplat_callbacks *callbacks,
                       rendering_work work, void *user, psplat_error *error);

/* How a render talks to the callbacks; `user` is the rendering. */
struct render_callbacks rendering_callbacks(psplat_rendering *rendering);

/* Wraps an image of so many passes, which it takes over in any case. */
ps_result rendering_wrap(const psplat_rendering *rendering, struct image *image, uint32_t passes,
                         psplat_picture **picture, struct error *error);

#endif
