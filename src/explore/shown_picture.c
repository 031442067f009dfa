#include "explore/shown_picture.h"

#include "api/handles.h"
#include "base/input_file.h"
#include "image/tonemap.h"
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#define HEADER_BYTES 16

struct shown_picture {
    atomic_uint references;
    uint64_t number;
    psplat_picture *picture; /* owned */
};

struct shown_picture *shown_picture_create(psplat_picture *picture, uint64_t number)
{
    struct shown_picture *shown = calloc(1, sizeof *shown);
    if (!shown) {
        psplat_picture_destroy(picture);
        return NULL;
    }
    atomic_init(&shown->references, 1);
    shown->number = number;
    shown->picture = picture;
    return shown;
}

ps_result shown_picture_read(const char *path, uint64_t number, struct shown_picture **read,
                             struct error *error)
{
    psplat_picture *picture = calloc(1, sizeof *picture);
    *read = NULL;
    if (!picture)
        return error_memory(error, sizeof *picture, "a picture");
    /* Nothing that never ends, or waits for whoever writes. */
    ps_result result = input_file_exists(path, NULL)
                           ? image_read_exr(path, &picture->image, error)
                           : error_set(error, PS_ERROR_IO, "cannot read '%s': it is no file", path);
    if (result != PS_OK) {
        psplat_picture_destroy(picture);
        return result;
    }
    *read = shown_picture_create(picture, number);
    return *read ? PS_OK : error_memory(error, sizeof **read, "a picture");
}

struct shown_picture *shown_picture_keep(struct shown_picture *shown)
{
    if (shown)
        atomic_fetch_add(&shown->references, 1);
    return shown;
}

void shown_picture_release(struct shown_picture *shown)
{
    if (!shown || atomic_fetch_sub(&shown->references, 1) > 1)
        return;
    psplat_picture_destroy(shown->picture);
    free(shown);
}

uint64_t shown_picture_number(const struct shown_picture *shown)
{
    return shown->number;
}

size_t shown_picture_width(const struct shown_picture *shown)
{
    return psplat_picture_width(shown->picture);
}

size_t shown_picture_height(const struct shown_picture *shown)
{
    return psplat_picture_height(shown->picture);
}

/* --- layers
 * ------------------------------------------------------------------------------------------ */

/* How the channels of a colour, or a vector, end. */
static const char *const endings[2][3] = {{"R", "G", "B"}, {"X", "Y", "Z"}};

static bool find_three(const psplat_picture *picture, const char *name, const char *const ends[3],
                       struct shown_layer *layer)
{
    bool is_picture = strcmp(name, "picture") == 0;
    for (size_t c = 0; c < 3; c++) {
        char channel[LAYER_NAME_LENGTH + 3];
        snprintf(channel, sizeof channel, "%s%s%s", is_picture ? "" : name, is_picture ? "" : ".",
                 ends[c]);
        layer->planes[c] = psplat_picture_channel(picture, channel);
        if (!layer->planes[c])
            return false;
    }
    layer->channel_count = 3;
    return true;
}

bool shown_picture_layer(const struct shown_picture *shown, const char *name,
                         struct shown_layer *layer)
{
    if (strlen(name) >= LAYER_NAME_LENGTH)
        return false;
    snprintf(layer->name, sizeof layer->name, "%s", name);
    layer->is_display = strcmp(name, "display") == 0;
    if (find_three(shown->picture, name, endings[0], layer))
        return true;
    if (strcmp(name, "picture") != 0 && find_three(shown->picture, name, endings[1], layer))
        return true;
    layer->channel_count = 1;
    layer->planes[0] = psplat_picture_channel(shown->picture, name);
    return layer->planes[0] != NULL;
}

/* The layer that a channel is the first of; false where it is another's second or third. */
static bool name_of_layer(const char *channel, char name[LAYER_NAME_LENGTH])
{
    const char *dot = strrchr(channel, '.');
    const char *end = dot ? dot + 1 : channel;
    size_t length = dot ? (size_t)(dot - channel) : strlen(channel);
    bool is_colour = strlen(end) == 1 && strchr("RGB", *end);
    bool is_part = is_colour || (dot && strlen(end) == 1 && strchr("XYZ", *end));
    if (length >= LAYER_NAME_LENGTH)
        return false;
    if (!dot && is_colour)
        snprintf(name, LAYER_NAME_LENGTH, "picture");
    else
        snprintf(name, LAYER_NAME_LENGTH, "%.*s", (int)(is_part ? length : strlen(channel)),
                 channel);
    return !is_part || *end == 'R' || *end == 'X';
}

void shown_picture_each_layer(const struct shown_picture *shown,
                              void (*each)(void *user, const struct shown_layer *layer), void *user)
{
    for (size_t i = 0; i < psplat_picture_channel_count(shown->picture); i++) {
        char name[LAYER_NAME_LENGTH];
        struct shown_layer layer;
        if (name_of_layer(psplat_picture_channel_name(shown->picture, i), name) &&
            shown_picture_layer(shown, name, &layer))
            each(user, &layer);
    }
}

/* --- as bytes
 * ---------------------------------------------------------------------------------------- */

size_t shown_layer_bytes(const struct shown_picture *shown, const struct shown_layer *layer)
{
    return HEADER_BYTES + sizeof(float) * layer->channel_count * shown_picture_width(shown) *
                              shown_picture_height(shown);
}

static uint32_t header_word(const struct shown_picture *shown, const struct shown_layer *layer,
                            size_t index)
{
    const uint32_t words[] = {(uint32_t)shown_picture_width(shown),
                              (uint32_t)shown_picture_height(shown), (uint32_t)layer->channel_count,
                              (uint32_t)shown->number};
    return words[index];
}

/* The word of that index, behind the header a sample. */
static uint32_t word_at(const struct shown_picture *shown, const struct shown_layer *layer,
                        size_t index)
{
    size_t header = HEADER_BYTES / sizeof(uint32_t);
    if (index < header)
        return header_word(shown, layer, index);
    size_t sample = index - header;
    float value = layer->planes[sample % layer->channel_count][sample / layer->channel_count];
    if (layer->is_display)
        value = tonemap_srgb(value);
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    return word;
}

size_t shown_layer_read(const struct shown_picture *shown, const struct shown_layer *layer,
                        size_t at, char *bytes, size_t most)
{
    size_t left = shown_layer_bytes(shown, layer) - at;
    size_t count = most < left ? most : left;
    for (size_t i = 0; i < count;) {
        uint32_t word = word_at(shown, layer, (at + i) / sizeof word);
        for (size_t byte = (at + i) % sizeof word; byte < sizeof word && i < count; byte++)
            bytes[i++] = (char)(word >> 8 * byte & 0xff);
    }
    return count;
}
