/* exr_layer.h: layers of OpenEXR files; for src/image alone. */
#ifndef IMAGE_EXR_LAYER_H
#define IMAGE_EXR_LAYER_H

#include <OpenEXR/openexr.h>
#include <stdbool.h>

/* What follows the layer in a channel's name: "R" of "diffuse.R", "" of "Z" in the layer "Z"; NULL:
 * it is of another. Without a layer the whole name. */
const char *exr_layer_suffix(const char *layer, const char *channel);

/* Whether a channel is a part of the layer's picture, or, where the layer is NULL, of the file's;
 * `is_part`: names are without the layer's. */
bool exr_layer_wants(const char *layer, bool is_part, const char *channel);

/* Names of layers and of parts, with commas between them, as many as there is room for. */
void exr_layer_list(exr_const_context_t context, char *text, size_t size);

#endif
