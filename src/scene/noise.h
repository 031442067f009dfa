/* noise.h: smooth random functions of a point in space.
 *
 * Gradient noise after Perlin 2002, "Improving noise": at each whole-numbered point a direction,
 * out of 12, chosen at random; between them the slopes are faded with 6t^5 - 15t^4 + 10t^3, so that
 * the second derivative is continuous too. The directions come from a hash of the point instead of
 * a permutation table: the noise never repeats, and there is nothing to set up. Its value is 0 at
 * whole-numbered points and lies within +-NOISE_LIMIT elsewhere; mean 0, deviation 0.27;
 * features are about 1 wide.
 *
 * Pure functions: the same point has the same value in every thread and on every machine. Points
 * whose coordinates are beyond 2^23, where floats have no fractions, or NaN, count as 0 there.
 */
#ifndef SCENE_NOISE_H
#define SCENE_NOISE_H

#include <psplat/types.h>

/* The largest value that any choice of directions gives. */
#define NOISE_LIMIT 1.04f

/* More octaves would add features finer than floats can place. */
#define NOISE_OCTAVES_LIMIT 16

/* `seed` tells independent noises apart. */
float noise_value(ps_vec3 point, uint32_t seed);

/* The sum of `octaves` (1 to NOISE_OCTAVES_LIMIT) noises, each with features half as wide and half
 * as high as the one before, scaled so that its deviation is that of noise_value for any number of
 * them. Within +-2 * NOISE_LIMIT. Each octave's lattice is turned against the one before, and the
 * first against the axes, so that nothing shows the lattice along them.
 *
 * `width` >= 0: the mean over about so wide a part of a surface is wanted, and octaves with finer
 * features fade (Norton, Rockwood and Skolmoski 1982, "Clamping"); 0: the value at the point. */
float noise_fractal(ps_vec3 point, int32_t octaves, float width, uint32_t seed);

/* That of a point, and its gradient: hardly more work than the value, of which differences would
 * take six. */
float noise_fractal_gradient(ps_vec3 point, int32_t octaves, uint32_t seed, ps_vec3 *gradient);

/* Three independent fractal noises. */
ps_vec3 noise_vector(ps_vec3 point, int32_t octaves, float width, uint32_t seed);

/* Those of a point, and the gradients of x, y and z. */
ps_vec3 noise_vector_gradients(ps_vec3 point, int32_t octaves, uint32_t seed, ps_vec3 gradients[3]);

#endif
