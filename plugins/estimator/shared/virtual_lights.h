/* virtual_lights.h: virtual point lights: photons that shine over their hemispheres (Keller 1997).
 *
 * A photon of power Phi (its direction is ignored) on a diffuse surface has intensity Phi / pi *
 * cos(theta_photon); at distance d it gives
 *
 *     E(p) = Phi / pi * G * V,   G = cos(theta_photon) * cos(theta_receiver) / d^2
 *
 * G has no bound as d goes to 0: bright spots near the photons. So d counts as a clamp distance at
 * least, and what that takes away is found by short rays (compensation.h).
 *
 * Photons on mirrors, gloss and glass shine into one direction and can't be point lights: what they
 * would light (caustics) is left out. They are counted in the statistics.
 */
#ifndef PSPLAT_ESTIMATOR_VIRTUAL_LIGHTS_H
#define PSPLAT_ESTIMATOR_VIRTUAL_LIGHTS_H

#include <psplat/plugin.h>

/* Row of a parameter `clamp`, a ps_number_or_choice. */
#define VIRTUAL_LIGHTS_CLAMP(state)                                                                \
    PS_NUMBER_OR(state, clamp, "auto", 0, INFINITY, 0, virtual_lights_clamp_choices,               \
                 "scene units",                                                                    \
                 "shorter distances count as this; auto: 5 % of the scene's radius; 0: none")

static const char *const virtual_lights_clamp_choices[] = {"auto", NULL};

/* What the parameter says, in scene units. */
float virtual_lights_clamp(const ps_host *host, ps_number_or_choice clamp);

/* Sets of random numbers of PS_STREAM_ESTIMATOR that are free for others: from this one on. */
#define VIRTUAL_LIGHTS_SETS 1u

struct virtual_lights {
    const ps_host *host;
    const ps_pass *pass;
    ps_photon *lights; /* owned */
    size_t count, most;
    bool with_gloss;         /* photons on rough gloss are lights, too */
    uint64_t seen, left_out; /* photons that can be lights, and others */
    double power;            /* of all that can be */
};

/* Draws at most `most` of the pass's photons at random, and gives them the power of all. In
 * accumulate. Release the lights whatever it returns. */
ps_result virtual_lights_choose(const ps_host *host, const ps_pass *pass, size_t most,
                                struct virtual_lights *chosen);
void virtual_lights_release(struct virtual_lights *chosen);

/* The same for photons that are asked for elsewhere, and with_gloss or not: begin, all batches in
 * order, end. Main thread. */
ps_result virtual_lights_begin(const ps_host *host, const ps_pass *pass, size_t most,
                               bool with_gloss, struct virtual_lights *chosen);
void virtual_lights_take(struct virtual_lights *chosen, const ps_photon *photons, size_t n);
void virtual_lights_end(struct virtual_lights *chosen);

/* Where its rays start and end: off its surface. */
static inline ps_vec3 virtual_light_origin(const ps_pass *pass, const ps_photon *light)
{
    return ps_add_scaled(light->position, pass->surface_offset, light->normal);
}

#endif
