/* links.h: which elements exchange light, and how much of it.
 *
 * Hanrahan, Salzman and Aupperle 1991: two elements exchange light as wholes if what goes from one
 * to the other is small, by their form factor times area and radiosity ("BF refinement"); otherwise
 * the larger one is divided, and its children are looked at. So n elements need about n links in
 * place of n^2 form factors. Light that is partly in shadow is divided more finely, and links whose
 * shadow rays all end before the other element are dropped.
 *
 * A link stands for both directions, F_pq A_p = F_qp A_q: light that one side loses, the other
 * gains. Between triangles that are near, the exchange is the mean over three points of each of
 * Lambert's formula (form_factor.h), times the share of shadow rays that pass; of clusters it is
 * the mean over the pairs of points themselves, shadows and orientation with it.
 */
#ifndef PSPLAT_ESTIMATOR_RADIOSITY_LINKS_H
#define PSPLAT_ESTIMATOR_RADIOSITY_LINKS_H

#include "element.h"

struct link {
    uint32_t source;
    uint32_t is_clear; /* 1: nothing stands between the two */
    float form_factor; /* from the receiver to the source, shadows included */
};

/* Links by their receivers: those of element i are [starts[i], starts[i + 1]). */
struct links {
    const ps_host *host;
    struct link *list;
    uint64_t *starts;
    uint64_t count;
    bool cut_short; /* there were to be more of them than allowed */
};

struct links_setting {
    double epsilon; /* of the reflected direct light of the scene, what a link may carry */
    uint64_t most;  /* links */
};

/* Divides elements of the scene, whose direct light is known, and links them. PS_ERROR_MEMORY or
 * PS_CANCELLED. Tells its progress. */
ps_result links_create(struct elements *elements, const struct links_setting *setting,
                       struct links *links);
void links_release(struct links *links);

#endif
