/* preview.h: --preview: a quick look, as the options that it stands for.
 *
 * One pass of few light paths with large splats and coarse maps: noise and small shadows are given up,
 * the light's amount and colour are not. What is given besides --preview goes before it.
 */
#ifndef CLI_PREVIEW_H
#define CLI_PREVIEW_H

#include "cli/command.h"

/* The picture is made no larger than that, in its own proportions, unless its size is given. */
#define PREVIEW_WIDTH 640
#define PREVIEW_HEIGHT 360

/* The arguments, and before them those that --preview stands for, if it is among them. NULL, printed,
 * when out of memory; the caller frees it. */
struct argument *preview_expand(const struct argument *arguments, size_t count,
                                size_t *expanded_count);

#endif
