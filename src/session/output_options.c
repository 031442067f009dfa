#include "session/output_options.h"

#include "session/layers.h"
#include "session/word_list.h"
#include <stdlib.h>
#include <string.h>

bool output_options_has(const char *name)
{
    return strcmp(name, "layers") == 0 || strcmp(name, "compression") == 0;
}

static ps_result parse_compression(const char *name, enum image_compression *compression,
                                   struct error *error)
{
    if (image_compression_named(name, compression))
        return PS_OK;
    return error_set(error, PS_ERROR_INVALID,
                     "--compression: expected one of " IMAGE_COMPRESSIONS ", got '%.500s'", name);
}

ps_result output_options_set(struct output_options *options, const char *name, const char *value,
                             struct error *error)
{
    if (strcmp(name, "compression") == 0)
        return parse_compression(value, &options->compression, error);
    ps_result result = layers_check(value, error);
    return result == PS_OK ? word_replace(&options->layers, value, error) : result;
}

const char *output_options_layers(const struct output_options *options)
{
    return options->layers ? options->layers : "all";
}

void output_options_release(struct output_options *options)
{
    free(options->layers);
    *options = (struct output_options){0};
}
