/* stratify.h: runs a stratification on photons that a test made, with a host of the test's own. */
#ifndef TESTS_SUPPORT_STRATIFY_H
#define TESTS_SUPPORT_STRATIFY_H

#include "base/statistics.h"
#include <psplat/plugin.h>
#include <stdbool.h>

/* What the host tells: a scene in a sphere around the origin, a camera that looks along +z. */
struct stage {
    float radius;
    ps_vec3 camera;
    uint64_t seed;
    uint32_t pass;
    bool out_of_memory;           /* allocations fail */
    struct statistics statistics; /* of the last run */
    ps_result result;             /* of the last run */
    size_t allocations;           /* that were not released */
};

/* A stage of that radius; destroy its statistics after use. */
struct stage stage_of(float radius);
void stage_release(struct stage *stage);

/* A white photon that shines up from a floor. */
ps_photon stratify_photon(ps_vec3 position, float power, uint64_t path);

/* Combines n photons in place by a choice such as "grid:cell=1"; how many are left. A plugin that
 * refuses its parameters fails the test. Everything it allocated must be released. */
size_t stratify_photons(struct stage *stage, const char *choice, ps_photon *photons, size_t n);

/* The numbers of the cells that the photons themselves lie in, by that choice; false where it has
 * no cells. */
bool stratify_cells(struct stage *stage, const char *choice, const ps_photon *photons, size_t n,
                    uint64_t *numbers);

/* Whether the plugin refuses its parameters in init. */
bool stratification_refuses(struct stage *stage, const char *choice);

#endif
