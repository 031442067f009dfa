#include "view/pixel_filter.h"

#define GAUSSIAN_DEVIATION 0.5f
#define GAUSSIAN_REACH 1.5f

/* Inverse of the tent's cumulative distribution over -1..1. */
static float tent(float number)
{
    return number < 0.5f ? sqrtf(2.0f * number) - 1.0f : 1.0f - sqrtf(2.0f - 2.0f * number);
}

void pixel_filter_point(enum pixel_filter filter, const float numbers[2], float point[2])
{
    const float variance2 = 2.0f * GAUSSIAN_DEVIATION * GAUSSIAN_DEVIATION;
    float inside, radius, phi;
    switch (filter) {
    case PIXEL_TENT:
        point[0] = 0.5f + tent(numbers[0]);
        point[1] = 0.5f + tent(numbers[1]);
        break;
    case PIXEL_GAUSSIAN: /* in polar coordinates, where it has an inverse */
        inside = 1.0f - expf(-GAUSSIAN_REACH * GAUSSIAN_REACH / variance2);
        radius = sqrtf(-variance2 * logf(1.0f - numbers[0] * inside));
        phi = 2.0f * PS_PI * numbers[1];
        point[0] = 0.5f + radius * cosf(phi);
        point[1] = 0.5f + radius * sinf(phi);
        break;
    case PIXEL_BOX:
        point[0] = numbers[0];
        point[1] = numbers[1];
        break;
    }
}
