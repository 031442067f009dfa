#include "debug/id_colour.h"

#include "base/sample.h"
#include <math.h>

/* One channel of a colour of full saturation; `turns` is its hue, 0..1. */
static double channel(double turns, double offset)
{
    double place = fmod(turns + offset, 1.0) * 6.0;
    return fmin(fmax(fabs(place - 3.0) - 1.0, 0.0), 1.0);
}

static uint8_t byte_of(double pure, double saturation, double value)
{
    return (uint8_t)(255.0 * value * (1.0 - saturation * (1.0 - pure)) + 0.5);
}

static struct colour from_hue(double hue, double saturation, double value)
{
    return (struct colour){
        byte_of(channel(hue, 0.0), saturation, value),
        byte_of(channel(hue, 2.0 / 3.0), saturation, value),
        byte_of(channel(hue, 1.0 / 3.0), saturation, value),
    };
}

struct colour id_colour(uint64_t id)
{
    uint32_t hash = sample_hash(id);
    double hue = (double)(hash >> 8) / (double)(1 << 24);
    double saturation = 0.45 + 0.2 * (double)(hash & 3u) / 1.5;
    double value = 0.55 + 0.15 * (double)(hash >> 2 & 3u);
    return from_hue(hue, saturation, value);
}

/* Steps of the golden section keep any number of hues apart. */
struct colour series_colour(unsigned number)
{
    return from_hue(fmod((double)number * 0.61803398875, 1.0), number % 2 ? 0.85 : 0.5, 1.0);
}
