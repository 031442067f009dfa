/* pixel_light.h: which photons of a pass light a pixel by their splats, and how much of its
 * irradiance each brings. */
#ifndef DEBUG_PIXEL_LIGHT_H
#define DEBUG_PIXEL_LIGHT_H

#include "render/state.h"

enum pixel_sight { BEHIND_CAMERA, HIDDEN, SEEN };

struct pixel_source {
    ps_vec3 position; /* of the photon */
    ps_vec3 normal;   /* of the surface that it left */
    ps_rgb irradiance;
    unsigned bounce;
    enum pixel_sight sight;
    float x, y; /* in the picture, in pixels; unset behind the camera */
};

struct pixel_light {
    ps_vec3 position, normal;     /* of what the pixel sees, behind mirrors and glass too */
    ps_rgb irradiance;            /* W/m^2: the sum */
    struct pixel_source *sources; /* the brightest first */
    size_t source_count;
    uint64_t photon_count; /* of the pass */
};

/* By each splat alone, its depth map included. Light from nearby, for which estimators cast rays,
 * is that of splats, too. PS_ERROR_INVALID where the pixel is outside of the picture or sees no
 * surface. Released in any case. */
ps_result pixel_light_find(struct render *render, size_t x, size_t y, struct pixel_light *light,
                           struct error *error);
void pixel_light_release(struct pixel_light *light);

#endif
