/* image.c: the picture in memory: named planes of floats and string attributes. */
#include "image/image.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

void image_release(struct image *image)
{
    for (size_t i = 0; i < image->channel_count; i++) {
        free(image->channels[i].name);
        free(image->channels[i].samples);
    }
    for (size_t i = 0; i < image->attribute_count; i++) {
        free(image->attributes[i].name);
        free(image->attributes[i].value);
    }
    free(image->channels);
    free(image->attributes);
    *image = (struct image){0};
}

/* Whether there was memory; if not, the samples are not the picture's. */
static bool append_channel(struct image *image, const char *name, float *samples)
{
    struct image_channel *channels =
        realloc(image->channels, (image->channel_count + 1) * sizeof *channels);
    if (!channels)
        return false;
    image->channels = channels;
    struct image_channel channel = {.name = strdup(name), .samples = samples};
    if (!channel.name)
        return false;
    channels[image->channel_count++] = channel;
    return true;
}

float *image_add_channel(struct image *image, const char *name)
{
    if (image->width == 0 || image->height == 0 || image->width > SIZE_MAX / image->height)
        return NULL;
    float *samples = calloc(image->width * image->height, sizeof *samples);
    if (samples && append_channel(image, name, samples))
        return samples;
    free(samples);
    return NULL;
}

ps_result image_adopt_channel(struct image *image, const char *name, float *samples,
                              struct error *error)
{
    if (append_channel(image, name, samples))
        return PS_OK;
    return error_memory(error, (image->channel_count + 1) * sizeof *image->channels,
                        "a channel of a picture");
}

void image_keep_channels(struct image *image, bool (*keeps)(const void *user, const char *name),
                         const void *user)
{
    size_t kept = 0;
    for (size_t i = 0; i < image->channel_count; i++) {
        struct image_channel channel = image->channels[i];
        if (keeps(user, channel.name)) {
            image->channels[kept++] = channel;
        } else {
            free(channel.name);
            free(channel.samples);
        }
    }
    image->channel_count = kept;
}

void image_crop_plane(float *samples, size_t width, struct rectangle part)
{
    for (size_t y = 0; y < part.height; y++)
        memmove(samples + y * part.width, samples + (part.y + y) * width + part.x,
                part.width * sizeof *samples);
}

void image_crop(struct image *image, struct rectangle part)
{
    assert(rectangle_fits(part, image->width, image->height));
    for (size_t c = 0; c < image->channel_count; c++)
        image_crop_plane(image->channels[c].samples, image->width, part);
    if (image->window.picture_width == 0)
        image->window = (struct picture_window){0, 0, image->width, image->height};
    image->window.left += part.x;
    image->window.top += part.y;
    image->width = part.width;
    image->height = part.height;
}

static struct image_attribute *find_attribute(const struct image *image, const char *name)
{
    for (size_t i = 0; i < image->attribute_count; i++) {
        if (strcmp(image->attributes[i].name, name) == 0)
            return &image->attributes[i];
    }
    return NULL;
}

static struct image_attribute *append_attribute(struct image *image, const char *name)
{
    struct image_attribute *attributes =
        realloc(image->attributes, (image->attribute_count + 1) * sizeof *attributes);
    if (!attributes)
        return NULL;
    image->attributes = attributes;
    struct image_attribute *attribute = &attributes[image->attribute_count];
    *attribute = (struct image_attribute){.name = strdup(name)};
    if (!attribute->name)
        return NULL;
    image->attribute_count++;
    return attribute;
}

ps_result image_set_attribute(struct image *image, const char *name, const char *value,
                              struct error *error)
{
    char *copy = strdup(value);
    struct image_attribute *attribute = copy ? find_attribute(image, name) : NULL;
    if (copy && !attribute)
        attribute = append_attribute(image, name);
    if (!attribute) {
        free(copy);
        return error_memory(error, strlen(name) + strlen(value) + 2, "an attribute of a picture");
    }
    free(attribute->value);
    attribute->value = copy;
    return PS_OK;
}

const float *image_channel(const struct image *image, const char *name)
{
    for (size_t i = 0; i < image->channel_count; i++) {
        if (strcmp(image->channels[i].name, name) == 0)
            return image->channels[i].samples;
    }
    return NULL;
}

const char *image_attribute(const struct image *image, const char *name)
{
    const struct image_attribute *attribute = find_attribute(image, name);
    return attribute ? attribute->value : NULL;
}
