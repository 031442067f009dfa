#include "cli/output_list.h"

#include "session/layers.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool take_path(struct output_list *list, const char *path)
{
    if (!output_is_writable_format(path)) {
        fprintf(stderr, "psplat: error: --output: '%s' ends neither in .exr nor in .png\n", path);
        return false;
    }
    if (list->count == MOST_OUTPUTS) {
        print_error("--output: too many files");
        return false;
    }
    list->paths[list->count++] = path;
    return true;
}

static bool take_option(struct output_list *list, const struct argument *argument)
{
    struct error error;
    if (argument_is(argument, "output"))
        return take_path(list, argument->value);
    if (!argument->option || !output_options_has(argument->option->name))
        return true; /* another's */
    if (output_options_set(&list->options, argument->option->name, argument->value, &error) ==
        PS_OK)
        return true;
    print_error(error.text);
    return false;
}

bool output_list_take(struct output_list *list, const struct argument *arguments, size_t count)
{
    *list = (struct output_list){.count = 0};
    for (size_t i = 0; i < count; i++)
        if (!take_option(list, &arguments[i]))
            return false;
    return true;
}

void output_list_release(struct output_list *list)
{
    output_options_release(&list->options);
    free(list->defaults[0]);
    free(list->defaults[1]);
}

bool output_list_add_defaults(struct output_list *list, const char *scene_path)
{
    static const char *const suffixes[2] = {".exr", ".png"};
    for (int i = 0; i < 2; i++) {
        list->defaults[i] = output_default_path(scene_path, suffixes[i]);
        if (!list->defaults[i]) {
            print_error("out of memory");
            return false;
        }
        list->paths[list->count++] = list->defaults[i];
    }
    return true;
}

bool output_list_check(const struct output_list *list)
{
    struct error error;
    bool good = true;
    for (size_t i = 0; i < list->count && good; i++)
        good = output_check(list->paths[i], &error);
    if (!good)
        print_error(error.text);
    return good;
}

bool output_list_spares(const struct output_list *list, const struct scene_description *description)
{
    struct error error;
    bool good = true;
    for (size_t i = 0; i < list->count && good; i++)
        good = output_spares(list->paths[i], "--output", description, &error);
    if (!good)
        print_error(error.text);
    return good;
}

static const char *layers(const struct output_list *list)
{
    return output_options_layers(&list->options);
}

bool output_list_wants_layers(const struct output_list *list)
{
    bool wanted = false;
    for (size_t i = 0; i < list->count; i++)
        wanted |= output_holds_layers(list->paths[i]);
    return wanted && layers_are_some(layers(list));
}

bool output_list_wants_error(const struct output_list *list)
{
    return layers_have_error(layers(list));
}

bool output_list_wants_display(const struct output_list *list)
{
    bool wanted = false;
    for (size_t i = 0; i < list->count; i++)
        wanted |= !output_holds_layers(list->paths[i]) || layers_name(layers(list), "display");
    return wanted;
}

bool output_list_suits(const struct output_list *list, const struct render_settings *settings)
{
    struct error error;
    if (layers_suit(layers(list), settings, &error) == PS_OK)
        return true;
    print_error(error.text);
    return false;
}

static void tell(const char *path, bool quiet)
{
    if (!quiet)
        fprintf(stderr, "psplat: wrote %s\n", path);
}

ps_result output_list_write(const struct output_list *list, const struct image *image,
                            struct workers *workers, bool quiet, struct error *error)
{
    ps_result first = PS_OK;
    for (size_t i = 0; i < list->count; i++) {
        struct error reason;
        ps_result result = output_write(image, list->paths[i], &list->options, workers, &reason);
        if (result == PS_OK)
            tell(list->paths[i], quiet);
        if (result != PS_OK && first == PS_OK) {
            first = result;
            *error = reason;
        }
    }
    return first;
}

/* Of today's processors: deflating a byte takes a thread so long, all else next to nothing. */
#define DEFLATE_SECONDS 2.5e-8

double output_list_guess_seconds(const struct output_list *list, const struct image *image,
                                 double pixels, uint32_t threads)
{
    double seconds = 0.0, bytes = 0.0;
    for (size_t i = 0; i < image->channel_count; i++)
        bytes += layers_keep(layers(list), image->channels[i].name) ? sizeof(float) : 0.0;
    for (size_t i = 0; i < list->count; i++) {
        if (!output_holds_layers(list->paths[i]))
            seconds += 3.0 * pixels * DEFLATE_SECONDS;
        else if (list->options.compression < IMAGE_RLE)
            seconds += bytes * pixels * DEFLATE_SECONDS / threads;
    }
    return seconds;
}

void output_list_tell(const struct output_list *list, bool quiet)
{
    for (size_t i = 0; i < list->count; i++)
        tell(list->paths[i], quiet);
}
