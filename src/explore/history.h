/* history.h: how far a view's pictures were from the reference as passes went on.
 *
 * References get better, and come late; so the pictures of 1, 2, 4, 8, ... passes and the newest
 * are kept, to be measured anew. What is kept is the layer that is measured, and of large pictures
 * every n-th row.
 */
#ifndef EXPLORE_HISTORY_H
#define EXPLORE_HISTORY_H

#include "explore/shown_picture.h"

/* A picture's indirect light, or all of it where it has no such layer. Shared by counting
 * references. */
struct picture_sample;

/* NULL when out of memory, or where it has neither. */
struct picture_sample *picture_sample_create(const struct shown_picture *shown);
struct picture_sample *picture_sample_keep(struct picture_sample *sample);
void picture_sample_release(struct picture_sample *sample); /* NULL is nothing */

/* rel_rmse (compare/metric.h); NAN where they can't be compared: sizes or layers differ, say. */
double picture_sample_error(const struct picture_sample *test,
                            const struct picture_sample *reference);

#define HISTORY_POINTS 40 /* powers of two, and one */

struct history_point {
    uint32_t passes;
    double cpu_seconds;            /* that these took */
    double error;                  /* against the reference; NAN: not measured */
    struct picture_sample *sample; /* one reference */
};

/* Zeroed: empty. */
struct history {
    struct history_point points[HISTORY_POINTS];
    size_t count;
};

/* Adds the newest picture, in the place of the one before if that was not one to be kept. Takes the
 * sample over. */
void history_add(struct history *history, uint32_t passes, double cpu_seconds,
                 struct picture_sample *sample);

void history_clear(struct history *history);

/* A copy that shares the samples; to be cleared. */
struct history history_copy(const struct history *history);

/* Measures the points that were not yet, or all. */
void history_measure(struct history *history, const struct picture_sample *reference, bool anew);

/* As if none was measured. */
void history_forget_errors(struct history *history);

/* Takes over what was measured in a copy, for those points that are still there. */
void history_take_errors(struct history *history, const struct history *measured);

/* Writes a list of {"passes", "cpu_seconds", "error"} of what was measured. */
void history_write(const struct history *history, struct json_writer *writer);

#endif
