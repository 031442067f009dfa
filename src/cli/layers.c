#include "cli/layers.h"

#include "pipeline/render.h"
#include <stdio.h>
#include <string.h>

/* The part of a list up to its next comma, past which `list` moves; 0 at the end. */
static size_t next_name(const char **list, const char **name)
{
    *name = *list;
    size_t length = strcspn(*list, ",");
    *list += length + ((*list)[length] == ',');
    return length;
}

bool layers_check(const char *list)
{
    const char *rest = list, *name;
    if (strcmp(list, "none") == 0)
        return true;
    do {
        size_t length = next_name(&rest, &name);
        bool is_all = length == 3 && strncmp(name, "all", length) == 0;
        if (!is_all && !render_makes_layer(name, length)) {
            fprintf(stderr,
                    "psplat: error: --layers: expected none, or all and names among " RENDER_LAYERS
                    " with commas between them, got '%s'\n",
                    list);
            return false;
        }
    } while (*rest || rest[-1] == ',');
    return true;
}

static bool is_named(const char *list, const char *layer, size_t length)
{
    const char *name;
    while (*list) {
        size_t name_length = next_name(&list, &name);
        if (name_length == length && strncmp(name, layer, length) == 0)
            return true;
    }
    return false;
}

bool layers_name(const char *list, const char *layer)
{
    return is_named(list, layer, strlen(layer));
}

/* Of channel "N.X" the layer is N. */
static bool keeps(const void *list, const char *channel)
{
    size_t length = strcspn(channel, ".");
    bool is_display = strncmp(channel, "display.", length + 1) == 0;
    return !render_makes_layer(channel, length) || is_named(list, channel, length) ||
           (layers_name(list, "all") && !is_display);
}

void layers_keep(struct image *image, const char *list)
{
    image_keep_channels(image, keeps, list);
}
