/* preview.h: --preview: a quick look, as the options that it stands for.
 *
 * One pass of few light paths with large splats and coarse maps: noise and small shadows are given up,
 * the light's amount and colour are not. What is given besides --preview goes before it.
 */
#ifndef CLI_PREVIEW_H
#define CLI_PREVIEW_H

#include "cli/command.h"
#include "scene/description.h"

/* The arguments, and before them those that --preview stands for, if it is among them. NULL, printed,
 * when out of memory; the caller frees it. */
struct argument *preview_expand(const struct argument *arguments, size_t count,
                                size_t *expanded_count);

/* Makes a picture that is larger fit into 640x360 pixels, in its own proportions. */
void preview_shrink(struct image_description *image);

#endif
