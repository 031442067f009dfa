/* raster_radiance.c: Radiance HDR pictures, whose lines may be in any order.
 *
 * The header's last line says how (Ward 1991): "-Y 480 +X 640" is 480 lines of 640 pixels, top line
 * first, each from the left. Either axis may come first, with either sign. stb_image knows this one
 * alone, and lines are coded alike in all; so it gets a copy whose header says that, and the pixels
 * are put in place afterwards.
 */
#include "image/raster_decode.h"

#ifdef PSPLAT_STB
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST_LINE 100

struct axis {
    char sign, letter;
    uint32_t length;
};

/* Where it stands in the file, and what it says: the axis of the lines, and that along each of
 * them. */
struct resolution {
    size_t start, end; /* without its newline */
    struct axis lines, along;
};

/* The line after the header's empty one. */
static bool find_line(const struct raster_source *source, struct resolution *resolution)
{
    const char *text = (const char *)source->bytes, *end = text + source->size;
    for (const char *line = text; line < end;) {
        const char *newline = memchr(line, '\n', (size_t)(end - line));
        if (!newline)
            return false;
        if (newline == line) {
            newline = memchr(line + 1, '\n', (size_t)(end - line - 1));
            resolution->start = (size_t)(line + 1 - text);
            resolution->end = newline ? (size_t)(newline - text) : 0;
            return newline && resolution->end - resolution->start < LONGEST_LINE;
        }
        line = newline + 1;
    }
    return false;
}

/* "-Y 480 ", of which `text` is left behind. */
static bool read_axis(const char **text, struct axis *axis)
{
    char *end;
    axis->sign = **text;
    axis->letter = axis->sign ? (*text)[1] : '\0';
    if ((axis->sign != '-' && axis->sign != '+') || (axis->letter != 'X' && axis->letter != 'Y') ||
        (*text)[2] != ' ')
        return false;
    long length = strtol(*text + 3, &end, 10);
    axis->length = length > 0 && length <= INT_MAX ? (uint32_t)length : 0;
    while (*end == ' ')
        end++;
    *text = end;
    return axis->length > 0;
}

static bool read_resolution(const struct raster_source *source, struct resolution *resolution)
{
    char line[LONGEST_LINE + 1] = "";
    const char *text = line;
    if (!find_line(source, resolution))
        return false;
    memcpy(line, source->bytes + resolution->start, resolution->end - resolution->start);
    return read_axis(&text, &resolution->lines) && read_axis(&text, &resolution->along) &&
           resolution->lines.letter != resolution->along.letter;
}

static bool is_usual(const struct resolution *resolution)
{
    return resolution->lines.letter == 'Y' && resolution->lines.sign == '-' &&
           resolution->along.sign == '+';
}

/* The same file with lines in the usual order. The caller frees its bytes. */
static ps_result retitle(const struct raster_source *source, const struct resolution *resolution,
                         struct raster_source *retitled, struct error *error)
{
    char line[LONGEST_LINE];
    int length = snprintf(line, sizeof line, "-Y %u +X %u", resolution->lines.length,
                          resolution->along.length);
    size_t rest = source->size - resolution->end;
    unsigned char *bytes = malloc(resolution->start + (size_t)length + rest);
    if (!bytes)
        return error_memory(error, source->size, "a picture");
    memcpy(bytes, source->bytes, resolution->start);
    memcpy(bytes + resolution->start, line, (size_t)length);
    memcpy(bytes + resolution->start + length, source->bytes + resolution->end, rest);
    *retitled = (struct raster_source){
        .path = source->path, .bytes = bytes, .size = resolution->start + (size_t)length + rest};
    return PS_OK;
}

/* X grows to the right, Y upwards. */
static uint32_t place_on(const struct axis *axis, uint32_t step)
{
    bool forward = axis->sign == (axis->letter == 'X' ? '+' : '-');
    return forward ? step : axis->length - 1 - step;
}

static ps_result put_in_place(const char *path, const struct resolution *resolution,
                              struct raster *raster, struct error *error)
{
    const struct axis *lines = &resolution->lines, *along = &resolution->along;
    bool columns = lines->letter == 'X';
    struct raster turned = *raster;
    turned.samples = NULL;
    turned.width = columns ? raster->height : raster->width;
    turned.height = columns ? raster->width : raster->height;
    ps_result result = raster_allocate(path, &turned, error);
    if (result != PS_OK)
        return result;
    size_t channels = raster->channels, pixel = channels * sizeof(float);
    for (uint32_t i = 0; i < raster->height; i++) {
        const float *from = raster_row(raster, i);
        uint32_t line = place_on(lines, i);
        for (uint32_t k = 0; k < raster->width; k++) {
            uint32_t at = place_on(along, k), x = columns ? line : at, y = columns ? at : line;
            memcpy((float *)raster_row(&turned, y) + x * channels, from + k * channels, pixel);
        }
    }
    raster_release(raster);
    *raster = turned;
    return PS_OK;
}

ps_result raster_read_radiance(const struct raster_source *source, struct raster *raster,
                               struct error *error)
{
    struct resolution resolution;
    struct raster_source usual;
    if (!read_resolution(source, &resolution) || is_usual(&resolution))
        return raster_read_floats(source, raster, error);
    ps_result result = retitle(source, &resolution, &usual, error);
    if (result != PS_OK)
        return result;
    result = raster_read_floats(&usual, raster, error);
    free((void *)usual.bytes);
    return result == PS_OK ? put_in_place(source->path, &resolution, raster, error) : result;
}

#endif
