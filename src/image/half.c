/* half.c: half floats have 1 sign bit, 5 of exponent (bias 15) and 10 of mantissa. */
#include "image/half.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define EXPONENT_BIAS 15
#define MANTISSA_BITS 10
#define MANTISSA_ONE (1 << MANTISSA_BITS)
#define EXPONENT_SPECIAL 31 /* infinity, NaN */
#define LEAST_EXPONENT (1 - EXPONENT_BIAS)

float half_to_float(uint16_t half)
{
    int exponent = half >> MANTISSA_BITS & EXPONENT_SPECIAL;
    int mantissa = half & (MANTISSA_ONE - 1);
    float size;
    if (exponent == EXPONENT_SPECIAL) {
        size = mantissa == 0 ? INFINITY : NAN;
    } else if (exponent == 0) {
        size = ldexpf((float)mantissa, LEAST_EXPONENT - MANTISSA_BITS);
    } else {
        size = ldexpf((float)(MANTISSA_ONE + mantissa), exponent - EXPONENT_BIAS - MANTISSA_BITS);
    }
    return half & 0x8000 ? -size : size;
}

/* Float and half differ in the bias and in 13 bits of mantissa. */
bool half_from_exact(float value, uint16_t *half)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    uint32_t exponent = bits >> 23 & 255;
    uint32_t mantissa = bits & 0x7fffff;
    uint32_t sign = bits >> 16 & 0x8000;
    if (exponent > 112 && exponent <= 142) {
        *half = (uint16_t)(sign | (exponent - 112) << MANTISSA_BITS | mantissa >> 13);
        return (mantissa & 0x1fff) == 0;
    }
    float steps = fabsf(value) * 0x1p24f; /* of numbers too small to be normal */
    if (!(steps < MANTISSA_ONE))
        return false;
    *half = (uint16_t)(sign | (uint32_t)steps);
    return (float)(uint32_t)steps == steps;
}

uint16_t half_from_float(float value)
{
    int exponent;
    uint16_t half = 0;
    float size = fabsf(value);
    if (!(size <= HALF_LARGEST))
        size = size > HALF_LARGEST ? HALF_LARGEST : 0.0f;
    (void)frexpf(size, &exponent);            /* in 2^(exponent - 1) .. 2^exponent */
    int least = exponent - 1 - MANTISSA_BITS; /* what the last bit stands for */
    if (least < LEAST_EXPONENT - MANTISSA_BITS)
        least = LEAST_EXPONENT - MANTISSA_BITS;
    size = ldexpf(rintf(ldexpf(size, -least)), least);
    bool is_exact = half_from_exact(copysignf(size, value), &half);
    assert(is_exact);
    (void)is_exact;
    return half;
}
