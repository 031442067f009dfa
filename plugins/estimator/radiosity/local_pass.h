/* local_pass.h: from the solution to the picture.
 *
 * Elements of one radiosity each make a picture of triangles, and of any smooth interpolation
 * between them, shadows and contacts as coarse as the elements. Lischinski, Tampieri and Greenberg
 * 1993: what the solution knows well is which elements light a place. So each pixel takes the light
 * of those that its element is linked to anew: the form factors from the pixel's own point, by
 * Lambert's formula, and shadows by rays from there.
 *
 * Over links that nothing stands in the way of, from elements that are evenly lit, that is exact,
 * and without noise. The other ones would need a ray or more each. Instead some are drawn, with
 * probabilities in proportion to the light that they would bring without shadows, and a ray goes to
 * a point of each. It counts with the radiosity of the finest element there: with the mean of the
 * whole source, what is hidden of it would darken what is seen, and the other way round. Points of
 * near triangles are even over their solid angle (spherical_triangle.h), as the light of others has
 * no bound where they meet.
 */
#ifndef PSPLAT_ESTIMATOR_RADIOSITY_LOCAL_PASS_H
#define PSPLAT_ESTIMATOR_RADIOSITY_LOCAL_PASS_H

#include "solution.h"

struct local_setting {
    const ps_pass *pass;
    uint64_t samples; /* shadow rays of a pixel */
    bool elements;    /* show the elements instead, each with its mean irradiance */
};

/* Adds the indirect light of all pixels. PS_ERROR_MEMORY or PS_CANCELLED. */
ps_result local_pass(const struct solution *solution, const struct local_setting *setting);

#endif
