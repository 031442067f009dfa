/* handles.h: what the handles of psplat.h hold. */
#ifndef API_HANDLES_H
#define API_HANDLES_H

#include "render_job/processes.h"
#include "session/render_options.h"
#include "trace/trace.h"
#include <psplat/psplat.h>

/* Seconds that loading took: reading and checking; making the scene; making what traces rays
 * through it. */
struct load_times {
    double load, scene, build;
};

struct psplat_scene {
    struct render_options options;
    psplat_listener listener; /* NULL: nobody */
    void *user;               /* its */
    bool is_loaded, is_text;
    struct scene_input input; /* as the following, where `is_loaded` */
    struct scene scene;
    struct trace *trace; /* over it, which all renders share */
    struct load_times times;
    /* That share its renders; NULL: none do, or it was not loaded yet. */
    struct processes *processes;
};

struct psplat_picture {
    struct image image;
    struct output_options output;
    uint32_t threads; /* to write it with */
};

#endif
