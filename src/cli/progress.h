/* progress.h: tells how far a render is: a bar where stderr is a terminal, plain lines elsewhere.
 */
#ifndef CLI_PROGRESS_H
#define CLI_PROGRESS_H

#include "pipeline/render.h"
#include <stdbool.h>

struct progress {
    bool quiet, terminal;
    double start;       /* seconds */
    double next_update; /* seconds; a bar is not drawn anew before */
    int last_tenth;     /* of plain lines */
    char stage[32];
};

void progress_start(struct progress *progress, bool quiet);
void progress_update(struct progress *progress, const char *stage, double fraction);

/* A message of the render or a plugin. */
void progress_message(const struct progress *progress, ps_log_level level, const char *message);

/* What a render tells, shown; warnings too. Nothing interrupts it. `progress` must outlive them. */
struct render_callbacks progress_callbacks(struct progress *progress);

/* Removes the bar, so that other lines can be printed. */
void progress_clear(struct progress *progress);

#endif
