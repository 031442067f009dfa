/* near_share.h: how much of the light from nearby splats give, and how much is left to near rays.
 *
 * Splats blur light; rays that are shot from pixels find it as it is, with more noise, and only so far
 * (pipeline/near_gather.h). At distance t from the source's plane splats give the share
 *
 *     s^2 (3 - 2 s),   s = min(t / full_from, 1)
 *
 * and rays the rest, so that the sum is right wherever light is even. With one distance where the one stops
 * and the other begins, a lit surface that begins just past it (the top of a block, a pool of light on a
 * floor) lost what blur moved before it: nobody counted it. Changing from the one to the other by degrees, most of
 * that stays, and rays reach further for their noise. A straight line does as well, but for contacts, where
 * splats then keep more than twice as much of their blur.
 */
#ifndef SPLAT_NEAR_SHARE_H
#define SPLAT_NEAR_SHARE_H

#include <psplat/math.h>

/* s at distance 0, and what each unit of distance adds to it. */
struct near_share {
    float base, rise;
};

/* full_from 0: splats give all of the light. */
static inline struct near_share near_share_until(float full_from)
{
    bool all = !(full_from > 0.0f);
    return (struct near_share){all ? 1.0f : 0.0f, all ? 0.0f : 1.0f / full_from};
}

/* Compilers make vectors of it. */
static inline float near_share_of_splats(struct near_share share, float distance)
{
    float s = ps_max(ps_min(share.base + distance * share.rise, 1.0f), 0.0f);
    return s * s * (3.0f - 2.0f * s);
}

#endif
