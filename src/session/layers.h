/* layers.h: which of a rendered picture's layers go into its EXR files (render --layers).
 *
 * A list is `none`, or names with commas between them, among which `all` stands for every layer but
 * `display`. The picture itself, R, G and B, always stays.
 */
#ifndef SESSION_LAYERS_H
#define SESSION_LAYERS_H

#include "image/image.h"
#include "render/settings.h"
#include <stdbool.h>

/* Whether it is a list of layers that pictures have: PS_ERROR_INVALID. */
ps_result layers_check(const char *list, struct error *error);

/* Whether a list has that name; `all` is a name as the others. */
bool layers_contain(const char *list, const char *layer);

/* PS_ERROR_INVALID where the list has the layer `error` and the denoiser does not make it. */
ps_result layers_check_denoiser(const char *list, const struct render_settings *settings,
                                struct error *error);

/* Whether a list, checked before, has any layer; and that which tells the denoiser's error. */
bool layers_any(const char *list);
bool layers_have_error(const char *list);

/* Whether a channel such as "N.X" stays in a picture by the list. */
bool layers_keep(const char *list, const char *channel);

#endif
