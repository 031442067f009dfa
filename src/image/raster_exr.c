/* raster_exr.c: the colours of an OpenEXR picture, or of one of its layers.
 *
 * Most files hold half floats, which the reader widens; they are stored as half floats again where
 * that loses nothing. The picture is the display window, as viewers show it, and its colours are
 * made Rec.709's. Only a band of lines has its samples as floats.
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

/* A line of the planes as a row of the raster. Outside of the data window there is nothing: 0,
 * which is transparent where there is alpha. */
static void store_row(const struct planes *planes, const struct image *image, size_t line,
                      const struct exr_facts *facts, const struct raster *raster, void *row)
{
    memset(row, 0, (size_t)raster->width * raster_texel_bytes(raster));
    for (int64_t i = 0; i < (int64_t)image->width; i++) {
        int64_t column = i + facts->left;
        if (column < 0 || column >= (int64_t)raster->width)
            continue;
        size_t from = line * image->width + (size_t)i, to = (size_t)column * planes->count;
        for (uint32_t k = 0; k < planes->count; k++) {
            if (raster->sample == RASTER_HALF)
                half_from_exact(planes->samples[k][from], (uint16_t *)row + to + k);
            else
                ((float *)row)[to + k] = planes->samples[k][from];
        }
    }
}

/* A display window may be of any size: one that is much larger than the data takes memory that no
 * data fill. */
static ps_result check_display(const char *path, const struct exr_facts *facts, struct error *error)
{
    ps_result result =
        raster_check_size(path, facts->width, facts->height, 4 * sizeof(float), error);
    if (result == PS_OK &&
        (uint64_t)facts->width * (uint64_t)facts->height / DISPLAY_TO_DATA > facts->pixels)
        return error_set(error, PS_ERROR_INVALID,
                         "%s: of its display window of %lld x %lld pixels less than 1/%d is there",
                         path, (long long)facts->width, (long long)facts->height, DISPLAY_TO_DATA);
    return result;
}

/* Finds the picture's planes, and what they tell of the raster but for its samples. */
static ps_result describe(const struct raster_source *source, const struct image *image,
                          const struct exr_facts *facts, struct planes *planes,
                          struct raster *raster, struct error *error)
{
    const char *path = source->path;
    const struct layer layer = {image, facts->layer_is_part ? NULL : source->layer, !source->layer};
    if (!choose_planes(&layer, planes))
        return source->layer
                   ? error_set(error, PS_ERROR_INVALID, "%s: its layer '%s' has no colours", path,
                               source->layer)
                   : error_set(error, PS_ERROR_INVALID,
                               "%s: it has no colours (channels R, G and B, or Y); 'layer' names "
                               "one of its layers",
                               path);
    raster->width = (uint32_t)facts->width;
    raster->height = (uint32_t)facts->height;
    raster->channels = planes->count;
    return check_display(path, facts, error);
}

static bool is_converted(const struct planes *planes, const struct exr_facts *facts)
{
    return planes->colored && facts->has_chromaticities;
}

/* Makes the first pixels of the planes finite, and their colours Rec.709's. */
static void make_usual(const struct planes *planes, const struct exr_facts *facts, size_t pixels,
                       struct raster *raster)
{
    raster->mended += mend(planes, pixels);
    if (is_converted(planes, facts))
        chromaticities_to_rec709(&facts->chromaticities, planes->samples, pixels);
}

/* --- band by band --- */

/* A picture is read once to see whether halves hold its samples, as far as that is open, and once
 * for these. */
struct reading {
    const struct raster_source *source;
    struct raster raster; /* what is known of it */
    struct planes planes; /* of a band */
    bool begun;
    bool ended;    /* before its last band: nothing more is wanted */
    int64_t lines; /* of the data window that were read */
    struct raster_rows rows;
};

static ps_result begin(struct reading *reading, const struct image *band,
                       const struct exr_facts *facts, struct error *error)
{
    if (reading->begun)
        return PS_OK;
    reading->begun = true;
    return describe(reading->source, band, facts, &reading->planes, &reading->raster, error);
}

static ps_result end_early(struct reading *reading)
{
    reading->ended = true;
    return PS_CANCELLED;
}

/* exr_bands.take */
static ps_result look_at_band(void *user, const struct image *band, const struct exr_facts *facts,
                              size_t lines, struct error *error)
{
    struct reading *reading = user;
    ps_result result = begin(reading, band, facts, error);
    if (result != PS_OK)
        return result;
    size_t pixels = band->width * lines;
    reading->raster.sample = RASTER_HALF;
    if (facts->halves && !is_converted(&reading->planes, facts))
        return end_early(reading);
    make_usual(&reading->planes, facts, pixels, &reading->raster);
    if (fits_halves(&reading->planes, pixels))
        return PS_OK;
    reading->raster.sample = RASTER_FLOAT;
    return end_early(reading);
}

/* Rows without data, until so many rows are done. */
static ps_result add_empty_rows(struct reading *reading, int64_t rows, struct error *error)
{
    size_t bytes = (size_t)reading->raster.width * raster_texel_bytes(&reading->raster);
    ps_result result = PS_OK;
    while (result == PS_OK && reading->rows.done < rows &&
           reading->rows.done < reading->raster.height) {
        memset(raster_rows_next(&reading->rows), 0, bytes);
        result = raster_rows_add(&reading->rows, error);
    }
    return result;
}

/* exr_bands.take */
static ps_result store_band(void *user, const struct image *band, const struct exr_facts *facts,
                            size_t lines, struct error *error)
{
    struct reading *reading = user;
    ps_result result = begin(reading, band, facts, error);
    if (result == PS_OK)
        make_usual(&reading->planes, facts, band->width * lines, &reading->raster);
    for (size_t line = 0; line < lines && result == PS_OK; line++) {
        int64_t row = reading->lines++ + facts->top;
        result = add_empty_rows(reading, row, error);
        if (result != PS_OK || row < 0 || row >= (int64_t)reading->raster.height)
            continue;
        store_row(&reading->planes, band, line, facts, &reading->raster,
                  raster_rows_next(&reading->rows));
        result = raster_rows_add(&reading->rows, error);
    }
    return result;
}

typedef ps_result (*band_taker)(void *user, const struct image *band, const struct exr_facts *facts,
                                size_t lines, struct error *error);

static ps_result read_bands(struct reading *reading, band_taker take, struct error *error)
{
    struct image image = {0};
    struct exr_facts facts;
    const struct exr_bands bands = {take, reading};
    reading->begun = reading->ended = false;
    ps_result result = exr_read_layer(reading->source, &bands, &image, &facts, error);
    if (result == PS_OK) {
        result =
            begin(reading, &image, &facts, error); /* says what is missing where no band came */
        image_release(&image);
    }
    return reading->ended ? PS_OK : result;
}

static ps_result read_rows(struct reading *reading, struct error *error)
{
    ps_result result = raster_rows_begin(reading->source, &reading->raster, &reading->rows, error);
    reading->raster.mended = 0;
    if (result == PS_OK)
        result = read_bands(reading, store_band, error);
    if (result == PS_OK)
        result = add_empty_rows(reading, reading->raster.height, error);
    raster_rows_release(&reading->rows);
    return result;
}

ps_result raster_read_exr(const struct raster_source *source, struct raster *raster,
                          struct error *error)
{
    struct reading reading = {.source = source, .raster = *raster};
    ps_result result = read_bands(&reading, look_at_band, error);
    if (result == PS_OK)
        result = read_rows(&reading, error);
    *raster = reading.raster;
    return result;
}
