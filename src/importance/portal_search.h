/* portal_search.h: learns where a room has windows (direct/portals.h).
 *
 * Rays from surfaces that camera paths met tell where the sky is seen. The box is that of surfaces
 * that hardly see it, which are those within; where rays left it are the windows. Rays that go
 * there tell them finer, and how much of each is seen from each part of the box.
 *
 * Outdoors, or where nothing of the sky is seen, there are no portals: the sky's own way of drawing
 * rays is better, or nothing is gained.
 */
#ifndef IMPORTANCE_PORTAL_SEARCH_H
#define IMPORTANCE_PORTAL_SEARCH_H

#include "base/error.h"
#include "direct/portals.h"
#include <psplat/host.h>
#include <stdbool.h>

/* A surface that a camera path met. */
struct seen_surface {
    ps_vec3 position, normal; /* on the side that was met */
    bool is_near;             /* up to the one after the path's first diffuse one */
};

/* PS_ERROR_MEMORY, or PS_OK: free *portals, which are NULL where there are none. A function of the
 * surfaces and the seed alone. Main thread. */
ps_result portal_search(const ps_host *host, const ps_pass *pass,
                        const struct seen_surface *surfaces, size_t count, struct portals **portals,
                        struct error *error);

#endif
