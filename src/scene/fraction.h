/* fraction.h: whole and fractional parts of coordinates that may be anything.
 *
 * Floats from 2^23 on are whole numbers; what is larger, infinite or NaN counts as 0, so that none
 * reaches a conversion to integers that is undefined. No call of floorf, which is one of a function
 * on processors without SSE 4.1.
 */
#ifndef SCENE_FRACTION_H
#define SCENE_FRACTION_H

#include <math.h>
#include <stdint.h>

#define FRACTION_LIMIT 0x1p23f

/* The largest whole number not above x. */
static inline int32_t whole_of(float x)
{
    if (!(fabsf(x) < FRACTION_LIMIT))
        return 0;
    int32_t whole = (int32_t)x;
    return whole - ((float)whole > x);
}

/* x - floor(x), in 0..1; 1 itself where x lies too little below a whole number for floats. */
static inline float fraction_of(float x)
{
    if (!(fabsf(x) < FRACTION_LIMIT))
        return 0.0f;
    return x - (float)whole_of(x);
}

#endif
