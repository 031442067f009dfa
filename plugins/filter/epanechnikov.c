/* epanechnikov.c: weight 1 - r^2, a parabola over the disc.
 *
 * Of all kernels of one variance it is the one with the least mean square error of a density
 * estimate (Epanechnikov 1969). It needs no square root and has nothing to tune; at the rim it
 * falls to 0, so splats leave no edges.
 */
#include <psplat/plugin.h>

static void weigh(const void *state, const float *r2, float *weights, size_t n)
{
    (void)state;
    for (size_t i = 0; i < n; i++)
        weights[i] = 1.0f - r2[i];
}

static const ps_filter_vtable vtable = {.size = sizeof vtable, .weigh = weigh};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_FILTER,
    .name = "epanechnikov",
    .version = "1.0",
    .summary = "a parabola: the least error of a density estimate for its width",
    .paper = "Epanechnikov 1969, Non-parametric estimation of a multivariate probability density",
    .vtable = &vtable,
};

PS_MODULE(filter, epanechnikov, &descriptor)
