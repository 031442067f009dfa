/* command_view.c: psplat view: a layer of a picture as PNG.
 *
 * Colours are light, which bloom and tone map bring to a display; but the layer `display` has been
 * there, and needs the sRGB curve alone. Normals (layer N) and single channels are no light: they
 * go to bytes in proportion, without that curve, -1..1 and 0..the largest finite value to 0..255.
 * Samples that are not finite are black. Parts are cut out, and magnified, after that: pixels stay
 * what they are in the whole picture, so parts of one picture compare.
 */
#include "base/text.h"
#include "cli/command.h"
#include "compare/layer.h"
#include "image/magnify.h"
#include "image/raster.h"
#include "image/tonemap.h"
#include "tools/last_stages.h"
#include "tools/option_parse.h"
#include "tools/progress_callbacks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NORMAL_LAYER "N"
#define DISPLAY_LAYER "display"

enum { OPTION_OUTPUT, OPTION_LAYER, OPTION_EXPOSURE, OPTION_PLUGIN, OPTION_CROP, OPTION_ZOOM };

static const struct option options[] = {
    [OPTION_OUTPUT] = {'o', "output", "FILE.png", "default: the picture's name with .png"},
    [OPTION_LAYER] = {'l', "layer", "NAME", "NAME.R, NAME.G, NAME.B, or the channel NAME"},
    [OPTION_EXPOSURE] = {0, "exposure", "STOPS",
                         "brightness: a factor of 2^STOPS (not for N or display)"},
    [OPTION_PLUGIN] = {'p', "plugin", "KIND=NAME[:KEY=VALUE,...]",
                       "another bloom or tone map, or other parameters"},
    [OPTION_CROP] = {0, "crop", "X,Y,W,H", "this part only; 0,0 is the upper left corner"},
    [OPTION_ZOOM] = {0, "zoom", "N", "make each pixel a square of NxN"},
};

struct request {
    const char *picture, *output, *layer;
    double stops;
    bool cropped;
    struct rectangle crop;
    double zoom;
    struct last_stages stages; /* owned */
};

static bool parse_plugin(const char *text, struct last_stages *stages)
{
    struct error error;
    if (last_stages_override(stages, PS_BLOOM, text, &error) == PS_OK)
        return true;
    print_error(error.text);
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
    case OPTION_PLUGIN:
        return parse_plugin(argument->value, &request->stages);
    case OPTION_CROP:
        request->cropped = true;
        return parse_rectangle("crop", argument->value, &request->crop);
    case OPTION_ZOOM:
        return parse_whole_number("zoom", argument->value, 1, 64, &request->zoom);
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

static bool shows(const struct request *request, const char *layer)
{
    return request->layer && strcmp(request->layer, layer) == 0;
}

/* Makes of light, in place, what a display shows. Errors that were printed leave no text. */
static ps_result show(struct request *request, const struct layer *layer, const struct image *image,
                      struct error *error)
{
    struct render_settings settings;
    struct progress progress;
    ps_result result =
        last_stages_resolve(&request->stages, parallel_processor_count(), &settings, error);
    if (result != PS_OK)
        return result;
    progress_start(&progress, PROGRESS_NONE, true);
    struct render_callbacks callbacks = progress_callbacks(&progress);
    settings.exposure = request->stops;
    result =
        render_display(layer->planes, image->width, image->height, &settings, &callbacks, error);
    settings_release(&settings);
    return result;
}

static ps_result map_light(struct request *request, const struct layer *layer,
                           const struct image *image, uint8_t *rgb, struct error *error)
{
    size_t pixels = image->width * image->height;
    for (size_t c = 0; c < 3; c++)
        blacken_non_finite(layer->planes[c], pixels);
    ps_result result = shows(request, DISPLAY_LAYER) ? PS_OK : show(request, layer, image, error);
    for (size_t y = 0, at = 0; result == PS_OK && y < image->height; y++, at += image->width)
        tonemap_row(layer->planes[0] + at, layer->planes[1] + at, layer->planes[2] + at,
                    image->width, (uint32_t)image->window.left, (uint32_t)(image->window.top + y),
                    rgb + 3 * at);
    return result;
}

static ps_result map_layer(struct request *request, const struct layer *layer,
                           const struct image *image, uint8_t *rgb, struct error *error)
{
    size_t pixels = image->width * image->height;
    if (layer->kind != LAYER_SINGLE && !shows(request, NORMAL_LAYER))
        return map_light(request, layer, image, rgb, error);
    if (layer->kind == LAYER_SINGLE)
        map_single(layer, pixels, request->stops, rgb);
    else
        map_normals(layer, pixels, rgb);
    return PS_OK;
}

/* The whole picture, or the part that was asked for; false, printed, where that is not in it. */
static bool find_part(const struct request *request, const struct image *image,
                      struct rectangle *part)
{
    *part =
        request->cropped ? request->crop : (struct rectangle){0, 0, image->width, image->height};
    if (!rectangle_fits(*part, image->width, image->height)) {
        fprintf(stderr,
                "psplat: error: --crop: %zu,%zu,%zu,%zu is empty or reaches beyond the picture's "
                "%zux%zu\n",
                part->x, part->y, part->width, part->height, image->width, image->height);
        return false;
    }
    size_t limit = RASTER_SIDE_LIMIT / (size_t)request->zoom;
    if (request->zoom > 1.0 && (part->width > limit || part->height > limit)) {
        fprintf(stderr, "psplat: error: --zoom: more than %d pixels a side; give --crop\n",
                RASTER_SIDE_LIMIT);
        return false;
    }
    return true;
}

static ps_result write_part(struct request *request, struct rectangle part,
                            const struct layer *layer, const struct image *image,
                            const char *output, struct error *error)
{
    size_t zoom = (size_t)request->zoom, pixels = image->width * image->height;
    size_t width = part.width * zoom, height = part.height * zoom;
    uint8_t *rgb = malloc(3 * pixels), *magnified = malloc(3 * width * height);
    ps_result result = rgb && magnified
                           ? map_layer(request, layer, image, rgb, error)
                           : error_memory(error, 3 * (pixels + width * height), "the PNG");
    if (result == PS_OK) {
        magnify(rgb, image->width, part, zoom, magnified);
        result = image_write_png(output, width, height, magnified, image->attributes,
                                 image->attribute_count, error);
    }
    free(rgb);
    free(magnified);
    return result;
}

static int view(struct request *request, const char *output)
{
    struct image image = {0};
    struct layer layer;
    struct rectangle part;
    struct error error = {.text = ""};
    int status = STATUS_OK;
    ps_result result = image_read_exr(request->picture, &image, &error);
    if (result == PS_OK)
        result = layer_find(&image, request->picture, request->layer, &layer, &error);
    if (result == PS_OK && !find_part(request, &image, &part))
        status = STATUS_USAGE;
    if (result == PS_OK && status == STATUS_OK)
        result = write_part(request, part, &layer, &image, output, &error);
    if (result != PS_OK && error.text[0])
        print_error(error.text);
    if (result != PS_OK)
        status = error.text[0] ? STATUS_FAILED : STATUS_USAGE; /* printed: of the settings */
    image_release(&image);
    return status;
}

static int run_request(struct request *request)
{
    char *output = request->output ? strdup(request->output) : default_output(request->picture);
    if (!output) {
        print_error("out of memory");
        return STATUS_FAILED;
    }
    int status = view(request, output);
    free(output);
    return status;
}

static int run(const struct argument *arguments, size_t count)
{
    struct request request = {.zoom = 1};
    struct error error;
    int status = STATUS_USAGE;
    ps_result created = last_stages_create(&request.stages, &error);
    if (created != PS_OK) {
        print_error(error.text);
        status = status_of(created);
    } else if (parse_arguments(arguments, count, &request)) {
        status = run_request(&request);
    }
    last_stages_release(&request.stages);
    return status;
}

const struct command command_view = {
    .name = "view",
    .operands = "PICTURE.exr",
    .summary = "makes a PNG of a picture or of one of its layers",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
