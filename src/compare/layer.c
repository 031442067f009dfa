#include "compare/layer.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static const char components[][3] = {
    [LAYER_COLOUR] = {'R', 'G', 'B'}, [LAYER_VECTOR] = {'X', 'Y', 'Z'}};

/* Whether `channel` is PREFIX.COMPONENT, or just the component where the prefix is empty. */
static bool is_component(const char *channel, const char *prefix, size_t prefix_length,
                         char component)
{
    size_t start = prefix_length > 0 ? prefix_length + 1 : 0;
    return strlen(channel) == start + 1 && strncmp(channel, prefix, prefix_length) == 0 &&
           (start == 0 || channel[prefix_length] == '.') && channel[start] == component;
}

static bool find_triple(const struct image *image, const char *prefix, size_t prefix_length,
                        enum layer_kind kind, struct layer *layer)
{
    *layer = (struct layer){.kind = kind};
    for (size_t c = 0; c < 3; c++)
        for (size_t i = 0; i < image->channel_count && !layer->names[c]; i++)
            if (is_component(image->channels[i].name, prefix, prefix_length, components[kind][c])) {
                layer->names[c] = image->channels[i].name;
                layer->planes[c] = image->channels[i].samples;
                layer->channel_count++;
            }
    return layer->channel_count == 3;
}

static bool find_single(const struct image *image, const char *name, struct layer *layer)
{
    *layer = (struct layer){.kind = LAYER_SINGLE, .channel_count = 1};
    for (size_t i = 0; i < image->channel_count; i++)
        if (strcmp(image->channels[i].name, name) == 0) {
            layer->names[0] = image->channels[i].name;
            layer->planes[0] = image->channels[i].samples;
            return true;
        }
    return false;
}

/* The layer's name as --layer takes it, or NULL where an earlier channel has named the layer. */
static const char *name_of_channel(const struct image *image, const char *channel, int *length)
{
    const char *dot = strrchr(channel, '.');
    size_t prefix_length = dot ? (size_t)(dot - channel) : 0;
    *length = (int)strlen(channel);
    for (enum layer_kind kind = LAYER_COLOUR; kind <= LAYER_VECTOR; kind++) {
        struct layer layer;
        if (!find_triple(image, channel, prefix_length, kind, &layer))
            continue;
        if (channel == layer.names[0]) {
            *length = (int)prefix_length;
            return dot ? channel : "";
        }
        if (channel == layer.names[1] || channel == layer.names[2])
            return NULL;
    }
    return channel;
}

static void list_layers(const struct image *image, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (size_t i = 0; i < image->channel_count && used < size; i++) {
        int length;
        const char *name = name_of_channel(image, image->channels[i].name, &length);
        if (!name)
            continue;
        const char *separator = used > 0 ? ", " : "";
        if (length == 0)
            used +=
                (size_t)snprintf(text + used, size - used, "%sR,G,B (without --layer)", separator);
        else
            used += (size_t)snprintf(text + used, size - used, "%s%.*s", separator, length, name);
    }
}

ps_result layer_find(const struct image *image, const char *path, const char *name,
                     struct layer *layer, struct error *error)
{
    if (!name && find_triple(image, "", 0, LAYER_COLOUR, layer))
        return PS_OK;
    if (name && name[0])
        if (find_triple(image, name, strlen(name), LAYER_COLOUR, layer) ||
            find_triple(image, name, strlen(name), LAYER_VECTOR, layer) ||
            find_single(image, name, layer))
            return PS_OK;
    char list[600];
    list_layers(image, list, sizeof list);
    if (!name)
        return error_set(error, PS_ERROR_INVALID,
                         "'%s' has no channels R, G, B: choose with --layer from: %s", path, list);
    return error_set(error, PS_ERROR_INVALID, "'%s' has no layer '%s': there are: %s", path, name,
                     list);
}
