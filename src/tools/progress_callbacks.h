/* progress_callbacks.h: what a render tells, shown by progress.h. */
#ifndef TOOLS_PROGRESS_CALLBACKS_H
#define TOOLS_PROGRESS_CALLBACKS_H

#include "cli/progress.h"
#include "pipeline/render.h"

/* Warnings are shown, too. Nothing interrupts the render. `progress` must outlive them. */
struct render_callbacks progress_callbacks(struct progress *progress);

#endif
