/* raster_exr.c: the colours of an OpenEXR picture, or of one of its layers.
 *
 * Most files hold half floats, which the
 * reader widens; they are stored as half floats again where that loses nothing. The picture is the display window, as
 * viewers show it, and its colours are made Rec.709's.
 */
#include "image/exr_layer.h"
#include "image/half.h"
#include "image/raster_decode.h"

#include <math.h>
#include <string.h>

#define CHANNELS_AT_MOST 4
#define DISPLAY_TO_DATA 16

/* The planes that make up the picture, in the raster's order. */
struct planes {
    float *samples[CHANNELS_AT_MOST];
    uint32_t count;
    bool colored; /* they are red, green and blue */
};

/* Where to look for them. */
struct layer {
    const struct image *image;
    const char *prefix; /* of names of channels, or NULL */
    bool is_whole;      /* the file's own picture */
};

static void add_plane(struct planes *planes, float *samples)
{
    if (samples)
        planes->samples[planes->count++] = samples;
}

static float *plane_of(const struct layer *layer, const char *name)
{
    for (size_t i = 0; i < layer->image->channel_count; i++) {
        const char *suffix = exr_layer_suffix(layer->prefix, layer->image->channels[i].name);
        if (suffix && strcmp(suffix, name) == 0)
            return layer->image->channels[i].samples;
    }
    return NULL;
}

static bool add_three(struct planes *planes, const struct layer *layer, const char *const names[3])
{
    float *found[3];
    for (int i = 0; i < 3; i++)
        found[i] = plane_of(layer, names[i]);
    bool all = found[0] && found[1] && found[2];
    for (int i = 0; i < 3 && all; i++)
        add_plane(planes, found[i]);
    return all;
}

/* Colours, or a vector's coordinates, or else one number. */
static bool choose_planes(const struct layer *layer, struct planes *planes)
{
    static const char *const rgb[] = {"R", "G", "B"}, *const xyz[] = {"X", "Y", "Z"};
    static const char *const numbers[] = {"Y", "V", "Z", "X", "R", "G", "B", ""};
    *planes = (struct planes){.count = 0};
    planes->colored = add_three(planes, layer, rgb);
    size_t tried = layer->is_whole ? 1 : sizeof numbers / sizeof *numbers;
    if (!planes->colored && !add_three(planes, layer, xyz))
        for (size_t i = 0; i < tried && planes->count == 0; i++)
            add_plane(planes, plane_of(layer, numbers[i]));
    bool visible = planes->count > 0;
    add_plane(planes, plane_of(layer, "A"));
    return visible;
}

/* Returns how many samples were not finite. */
static size_t mend(const struct planes *planes, size_t pixels)
{
    size_t mended = 0;
    for (uint32_t channel = 0; channel < planes->count; channel++)
        for (size_t i = 0; i < pixels; i++) {
            float *sample = &planes->samples[channel][i];
            if (isfinite(*sample))
                continue;
            *sample = isnan(*sample) ? 0.0f : copysignf(HALF_LARGEST, *sample);
            mended++;
        }
    return mended;
}

static bool fits_halves(const struct planes *planes, size_t pixels)
{
    for (uint32_t channel = 0; channel < planes->count; channel++) {
        for (size_t i = 0; i < pixels; i++) {
            uint16_t half;
            if (!half_from_exact(planes->samples[channel][i], &half))
                return false;
        }
    }
    return true;
}

/* Outside of the data window there is nothing: 0, which is transparent where there is alpha. */
static void store(const struct planes *planes, const struct image *image,
                  const struct exr_facts *facts, struct raster *raster)
{
    memset(raster->samples, 0, raster_bytes(raster));
    for (int64_t line = 0; line < (int64_t)image->height; line++) {
        int64_t row = line + facts->top;
        if (row < 0 || row >= (int64_t)raster->height)
            continue;
        for (int64_t i = 0; i < (int64_t)image->width; i++) {
            int64_t column = i + facts->left;
            if (column < 0 || column >= (int64_t)raster->width)
                continue;
            size_t from = (size_t)line * image->width + (size_t)i;
            size_t to = ((size_t)row * raster->width + (size_t)column) * planes->count;
            for (uint32_t k = 0; k < planes->count; k++) {
                if (raster->sample == RASTER_HALF)
                    half_from_exact(planes->samples[k][from], (uint16_t *)raster->samples + to + k);
                else
                    ((float *)raster->samples)[to + k] = planes->samples[k][from];
            }
        }
    }
}

/* A display window may be of any size: one that is much larger than the data takes memory that no data fill. */
static ps_result check_display(const char *path, const struct image *image,
                               const struct exr_facts *facts, struct error *error)
{
    ps_result result =
        raster_check_size(path, facts->width, facts->height, 4 * sizeof(float), error);
    if (result == PS_OK && (uint64_t)facts->width * (uint64_t)facts->height / DISPLAY_TO_DATA >
                               image->width * image->height)
        return error_set(error, PS_ERROR_INVALID,
                         "%s: of its display window of %lld x %lld pixels less than 1/%d is there",
                         path, (long long)facts->width, (long long)facts->height, DISPLAY_TO_DATA);
    return result;
}

static ps_result interleave(const struct raster_source *source, const struct image *image,
                            const struct exr_facts *facts, struct raster *raster,
                            struct error *error)
{
    const char *path = source->path;
    const struct layer layer = {image, facts->layer_is_part ? NULL : source->layer, !source->layer};
    struct planes planes;
    if (!choose_planes(&layer, &planes))
        return source->layer
                   ? error_set(error, PS_ERROR_INVALID, "%s: its layer '%s' has no colours", path,
                               source->layer)
                   : error_set(error, PS_ERROR_INVALID,
                               "%s: it has no colours (channels R, G and B, or Y); 'layer' names "
                               "one of its layers",
                               path);
    ps_result result = check_display(path, image, facts, error);
    if (result != PS_OK)
        return result;
    size_t pixels = image->width * image->height;
    size_t mended = mend(&planes, pixels);
    if (planes.colored && facts->has_chromaticities)
        chromaticities_to_rec709(&facts->chromaticities, planes.samples, pixels);
    raster->width = (uint32_t)facts->width;
    raster->height = (uint32_t)facts->height;
    raster->channels = planes.count;
    raster->sample = fits_halves(&planes, pixels) ? RASTER_HALF : RASTER_FLOAT;
    raster->mended = mended;
    result = raster_allocate(path, raster, error);
    if (result == PS_OK)
        store(&planes, image, facts, raster);
    return result;
}

ps_result raster_read_exr(const struct raster_source *source, struct raster *raster,
                          struct error *error)
{
    struct image image = {0};
    struct exr_facts facts;
    ps_result result = exr_read_layer(source, &image, &facts, error);
    if (result == PS_OK) {
        result = interleave(source, &image, &facts, raster, error);
        image_release(&image);
    }
    return result;
}
