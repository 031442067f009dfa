/* half.h: IEEE 754 half floats, as their 16 bits. */
#ifndef IMAGE_HALF_H
#define IMAGE_HALF_H

#include <stdbool.h>
#include <stdint.h>

#define HALF_LARGEST 65504.0f

float half_to_float(uint16_t half);

/* False where no finite half float has that value; `half` is then of no use. */
bool half_from_exact(float value, uint16_t *half);

#endif
