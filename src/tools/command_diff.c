/* command_diff.c: psplat diff: TEST - REFERENCE as a picture.
 *
 * NaN and infinities pass through: a picture of where they are is what one looks for.
 */
#include "cli/command.h"
#include "compare/picture_pair.h"

enum { OPTION_OUTPUT, OPTION_LAYER };

static const struct option options[] = {
    [OPTION_OUTPUT] = {'o', "output", "FILE.exr", "write the difference to FILE.exr (needed)"},
    [OPTION_LAYER] = {'l', "layer", "NAME", "NAME.R, NAME.G, NAME.B, or the channel NAME"},
};

struct request {
    const char *paths[2];
    size_t path_count;
    const char *output, *layer;
};

static bool parse_arguments(const struct argument *arguments, size_t count, struct request *request)
{
    for (size_t i = 0; i < count; i++) {
        if (arguments[i].option == &options[OPTION_OUTPUT])
            request->output = arguments[i].value;
        else if (arguments[i].option == &options[OPTION_LAYER])
            request->layer = arguments[i].value;
        else if (request->path_count++ < 2)
            request->paths[request->path_count - 1] = arguments[i].value;
    }
    if (request->path_count != 2)
        print_error("diff: expected two pictures, the reference and the one to test. "
                    "Try 'psplat diff --help'.");
    else if (!request->output)
        print_error("diff: where to? Give -o FILE.exr.");
    return request->path_count == 2 && request->output;
}

static ps_result subtract(const struct picture_pair *pair, struct image *difference,
                          struct error *error)
{
    size_t pixels = pair->width * pair->height;
    difference->width = pair->width;
    difference->height = pair->height;
    difference->window = pair->images[0].window;
    for (size_t c = 0; c < pair->channel_count; c++) {
        float *samples = image_add_channel(difference, pair->names[c]);
        if (!samples)
            return error_memory(error, pixels * sizeof *samples, "the difference");
        for (size_t i = 0; i < pixels; i++)
            samples[i] = pair->test[c][i] - pair->reference[c][i];
    }
    return PS_OK;
}

static ps_result write_difference(const struct request *request, struct picture_pair *pair,
                                  struct image *difference, struct error *error)
{
    static const char *const names[2] = {"psplat.reference", "psplat.test"};
    ps_result result =
        picture_pair_read(pair, request->paths[0], request->paths[1], request->layer, error);
    if (result == PS_OK)
        result = subtract(pair, difference, error);
    for (int i = 0; i < 2 && result == PS_OK; i++)
        result = image_set_attribute(difference, names[i], request->paths[i], error);
    if (result != PS_OK)
        return result;
    return image_write_exr(difference, request->output, IMAGE_ZIP, pair->workers, error);
}

static int run(const struct argument *arguments, size_t count)
{
    struct request request = {0};
    struct picture_pair pair = {0};
    struct image difference = {0};
    struct error error;
    if (!parse_arguments(arguments, count, &request))
        return STATUS_USAGE;
    ps_result result = write_difference(&request, &pair, &difference, &error);
    if (result != PS_OK)
        print_error(error.text);
    image_release(&difference);
    picture_pair_release(&pair);
    return result == PS_OK ? STATUS_OK : STATUS_FAILED;
}

const struct command command_diff = {
    .name = "diff",
    .operands = "REFERENCE.exr TEST.exr -o FILE.exr",
    .summary = "writes the difference of two pictures, TEST - REFERENCE",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
