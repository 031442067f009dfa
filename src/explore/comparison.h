/* comparison.h: how much one shown picture differs from another: numbers, and where. */
#ifndef EXPLORE_COMPARISON_H
#define EXPLORE_COMPARISON_H

#include "explore/shown_picture.h"

/* All compare two pictures of one size by a layer that both have, whose samples are finite.
 * Otherwise PS_ERROR_INVALID, with why. */

/* Writes a list of {"name", "value", "unit"} of all metrics (compare/metric.h), with null for what
 * is not defined. */
ps_result comparison_write(const struct shown_picture *test, const struct shown_picture *reference,
                           const char *layer, struct json_writer *writer, struct error *error);

/* A picture of one channel, `difference` or `flip` by the metric of that name, which the caller
 * frees: FLIP's error, or the largest difference among the channels. */
ps_result comparison_map(const struct shown_picture *test, const struct shown_picture *reference,
                         const char *layer, const char *metric, float **map, struct error *error);

#endif
