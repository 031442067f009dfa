/* command_view.c: psplat view: a layer of a picture as PNG.
 *
 * Colours are tone mapped. Normals (layer N) and single channels are no light: they go to bytes in
 * proportion, without the sRGB curve, -1..1 and 0..the largest finite value to 0..255. Samples that
 * are not finite are black.
 */
#include "base/text.h"
#include "cli/command.h"
#include "compare/layer.h"
#include "image/tonemap.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NORMAL_LAYER "N"

enum { OPTION_OUTPUT, OPTION_LAYER, OPTION_EXPOSURE, OPTION_CURVE };

static const struct option options[] = {
    [OPTION_OUTPUT] = {'o', "output", "FILE.png", "default: the picture's name with .png"},
    [OPTION_LAYER] = {'l', "layer", "NAME", "NAME.R, NAME.G, NAME.B, or the channel NAME"},
    [OPTION_EXPOSURE] = {0, "exposure", "STOPS", "brightness: a factor of 2^STOPS (not for N)"},
    [OPTION_CURVE] = {0, "curve", "clip|filmic", "what becomes of highlights; default: filmic"},
};

struct request {
    const char *picture, *output, *layer;
    double stops;
    enum tone_curve curve;
};

static bool parse_curve(const char *text, enum tone_curve *curve)
{
    *curve = strcmp(text, "clip") == 0 ? TONE_CLIP : TONE_FILMIC;
    if (*curve == TONE_CLIP || strcmp(text, "filmic") == 0)
        return true;
    fprintf(stderr, "psplat: error: --curve: expected clip or filmic, got '%s'\n", text);
    return false;
}

static bool parse_option(const struct argument *argument, struct request *request)
{
    switch (argument->option - options) {
    case OPTION_OUTPUT:
        request->output = argument->value;
        return true;
    case OPTION_LAYER:
        request->layer = argument->value;
        return true;
    case OPTION_CURVE:
        return parse_curve(argument->value, &request->curve);
    default:
        if (text_to_number(argument->value, &request->stops))
            return true;
        fprintf(stderr, "psplat: error: --exposure: expected a number, got '%s'\n",
                argument->value);
        return false;
    }
}

static bool parse_arguments(const struct argument *arguments, size_t count, struct request *request)
{
    size_t pictures = 0;
    for (size_t i = 0; i < count; i++) {
        if (!arguments[i].option) {
            request->picture = arguments[i].value;
            pictures++;
        } else if (!parse_option(&arguments[i], request)) {
            return false;
        }
    }
    if (pictures != 1)
        print_error("view: expected one picture. Try 'psplat view --help'.");
    return pictures == 1;
}

/* The picture's path with .png for .exr; the caller frees it. */
static char *default_output(const char *picture)
{
    size_t length = strlen(picture);
    if (length > 4 && strcmp(picture + length - 4, ".exr") == 0)
        length -= 4;
    char *path = malloc(length + sizeof ".png");
    if (path)
        snprintf(path, length + sizeof ".png", "%.*s.png", (int)length, picture);
    return path;
}

static void blacken_non_finite(float *plane, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++)
        if (!isfinite(plane[i]))
            plane[i] = 0.0f;
}

static uint8_t byte_from_share(double share)
{
    return (uint8_t)(255.0 * fmin(fmax(share, 0.0), 1.0) + 0.5);
}

static void map_normals(const struct layer *layer, size_t pixels, uint8_t *rgb)
{
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3; c++)
            if (isfinite(layer->planes[c][i]))
                rgb[3 * i + c] = byte_from_share(0.5 + 0.5 * (double)layer->planes[c][i]);
            else
                rgb[3 * i + c] = 0;
}

static void map_single(const struct layer *layer, size_t pixels, double stops, uint8_t *rgb)
{
    const float *plane = layer->planes[0];
    double largest = 0.0;
    for (size_t i = 0; i < pixels; i++)
        largest = isfinite(plane[i]) ? fmax(largest, (double)plane[i]) : largest;
    double factor = largest > 0.0 ? exp2(stops) / largest : 0.0;
    for (size_t i = 0; i < pixels; i++) {
        uint8_t grey = isfinite(plane[i]) ? byte_from_share(factor * (double)plane[i]) : 0;
        memset(rgb + 3 * i, grey, 3);
    }
}

static void map_layer(const struct request *request, const struct layer *layer, size_t pixels,
                      uint8_t *rgb)
{
    if (layer->kind == LAYER_SINGLE) {
        map_single(layer, pixels, request->stops, rgb);
    } else if (request->layer && strcmp(request->layer, NORMAL_LAYER) == 0) {
        map_normals(layer, pixels, rgb);
    } else {
        for (size_t c = 0; c < 3; c++)
            blacken_non_finite(layer->planes[c], pixels);
        tonemap_planes(layer->planes[0], layer->planes[1], layer->planes[2], pixels, request->stops,
                       request->curve, rgb);
    }
}

static ps_result view(const struct request *request, const char *output, struct image *image,
                      struct error *error)
{
    struct layer layer;
    ps_result result = image_read_exr(request->picture, image, error);
    if (result == PS_OK)
        result = layer_find(image, request->picture, request->layer, &layer, error);
    if (result != PS_OK)
        return result;
    size_t pixels = image->width * image->height;
    uint8_t *rgb = malloc(3 * pixels);
    if (!rgb)
        return error_memory(error, 3 * pixels, "the PNG");
    map_layer(request, &layer, pixels, rgb);
    result = image_write_png(output, image->width, image->height, rgb, image->attributes,
                             image->attribute_count, error);
    free(rgb);
    return result;
}

static int run(const struct argument *arguments, size_t count)
{
    struct request request = {.curve = TONE_FILMIC};
    struct image image = {0};
    struct error error;
    if (!parse_arguments(arguments, count, &request))
        return STATUS_USAGE;
    char *output = request.output ? strdup(request.output) : default_output(request.picture);
    if (!output) {
        print_error("out of memory");
        return STATUS_FAILED;
    }
    ps_result result = view(&request, output, &image, &error);
    if (result != PS_OK)
        print_error(error.text);
    image_release(&image);
    free(output);
    return result == PS_OK ? STATUS_OK : STATUS_FAILED;
}

const struct command command_view = {
    .name = "view",
    .operands = "PICTURE.exr",
    .summary = "makes a PNG of a picture or of one of its layers",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
