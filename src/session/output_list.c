#include "session/output_list.h"

#include "session/layers.h"

ps_result output_list_add(struct output_list *list, const char *path, struct error *error)
{
    if (!output_is_writable_format(path))
        return error_set(error, PS_ERROR_INVALID,
                         "--output: '%.1000s' ends neither in .exr nor in .png", path);
    return word_list_insert(&list->paths, list->paths.count, path, error);
}

void output_list_release(struct output_list *list)
{
    word_list_release(&list->paths);
    output_options_release(&list->options);
}

ps_result output_list_check(const struct output_list *list, struct error *error)
{
    for (size_t i = 0; i < list->paths.count; i++)
        if (!output_check(list->paths.words[i], error))
            return PS_ERROR_IO;
    return PS_OK;
}

ps_result output_list_check_not_input(const struct output_list *list,
                                      const struct scene_description *description,
                                      struct error *error)
{
    for (size_t i = 0; i < list->paths.count; i++)
        if (!output_check_not_input(list->paths.words[i], "--output", description, error))
            return PS_ERROR_INVALID;
    return PS_OK;
}

static const char *layers(const struct output_list *list)
{
    return output_options_layers(&list->options);
}

bool output_list_wants_layers(const struct output_list *list)
{
    bool wanted = false;
    for (size_t i = 0; i < list->paths.count; i++)
        wanted |= output_holds_layers(list->paths.words[i]);
    return wanted && layers_any(layers(list));
}

bool output_list_wants_error(const struct output_list *list)
{
    return layers_have_error(layers(list));
}

bool output_list_wants_display(const struct output_list *list)
{
    bool wanted = false;
    for (size_t i = 0; i < list->paths.count; i++)
        wanted |=
            !output_holds_layers(list->paths.words[i]) || layers_contain(layers(list), "display");
    return wanted;
}

ps_result output_list_write(const struct output_list *list, const struct image *image,
                            struct workers *workers, output_list_tell tell, void *user,
                            struct error *error)
{
    ps_result first = PS_OK;
    for (size_t i = 0; i < list->paths.count; i++) {
        const char *path = list->paths.words[i];
        struct error reason;
        ps_result result = output_write(image, path, &list->options, workers, &reason);
        if (result == PS_OK && tell)
            tell(user, path);
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
    for (size_t i = 0; i < list->paths.count; i++) {
        if (!output_holds_layers(list->paths.words[i]))
            seconds += 3.0 * pixels * DEFLATE_SECONDS;
        else if (list->options.compression < IMAGE_RLE)
            seconds += bytes * pixels * DEFLATE_SECONDS / threads;
    }
    return seconds;
}
