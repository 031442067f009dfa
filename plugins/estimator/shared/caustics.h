/* caustics.h: light that comes from lamps by mirrors, glass and gloss alone, which changes too fast
 * for what estimators interpolate: its photons are splatted onto the pixels, by the visibility and
 * filter chosen. */
#ifndef PSPLAT_ESTIMATOR_CAUSTICS_H
#define PSPLAT_ESTIMATOR_CAUSTICS_H

#include <psplat/plugin.h>

/* Adds the pass's caustics to the tiles. Main thread. */
ps_result caustics_splat(const ps_host *host);

/* The same of n photons, those that are caustics; after begin_splats. */
ps_result caustics_splat_photons(const ps_host *host, const ps_photon *photons, size_t n);

#endif
