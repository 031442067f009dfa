/* importance.h: what of the scene matters to the picture.
 *
 * By power alone, most light paths of a large scene end where nobody looks, and splats are as wide
 * as if all of it were seen. A pilot of camera paths (pilot.h) tells which lights light what the
 * camera sees, and where that is (Peter and Pietrek 1998, "Importance driven construction of photon
 * maps"; Keller and Wald 2000, "Efficient importance sampling techniques for the photon map").
 *
 * It is a function of scene, settings and seed alone, so that of all passes and shards is the same.
 * Constant once made; any thread may read it.
 */
#ifndef IMPORTANCE_IMPORTANCE_H
#define IMPORTANCE_IMPORTANCE_H

#include "direct/portals.h"
#include "scene/distribution.h"
#include <psplat/host.h>
#include <stdbool.h>

struct scene;

struct importance {
    /* By which light paths choose lights; count 0: there are not two of them, or it is not made. */
    struct distribution lights;
    /* The sphere in which most of what the camera sees lies, straight or by way of one surface
     * more; radius 0: all of the scene, which is no larger, or has not two lights. */
    ps_vec3 center;
    float radius;
    /* Light that hardly counts beside what the camera sees, see struct light_draws; 0: none, or
     * there are few lights. */
    float light_threshold;
    struct portals *portals; /* through which that sees the sky; NULL: none were found */
};

/* Whether there are so many lights that a threshold pays, and none that every point asks and that
 * has no noise. */
bool importance_has_threshold(const struct scene *scene);

/* Whether direct light at pixels goes by what is found here. */
bool importance_is_for_pixels(const struct scene *scene);

/* PS_ERROR_MEMORY, or PS_OK: release it. Main thread. */
ps_result importance_create(const ps_host *host, const ps_pass *pass, const struct scene *scene,
                            struct importance *importance, struct error *error);
void importance_release(struct importance *importance);

#endif
