/* merge.h: many photons into one (Hoet 2014, sections 3.2.1 and 4.2).
 *
 * The photons i of a stratum, each of power Phi_i from its own place in its own direction, become
 * one of them with the power of all. What the light does on average decides which one may stay:
 *
 *   random        Photon i with probability p_i = Y(Phi_i) / sum_j Y(Phi_j), Y the luminance. If
 *                 f_i is what a pixel gets of a unit of photon i, the mean of what it gets is sum_i
 *                 p_i f_i sum_j Phi_j, and in luminance that is sum_i f_i Y(Phi_i): what it would
 *                 get without merging. So no bias, only noise; colours mix within a stratum. With
 *                 even odds, as in the thesis, this holds only where all powers are the same.
 *   nearest_mean  The one nearest to the mean position (weighted by luminance). Less noise in where
 *                 light starts, but the middle of a stratum is served more than its rim: a bias.
 *   dominant      The one whose direction is closest to the mean direction (weighted likewise). The
 *                 directions that a surface sends light in shrink towards its normal: a large bias.
 *
 * Means themselves are no choice: a mean position may lie inside of something, and a mean direction
 * goes where no photon did (Hoet 2014, section 3.2.1).
 *
 * Photons of any bounce may merge, since light does not remember; the one that stays keeps path,
 * bounce, position, normal and direction, and its place in the array: what is left is in path
 * order.
 */
#ifndef STRATIFY_MERGE_H
#define STRATIFY_MERGE_H

#include "plugin/shared_params.h"

/* Merges the photons of each stratum whose normals agree, removes those that are no more and
 * those that stand for none, and counts strata and merged photons in the statistics: a stratum
 * counts once for each group of normals. Reorders the strata's entries. Returns how many photons
 * are left. */
size_t merge(const struct merge_params *params, const ps_host *host, const ps_pass *pass,
             const ps_strata *strata, ps_photon *photons, size_t n);

#endif
