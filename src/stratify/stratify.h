/* stratify.h: runs a stratification: photons to strata, by the plugin, and strata to fewer photons
 * (merge.h). */
#ifndef STRATIFY_STRATIFY_H
#define STRATIFY_STRATIFY_H

#include "plugin/strategy.h"

/* Merges n photons in place; *n becomes the number of those that are left, in their order. Needs of
 * the host memory, random numbers and counters. What fails, host->fail was told. Main thread. */
ps_result stratify(const struct strategy *strategy, const ps_host *host, const ps_pass *pass,
                   ps_photon *photons, size_t *n);

/* The numbers of the strata in which points lie; PS_NO_STRATUM where nothing would merge. The
 * strategy has find_strata. May change how many photons they stand for. */
ps_result stratify_numbers(const struct strategy *strategy, const ps_host *host,
                           const ps_pass *pass, ps_photon *photons, size_t n, const ps_vec3 *points,
                           size_t count, uint64_t *numbers);

#endif
