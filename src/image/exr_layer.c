/* exr_layer.c: which channels of an OpenEXR file make up a layer.
 *
 * By the format's convention ("Technical introduction to OpenEXR", on layers) a channel's name is
 * that of its layer, a dot and the channel's own: "diffuse.R". In a file of several parts the layer
 * may also be a part's name, in which channels bear their own names alone. Without a layer the
 * picture is what the plain names R, G, B, Y and A say.
 */
#include "image/exr_layer.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

const char *exr_layer_suffix(const char *layer, const char *channel)
{
    size_t length = layer ? strlen(layer) : 0;
    if (!layer)
        return channel;
    if (strncmp(channel, layer, length) != 0)
        return NULL;
    if (channel[length] == '\0')
        return channel + length;
    return channel[length] == '.' ? channel + length + 1 : NULL;
}

bool exr_layer_wants(const char *layer, bool is_part, const char *channel)
{
    static const char *const of_picture[] = {"A", "B", "G", "R", "Y", NULL};
    static const char *const of_layer[] = {"A", "B", "G", "R", "V", "X", "Y", "Z", "", NULL};
    const char *suffix = exr_layer_suffix(is_part ? NULL : layer, channel);
    const char *const *known = layer ? of_layer : of_picture;
    while (suffix && *known && strcmp(*known, suffix) != 0)
        known++;
    return suffix && *known;
}

/* --- what there is, for messages
 * ------------------------------------------------------------------ */

struct listing {
    char *text;
    size_t size, used;
    bool full;
};

static void add_name(struct listing *listing, const char *name, size_t length)
{
    int printed = listing->full
                      ? 0
                      : snprintf(listing->text + listing->used, listing->size - listing->used,
                                 "%s%.*s", listing->used > 0 ? ", " : "", (int)length, name);
    if (printed < 0 || (size_t)printed >= listing->size - listing->used) {
        listing->text[listing->used] = '\0';
        listing->full = true;
        return;
    }
    listing->used += (size_t)printed;
}

/* Channels are sorted, so those of a layer stand together; a channel without a dot is a layer of
 * its own. */
static void add_part(struct listing *listing, exr_const_context_t context, int part, int parts)
{
    const exr_attr_chlist_t *list = NULL;
    const char *part_name = NULL, *before = "";
    size_t before_length = 0;
    if (parts > 1 && exr_get_name(context, part, &part_name) == EXR_ERR_SUCCESS && part_name)
        add_name(listing, part_name, strlen(part_name));
    if (exr_get_channels(context, part, &list) != EXR_ERR_SUCCESS)
        return;
    for (int i = 0; i < list->num_channels; i++) {
        const char *name = list->entries[i].name.str, *dot = strrchr(name, '.');
        size_t length = dot ? (size_t)(dot - name) : strlen(name);
        if (length == before_length && strncmp(name, before, length) == 0)
            continue;
        add_name(listing, name, length);
        before = name;
        before_length = length;
    }
}

void exr_layer_list(exr_const_context_t context, char *text, size_t size)
{
    struct listing listing = {.text = text, .size = size};
    int parts = 0;
    text[0] = '\0';
    if (exr_get_count(context, &parts) != EXR_ERR_SUCCESS)
        return;
    for (int i = 0; i < parts; i++)
        add_part(&listing, context, i, parts);
}
