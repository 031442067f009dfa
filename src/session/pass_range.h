/* pass_range.h: which passes of a render are asked for (--passes). */
#ifndef SESSION_PASS_RANGE_H
#define SESSION_PASS_RANGE_H

#include "base/error.h"
#include <stdbool.h>

#define MOST_PASSES 1000000

/* Zeroed: those that the scene says. */
struct pass_range {
    bool is_given;
    bool is_shard; /* part of a render, "A:B" */
    uint32_t first, end;
};

/* Reads "N", the first N, or "A:B", from A to before B. PS_ERROR_INVALID. */
ps_result pass_range_parse(const char *text, struct pass_range *range, struct error *error);

#endif
