/* preview.h: the option --preview: the options that it sets.
 *
 * One pass of few light paths with large splats and coarse maps: noise and small shadows are given
 * up, the light's amount and colour are not.
 */
#ifndef SESSION_PREVIEW_H
#define SESSION_PREVIEW_H

#include "session/render_options.h"

/* Sets those options, except where the user gave a value. */
ps_result preview_apply(struct render_options *options, struct error *error);

/* Makes a picture that is larger fit into 640x360 pixels, in its own proportions. */
void preview_shrink(struct image_description *image);

#endif
