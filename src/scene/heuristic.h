/* heuristic.h: how two samplings of the same light share it (Veach and Guibas 1995). */
#ifndef SCENE_HEURISTIC_H
#define SCENE_HEURISTIC_H

/* The share of what was drawn with density `own`, where the other sampling has density `other`:
 * the power heuristic. All of it where one of them is a delta, given as 0, which the other can't
 * meet. */
static inline float power_heuristic(float own, float other)
{
    if (!(own > 0.0f && other > 0.0f))
        return 1.0f;
    float ratio = other / own;
    return 1.0f / (1.0f + ratio * ratio);
}

#endif
