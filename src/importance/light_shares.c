#include "importance/light_shares.h"

#include <math.h>

/* The part of all paths that goes by power alone. */
#define BY_POWER 0.2

/* Finds by power that are added to those of each run. */
#define MORE_BY_POWER 2.0

/* Lights in order, and what is known of each. */
struct light_list {
    const uint32_t *order;
    const float *powers;
    const struct found_light *found;
    float *importance; /* of each light */
};

struct sums {
    double light, times, power;
};

static struct sums sums_of(const struct light_list *list, size_t first, size_t end)
{
    struct sums sums = {0, 0, 0};
    for (size_t i = first; i < end; i++) {
        uint32_t light = list->order[i];
        sums.light += list->found[light].sum;
        sums.times += list->found[light].times;
        sums.power += (double)list->powers[light];
    }
    return sums;
}

/* The part of a run's light that one half of it is taken to have. */
static double part_of(const struct sums *half, const struct sums *whole)
{
    double by_power = whole->power > 0.0 ? half->power / whole->power : 0.0;
    if (!(whole->light > 0.0))
        return by_power;
    double by_light = half->light / whole->light;
    return (whole->times * by_light + MORE_BY_POWER * by_power) / (whole->times + MORE_BY_POWER);
}

/* Shares light among the lights from `first` to before `end`, which have the sums `whole`. */
static void share_light(const struct light_list *list, size_t first, size_t end,
                        const struct sums *whole, double light)
{
    if (end - first == 1) {
        list->importance[list->order[first]] = (float)light;
        return;
    }
    size_t middle = first + (end - first) / 2;
    struct sums front = sums_of(list, first, middle), back = sums_of(list, middle, end);
    share_light(list, first, middle, &front, light * part_of(&front, whole));
    share_light(list, middle, end, &back, light * part_of(&back, whole));
}

/* To five bits. Processors round differently, so that a path of the pilot or two go another way;
 * light paths should begin at the same places of the same lights all the same. */
static float rounded(double share)
{
    int exponent;
    double fraction = frexp(share, &exponent);
    return (float)ldexp(round(fraction * 0x1p5), exponent - 5);
}

void light_shares(const uint32_t *order, const float *powers, const struct found_light *found,
                  size_t count, float *shares)
{
    const struct light_list list = {order, powers, found, shares};
    struct sums whole = sums_of(&list, 0, count);
    double sum = 0.0;
    share_light(&list, 0, count, &whole, 1.0);
    for (size_t i = 0; i < count; i++) {
        shares[i] = sqrtf(shares[i] * powers[i]);
        sum += (double)shares[i];
    }
    for (size_t i = 0; i < count && whole.power > 0.0; i++) {
        double by_light = sum > 0.0 ? (double)shares[i] / sum : 0.0;
        double by_power = (double)powers[i] / whole.power;
        shares[i] = rounded((1.0 - BY_POWER) * by_light + BY_POWER * by_power);
    }
}
