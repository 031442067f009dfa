#include "allocation.h"

#define BLOCK 4
#define BLOCKS (PS_TILE_PIXELS / (BLOCK * BLOCK))
#define DARK                                                                                       \
    0.3f /* of the picture's brightness: where darker, the error counts as if it were so bright */
#define LEAST 0.01f /* of the noise, that counts as variation */
#define STEPS 60    /* of the bisection */

static uint32_t block_of(uint32_t lane)
{
    return lane / PS_TILE_SIZE / BLOCK * (PS_TILE_SIZE / BLOCK) + lane % PS_TILE_SIZE / BLOCK;
}

/* Variance of the means of blocks, each of which counts by its points, less that of the noise in
 * them. */
static float variation_of(const float sums[BLOCKS], const uint32_t counts[BLOCKS], float mean,
                          float noise, size_t points)
{
    float sum = 0.0f, blocks = 0.0f;
    for (uint32_t i = 0; i < BLOCKS; i++) {
        if (counts[i] == 0)
            continue;
        float off = sums[i] / (float)counts[i] - mean;
        sum += (float)counts[i] * off * off;
        blocks += 1.0f;
    }
    return ps_max((sum - blocks * noise) / (float)points, 0.0f);
}

struct tile_pilot tile_pilot(const uint32_t *lanes, const float *found, const float *half,
                             size_t count)
{
    float sums[BLOCKS] = {0}, sum = 0.0f, noise = 0.0f;
    uint32_t counts[BLOCKS] = {0};
    if (count == 0)
        return (struct tile_pilot){0};
    for (size_t i = 0; i < count; i++) {
        uint32_t block = block_of(lanes[i]);
        float off = half[i] - found[i];
        sums[block] += found[i];
        counts[block]++;
        sum += found[i];
        noise += off * off;
    }
    float mean = sum / (float)count;
    noise /= (float)count;
    return (struct tile_pilot){
        .points = (uint32_t)count,
        .brightness = mean,
        .noise = noise,
        .variation = variation_of(sums, counts, mean, noise, count),
    };
}

static float mean_brightness(const struct tile_pilot *pilots, size_t n)
{
    double sum = 0.0, points = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += (double)pilots[i].points * (double)pilots[i].brightness;
        points += (double)pilots[i].points;
    }
    return points > 0.0 ? (float)(sum / points) : 0.0f;
}

static float error_of(const struct tile_pilot *pilot, float brightness)
{
    float bends = sqrtf(pilot->variation + LEAST * pilot->noise);
    float scale = pilot->brightness + DARK * brightness;
    return scale > 0.0f ? cbrtf(pilot->noise * bends) / sqrtf(scale) : 0.0f;
}

static uint64_t samples_by(const struct allocation *allocation, float error)
{
    const struct allocation_limits *limits = &allocation->limits;
    double wanted = allocation->scale * (double)error, most = (double)limits->most;
    uint64_t samples = (uint64_t)(wanted < most ? wanted : most);
    return samples > limits->least ? samples : limits->least;
}

/* Samples after the first round, of n tiles in all. */
static double cost_of(const struct allocation *allocation, const struct tile_pilot *pilots,
                      size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++)
        sum += (double)pilots[i].factors *
               (double)(samples_by(allocation, pilots[i].error) - allocation->limits.first);
    return sum;
}

struct allocation allocation_for(const struct allocation_limits *limits, struct tile_pilot *pilots,
                                 size_t n)
{
    struct allocation allocation = {.limits = *limits, .brightness = mean_brightness(pilots, n)};
    float largest = 0.0f;
    double points = 0.0;
    for (size_t i = 0; i < n; i++) {
        pilots[i].error = error_of(&pilots[i], allocation.brightness);
        largest = ps_max(largest, pilots[i].error);
        points += (double)pilots[i].points;
    }
    if (!(largest > 0.0f))
        allocation.limits.least = limits->samples;
    double low = 0.0, high = largest > 0.0f ? 1e6 * (double)limits->most / (double)largest : 0.0;
    double budget = points * (double)(limits->samples - limits->first);
    for (int step = 0; step < STEPS; step++) {
        allocation.scale = 0.5 * (low + high);
        if (cost_of(&allocation, pilots, n) > budget)
            high = allocation.scale;
        else
            low = allocation.scale;
    }
    allocation.scale = low;
    return allocation;
}

uint32_t allocated_samples(const struct allocation *allocation, const struct tile_pilot *pilot)
{
    return (uint32_t)samples_by(allocation, error_of(pilot, allocation->brightness));
}
