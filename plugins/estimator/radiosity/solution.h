/* solution.h: the radiosity of all elements, by gathering light over their links.
 *
 * B_i = rho_i (D_i + sum_j F_ij B_j), with D the direct irradiance, rho the albedo and F the form
 * factors. Each round of Jacobi's iteration is one more bounce: the light of elements is averaged
 * up the hierarchy, each element takes that of the elements that it is linked to, and hands it down
 * to its parts (Hanrahan, Salzman and Aupperle 1991, push and pull).
 *
 * Form factors that are estimated do not add up to 1, and the light would not either: at an albedo
 * of 0.9 an error of 1 % in all of them is 9 % of the light. So they are scaled to s_i F_ij s_j,
 * which leaves F_ij A_i = F_ji A_j, with s such that the sum is 1 for elements that see the scene
 * all around, and stays what it is for the others (Sinkhorn 1964 for matrices that are symmetric).
 * Then a closed scene absorbs what its lights send out.
 */
#ifndef PSPLAT_ESTIMATOR_RADIOSITY_SOLUTION_H
#define PSPLAT_ESTIMATOR_RADIOSITY_SOLUTION_H

#include "links.h"

struct solution {
    struct elements elements;
    struct links links;
    ps_rgb *radiosity; /* W/m^2, of each element; of those with children the mean */
    ps_rgb *indirect;  /* indirect irradiance, W/m^2, of elements without children */
    /* Fluxes, W, the sum of the channels. */
    double arrived, absorbed, escaped;
    uint32_t rounds;
    bool converged; /* or as many bounces as asked for are done */
};

/* PS_ERROR_MEMORY or PS_CANCELLED; released by solution_release either way. Tells the progress up
 * to `share`. */
ps_result solution_create(const ps_host *host, const ps_pass *pass,
                          const struct links_setting *setting, double share,
                          struct solution *solution);
void solution_release(struct solution *solution);

#endif
