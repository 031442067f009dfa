/* output_options.h: how a picture is written to files: which layers EXR files hold, and their
 * compression. */
#ifndef SESSION_OUTPUT_OPTIONS_H
#define SESSION_OUTPUT_OPTIONS_H

#include "image/image.h"

/* Zeroed: all layers, zip. */
struct output_options {
    char *layers; /* a list of layers.h, owned; NULL: all */
    enum image_compression compression;
};

/* Whether it is the name of an option, `layers` or `compression`. */
bool output_options_has(const char *name);

/* Gives it a value, which is copied. PS_ERROR_INVALID. */
ps_result output_options_set(struct output_options *options, const char *name, const char *value,
                             struct error *error);

/* The list of layers. */
const char *output_options_layers(const struct output_options *options);

void output_options_release(struct output_options *options);

#endif
