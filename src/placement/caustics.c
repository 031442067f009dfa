/* caustics.c: see caustics.h. The landings are few, so all of them are looked at. */
#include "placement/caustics.h"

#include <math.h>
#include <psplat/math.h>

#define NEIGHBOURS 6

/* Photons that share a disc in the first pass: their noise against their blur. */
#define CAUSTIC_PHOTONS 200.0

float caustics_scale(double photons, uint32_t pass)
{
    return (float)(sqrt(CAUSTIC_PHOTONS / (NEIGHBOURS * photons)) * pow(pass + 1.0, -1.0 / 6.0));
}

/* Keeps the least ones, in order. */
static void insert(float nearest[NEIGHBOURS], float distance2)
{
    int i = NEIGHBOURS - 1;
    for (; i > 0 && nearest[i - 1] > distance2; i--)
        nearest[i] = nearest[i - 1];
    nearest[i] = distance2;
}

float caustics_radius(const struct caustics *caustics, ps_vec3 place)
{
    float nearest[NEIGHBOURS];
    for (int i = 0; i < NEIGHBOURS; i++)
        nearest[i] = INFINITY;
    for (size_t i = 0; i < caustics->count; i++) {
        ps_vec3 to = ps_subtract(caustics->landings[i], place);
        float distance2 = ps_dot(to, to);
        if (distance2 < nearest[NEIGHBOURS - 1])
            insert(nearest, distance2);
    }
    return caustics->scale * sqrtf(nearest[NEIGHBOURS - 1]);
}
