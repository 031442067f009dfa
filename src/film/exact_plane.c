#include "film/exact_plane.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define RUN 256 /* sums at a time */

/* Adding and subtracting it rounds what is smaller than COARSE to a multiple of 2^-48; larger
 * floats are such multiples. */
#define ROUNDER 24.0 /* 1.5 * 2^(52 - 48) */
#define COARSE 8.0

/* Touched by one thread, as those of the film (film.c). */
static double *zeros(size_t size)
{
    double *sums = malloc(size * sizeof *sums);
    if (sums)
        memset(sums, 0, size * sizeof *sums);
    return sums;
}

bool exact_plane_create(size_t size, struct exact_plane *plane)
{
    *plane = (struct exact_plane){.size = size, .high = zeros(size)};
    return plane->high != NULL;
}

void exact_plane_release(struct exact_plane *plane)
{
    free(plane->high);
    free(plane->low);
    *plane = (struct exact_plane){.high = NULL};
}

void exact_plane_clear(struct exact_plane *plane)
{
    if (plane->high)
        memset(plane->high, 0, plane->size * sizeof *plane->high);
    free(plane->low);
    plane->low = NULL;
}

size_t exact_plane_bytes(const struct exact_plane *plane)
{
    return plane->size * sizeof(double) * ((plane->high != NULL) + (plane->low != NULL));
}

/* a + b, of which *rest is what rounding leaves (TwoSum). */
static inline double two_sum(double a, double b, double *rest)
{
    double sum = a + b, b_in_sum = sum - a;
    double error = (a - (sum - b_in_sum)) + (b - b_in_sum);
    *rest = fabs(sum) < INFINITY ? error : 0.0;
    return sum;
}

/* Adds n doubles; whether any sum needs its low part. */
static bool add_high(double *high, const double *values, double *rests, size_t n)
{
    int inexact = 0;
#pragma omp simd reduction(| : inexact)
    for (size_t i = 0; i < n; i++) {
        high[i] = two_sum(high[i], values[i], &rests[i]);
        inexact |= rests[i] != 0.0;
    }
    return inexact;
}

static void add_low(double *high, double *low, const double *rests, size_t n)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++)
        high[i] = two_sum(high[i], low[i] + rests[i], &low[i]);
}

static bool add_run(struct exact_plane *plane, size_t first, const double *values, size_t n)
{
    double rests[RUN];
    bool inexact = add_high(plane->high + first, values, rests, n);
    if (inexact && !plane->low)
        plane->low = zeros(plane->size);
    if (inexact && !plane->low)
        return false;
    if (plane->low)
        add_low(plane->high + first, plane->low + first, rests, n);
    return true;
}

static size_t run_at(const struct exact_plane *plane, size_t first)
{
    return plane->size - first < RUN ? plane->size - first : RUN;
}

static void round_values(const float *values, double *rounded, size_t n)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++) {
        double value = (double)values[i], coarse = (value + ROUNDER) - ROUNDER;
        rounded[i] = fabs(value) < COARSE ? coarse : value;
    }
}

bool exact_plane_add(struct exact_plane *plane, const float *values)
{
    double run[RUN];
    bool there = true;
    for (size_t first = 0; first < plane->size && there; first += RUN) {
        size_t n = run_at(plane, first);
        round_values(values + first, run, n);
        there = add_run(plane, first, run, n);
    }
    return there;
}

bool exact_plane_merge(struct exact_plane *plane, const struct exact_plane *other)
{
    bool there = true;
    for (size_t first = 0; first < plane->size && there; first += RUN) {
        size_t n = run_at(plane, first);
        there = add_run(plane, first, other->high + first, n) &&
                (!other->low || add_run(plane, first, other->low + first, n));
    }
    return there;
}

void exact_plane_round(const struct exact_plane *plane, float *sums)
{
    for (size_t i = 0; i < plane->size; i++)
        sums[i] = (float)plane->high[i];
}

bool exact_plane_term(const struct exact_plane *plane, int term, float *terms)
{
    bool any = false;
    for (size_t i = 0; i < plane->size; i++) {
        double high = plane->high[i], low = plane->low ? plane->low[i] : 0.0;
        terms[i] = (float)high;
        for (int k = 0; k < term; k++) {
            high = fabsf(terms[i]) < INFINITY ? two_sum(high - (double)terms[i], low, &low) : 0.0;
            terms[i] = (float)high;
        }
        any |= terms[i] != 0.0f;
    }
    return any;
}
