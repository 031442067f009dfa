/* exact_plane.h: sums of floats that are the same in whatever order and groups they are added.
 *
 * Floating-point addition is not associative: passes 0 to 3 plus passes 4 to 7 would differ in the
 * last bits from passes 0 to 7. Here each sum is kept as two doubles, of which `high` is the exact
 * sum rounded to a double, and `low` what that leaves: the error-free transformation of Dekker 1971
 * ("A floating-point technique for extending the available precision") and Knuth (TwoSum; The Art
 * of Computer Programming 2, 4.2.2). What is added is rounded to multiples of 2^-48 first, so that
 * two doubles hold any sum below 2^57 without loss; both are functions of the exact sum then. Below
 * 32, `high` does alone, and `low` is not there before a sum needs it. What is no number, or
 * infinite, stays so.
 *
 * A tree of float sums by the numbers of passes would take a film for each of its levels, and tie
 * shards to its branches.
 */
#ifndef FILM_EXACT_PLANE_H
#define FILM_EXACT_PLANE_H

#include <stdbool.h>
#include <stddef.h>

/* Zero-initialise: no sums. One thread at a time. */
struct exact_plane {
    size_t size;
    double *high; /* of each sum; owned */
    double *low;  /* NULL: all are 0 */
};

/* Sums that are 0; false when out of memory. */
bool exact_plane_create(size_t size, struct exact_plane *plane);
void exact_plane_release(struct exact_plane *plane);
void exact_plane_clear(struct exact_plane *plane); /* to sums that are 0 */
size_t exact_plane_bytes(const struct exact_plane *plane);

/* Adds a value to each sum. False when out of memory: the sums are lost. */
bool exact_plane_add(struct exact_plane *plane, const float *values);

/* Adds the sums of another plane of that size; likewise. */
bool exact_plane_merge(struct exact_plane *plane, const struct exact_plane *other);

/* The sums, rounded to floats. */
void exact_plane_round(const struct exact_plane *plane, float *sums);

/* Term number `term` of each sum's expansion into floats, which add up to it: the sum rounded to a
 * float, what that leaves rounded to a float, and so on. False, and zeros, where no sum has such a
 * term. */
bool exact_plane_term(const struct exact_plane *plane, int term, float *terms);

#endif
