/* flip.c: both pipelines over both pictures, and their combination. */
#include "compare/flip.h"

#include <math.h>
#include <stdlib.h>

/* What FLIP knows of one picture. */
struct percept {
    double *colour[3];
    double *features[2]; /* edges, points */
};

/* Linear values: the display's encoding, which clips them, and the decoding that FLIP begins with
 * cancel but for the clipping. */
static void fill_xyz(float *const planes[3], size_t channel_count, size_t pixels,
                     double *const xyz_planes[3])
{
    for (size_t i = 0; i < pixels; i++) {
        double rgb[3], xyz[3];
        for (size_t c = 0; c < 3; c++)
            rgb[c] = fmin(fmax((double)planes[channel_count == 1 ? 0 : c][i], 0.0), 1.0);
        flip_xyz_from_rgb(rgb, xyz);
        for (size_t c = 0; c < 3; c++)
            xyz_planes[c][i] = xyz[c];
    }
}

static void perceive(const struct picture_pair *pair, float *const planes[3],
                     const struct percept *percept, double *const scratch[FLIP_SCRATCH_PLANES])
{
    fill_xyz(planes, pair->channel_count, pair->width * pair->height, percept->colour);
    flip_features(percept->colour[1], pair->width, pair->height, percept->features[0],
                  percept->features[1], scratch, pair->workers);
    flip_colour_perceived(percept->colour, pair->width, pair->height, scratch, pair->workers);
}

static double pixel_error(const struct percept percepts[2], size_t pixel, double largest_distance)
{
    double colours[2][3], features[2][2];
    for (int i = 0; i < 2; i++) {
        for (int c = 0; c < 3; c++)
            colours[i][c] = percepts[i].colour[c][pixel];
        for (int f = 0; f < 2; f++)
            features[i][f] = percepts[i].features[f][pixel];
    }
    return pow(flip_colour_difference(colours[0], colours[1], largest_distance),
               1.0 - flip_feature_difference(features[0], features[1]));
}

/* Both pictures' percepts, and scratch, in one piece of memory. */
struct percepts {
    double *memory; /* owned */
    struct percept of[2];
    double *scratch[FLIP_SCRATCH_PLANES];
};

/* False when out of memory. */
static bool percepts_create(const struct picture_pair *pair, struct percepts *percepts,
                            struct error *error)
{
    size_t pixels = pair->width * pair->height;
    size_t bytes = (2 * (3 + 2) + FLIP_SCRATCH_PLANES) * pixels * sizeof(double);
    double *next = percepts->memory = malloc(bytes);
    if (!next) {
        error_memory(error, bytes, "FLIP");
        return false;
    }
    for (int i = 0; i < 2; i++) {
        for (int c = 0; c < 3; c++, next += pixels)
            percepts->of[i].colour[c] = next;
        for (int f = 0; f < 2; f++, next += pixels)
            percepts->of[i].features[f] = next;
    }
    for (int i = 0; i < FLIP_SCRATCH_PLANES; i++, next += pixels)
        percepts->scratch[i] = next;
    perceive(pair, pair->reference, &percepts->of[0], percepts->scratch);
    perceive(pair, pair->test, &percepts->of[1], percepts->scratch);
    return true;
}

ps_result flip_mean(const struct picture_pair *pair, double *number, struct error *error)
{
    struct percepts percepts;
    if (!percepts_create(pair, &percepts, error))
        return PS_ERROR_MEMORY;
    size_t pixels = pair->width * pair->height;
    double sum = 0.0, largest_distance = flip_colour_largest_distance();
    for (size_t i = 0; i < pixels; i++)
        sum += pixel_error(percepts.of, i, largest_distance);
    *number = sum / (double)pixels;
    free(percepts.memory);
    return PS_OK;
}

ps_result flip_map(const struct picture_pair *pair, float *map, struct error *error)
{
    struct percepts percepts;
    if (!percepts_create(pair, &percepts, error))
        return PS_ERROR_MEMORY;
    double largest_distance = flip_colour_largest_distance();
    for (size_t i = 0; i < pair->width * pair->height; i++)
        map[i] = (float)pixel_error(percepts.of, i, largest_distance);
    free(percepts.memory);
    return PS_OK;
}
