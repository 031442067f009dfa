/* caustics.h: how dense the photons of caustics lie, by a few of them.
 *
 * What mirrors and glass bundle is far denser in some places than in others, so one radius for all
 * blurs the light of a focus over what lies around it. The radius at a place is that of a disc
 * which `CAUSTIC_PHOTONS` photons share, by the k-th nearest of a pass's first landings
 * (Loftsgaarden and Quesenberry 1965; as the k nearest photons of Jensen 1996, but for each photon
 * instead of each pixel: Silverman 1986, section 5.3).
 */
#ifndef PLACEMENT_CAUSTICS_H
#define PLACEMENT_CAUSTICS_H

#include <psplat/types.h>
#include <stddef.h>

#define CAUSTIC_LANDINGS 1024 /* that are kept, at most */

struct caustics {
    /* Borrowed; where photons land that met mirrors, glass and gloss alone. */
    const ps_vec3 *landings;
    size_t count;
    float scale; /* of the distance to the k-th: caustics_scale() */
};

/* For a pass with `photons` such photons for each of the landings, pass number `pass`, from 0. */
float caustics_scale(double photons, uint32_t pass);

/* The radius where such a photon lands; INFINITY where too few are known. */
float caustics_radius(const struct caustics *caustics, ps_vec3 place);

#endif
