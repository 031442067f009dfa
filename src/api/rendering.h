/* rendering.h: what goes on within a call that renders: settings, callbacks and statistics of its own. */
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

typedef ps_result (*rendering_work)(psplat_rendering *rendering,
                                    const struct render_callbacks *callbacks, void *user,
                                    struct error *error);

/* Checks what psplat_render is given, and does the work with that; `rendering` has the scene, and whether it is a preview. */
ps_result rendering_do(psplat_rendering *rendering, const psplat_callbacks *callbacks,
                       rendering_work work, void *user, psplat_error *error);

#endif
