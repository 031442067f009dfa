/* layers.h: which of a rendered picture's layers go into its EXR files (render --layers).
 *
 * A list is `none`, or names with commas between them, among which `all` stands for every layer but `display`. The
 * picture itself, R, G and B, always stays.
 */
#ifndef CLI_LAYERS_H
#define CLI_LAYERS_H

#include "image/image.h"
#include <stdbool.h>

/* Whether it is a list of layers that pictures have; if not, says so on stderr. */
bool layers_check(const char *list);

/* Whether a list has that name; `all` is a name as the others. */
bool layers_name(const char *list, const char *layer);

/* Takes what the list, checked before, does not name out of a picture. */
void layers_keep(struct image *image, const char *list);

#endif
