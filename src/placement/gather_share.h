/* gather_share.h: how much of the light from nearby splats give, and how much is left to gather
 * rays (step 6 of placement.h).
 *
 * Splats blur light; rays that are shot from pixels find it as it is, with more noise, and only so
 * far (short_range/short_range_gather.h). At distance t from the photon's plane splats give the
 * share
 *
 *     s^2 (3 - 2 s),   s = min(t / blend_distance, 1)
 *
 * and rays the rest, so that the sum is right wherever light is even. With one distance where the
 * one stops and the other begins, a lit surface that begins just past it (the top of a block, a
 * pool of light on a floor) lost what blur moved before it: nobody counted it. Changing from the
 * one to the other by degrees, most of that stays, and rays reach further for their noise. A
 * straight line does as well, but for contacts, where splats then keep more than twice as much of
 * their blur.
 */
#ifndef PLACEMENT_GATHER_SHARE_H
#define PLACEMENT_GATHER_SHARE_H

#include <psplat/math.h>
#include <stdbool.h>

/* s at distance 0, and what each unit of distance adds to it. */
struct gather_share {
    float base, rise;
};

/* blend_distance 0: splats give all of the light. */
static inline struct gather_share gather_share_until(float blend_distance)
{
    bool all = !(blend_distance > 0.0f);
    return (struct gather_share){all ? 1.0f : 0.0f, all ? 0.0f : 1.0f / blend_distance};
}

/* Compilers make vectors of it. */
static inline float gather_share_of_splats(struct gather_share share, float distance)
{
    float s = ps_max(ps_min(share.base + distance * share.rise, 1.0f), 0.0f);
    return s * s * (3.0f - 2.0f * s);
}

#endif
