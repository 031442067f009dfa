/* raster_exr.c: an OpenEXR picture's colours.
 *
 * Layers are left out: "R" is read, "diffuse.R" is not. Most files hold half floats, which the
 * reader widens; they are stored as half floats again where that loses nothing.
 */
#include "image/half.h"
#include "image/raster_decode.h"

#include <math.h>

#define CHANNELS_AT_MOST 4

static const char *const wanted_channels[] = {"A", "B", "G", "R", "Y", NULL};

/* The planes that make up the picture, in the raster's order. */
struct planes {
    const float *samples[CHANNELS_AT_MOST];
    uint32_t count;
};

static void add_plane(struct planes *planes, const float *samples)
{
    if (samples)
        planes->samples[planes->count++] = samples;
}

static bool choose_planes(const struct image *image, struct planes *planes)
{
    const float *red = image_channel(image, "R");
    const float *green = image_channel(image, "G");
    const float *blue = image_channel(image, "B");
    bool colored = red && green && blue;
    *planes = (struct planes){.count = 0};
    if (colored) {
        add_plane(planes, red);
        add_plane(planes, green);
        add_plane(planes, blue);
    } else {
        add_plane(planes, image_channel(image, "Y"));
    }
    bool visible = planes->count > 0;
    add_plane(planes, image_channel(image, "A"));
    return visible;
}

static float finite_sample(float sample)
{
    if (isnan(sample))
        return 0.0f;
    return isinf(sample) ? copysignf(HALF_LARGEST, sample) : sample;
}

static bool fits_halves(const struct planes *planes, size_t pixels)
{
    for (uint32_t channel = 0; channel < planes->count; channel++) {
        for (size_t i = 0; i < pixels; i++) {
            uint16_t half;
            if (!half_from_exact(finite_sample(planes->samples[channel][i]), &half))
                return false;
        }
    }
    return true;
}

/* These return how many samples were not finite. */
static size_t store_halves(const struct planes *planes, size_t pixels, uint16_t *halves)
{
    size_t mended = 0;
    for (uint32_t channel = 0; channel < planes->count; channel++) {
        for (size_t i = 0; i < pixels; i++) {
            float sample = planes->samples[channel][i];
            half_from_exact(finite_sample(sample), &halves[i * planes->count + channel]);
            mended += !isfinite(sample);
        }
    }
    return mended;
}

static size_t store_floats(const struct planes *planes, size_t pixels, float *floats)
{
    size_t mended = 0;
    for (uint32_t channel = 0; channel < planes->count; channel++) {
        for (size_t i = 0; i < pixels; i++) {
            float sample = planes->samples[channel][i];
            floats[i * planes->count + channel] = finite_sample(sample);
            mended += !isfinite(sample);
        }
    }
    return mended;
}

static ps_result interleave(const char *path, const struct image *image, struct raster *raster,
                            struct error *error)
{
    struct planes planes;
    if (!choose_planes(image, &planes)) {
        return error_set(error, PS_ERROR_INVALID,
                         "%s: it has no colours (channels R, G and B, or Y)", path);
    }
    size_t pixels = image->width * image->height;
    raster->width = (uint32_t)image->width;
    raster->height = (uint32_t)image->height;
    raster->channels = planes.count;
    raster->sample = fits_halves(&planes, pixels) ? RASTER_HALF : RASTER_FLOAT;
    ps_result result = raster_allocate(path, raster, error);
    if (result != PS_OK)
        return result;
    raster->mended = raster->sample == RASTER_HALF ? store_halves(&planes, pixels, raster->samples)
                                                   : store_floats(&planes, pixels, raster->samples);
    return PS_OK;
}

ps_result raster_read_exr(const struct raster_source *source, struct raster *raster,
                          struct error *error)
{
    struct image image = {0};
    ps_result result = exr_read_channels(source, wanted_channels, &image, error);
    if (result == PS_OK) {
        result = interleave(source->path, &image, raster, error);
        image_release(&image);
    }
    return result;
}
