/* half.h: IEEE 754 half floats, as their 16 bits. */
#ifndef IMAGE_HALF_H
#define IMAGE_HALF_H

#include <stdbool.h>
#include <stdint.h>

#define HALF_LARGEST 65504.0f

float half_to_float(uint16_t half);

/* The nearest one, of even bits where two are; those too large become HALF_LARGEST, NaN 0. */
uint16_t half_from_float(float value);

/* False where no finite half float has that value; `half` is then of no use. */
bool half_from_exact(float value, uint16_t *half);

#endif
