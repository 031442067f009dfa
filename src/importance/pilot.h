/* pilot.h: a few camera paths that tell how much light each light gives to what the camera sees.
 *
 * Paths go through points of the whole picture, by way of mirrors, glass and gloss to a first
 * diffuse surface, and on by the surfaces' own scattering; Russian roulette ends them. Each surface
 * past the first samples one light (next-event estimation): that is indirect light of the picture,
 * which photons bring. Light of lamps that scattering finds behind mirrors and glass counts, too.
 */
#ifndef IMPORTANCE_PILOT_H
#define IMPORTANCE_PILOT_H

#include "base/error.h"
#include "importance/light_shares.h"
#include "importance/portal_search.h"
#include <psplat/host.h>

struct scene;

/* What paths met. */
struct seen_places {
    struct seen_surface *surfaces;
    size_t count;
    /* Of those that are near. */
    ps_vec3 middle;
    double spread; /* the root mean square of the distances from there */
    /* The square of the mean root of their irradiance straight from the lights, which a few bright
     * places do not rule; W/m^2, the sum of red, green and blue. Only where
     * importance_has_threshold(). */
    double irradiance;
};

/* Adds what is found of each light to found[light]. PS_ERROR_MEMORY, or PS_OK: free seen->surfaces.
 * Main thread. */
ps_result pilot_trace(const ps_host *host, const ps_pass *pass, const struct scene *scene,
                      struct found_light *found, struct seen_places *seen, struct error *error);

#endif
