#include "tools/render_arguments.h"

#include <stdio.h>

static bool take_option(struct render_arguments *taken, const struct argument *argument)
{
    const char *name = argument->option->name;
    struct error error;
    if (strcmp(name, "quiet") == 0)
        taken->quiet = true;
    if (!render_options_has(name) || strcmp(name, "output") == 0)
        return true; /* the command's own */
    if (render_options_set(&taken->options, name, argument->value, &error) == PS_OK)
        return true;
    print_error(error.text);
    return false;
}

bool render_arguments_take(struct render_arguments *taken, const struct argument *arguments,
                           size_t count)
{
    *taken = (struct render_arguments){.options = render_options_init()};
    for (size_t i = 0; i < count; i++)
        if (arguments[i].option && !take_option(taken, &arguments[i]))
            return false;
    return true;
}

void render_arguments_release(struct render_arguments *taken)
{
    render_options_release(&taken->options);
}

void print_problems(const struct scene_input *input)
{
    diagnostics_print(input->sink, stderr);
}

bool render_arguments_read(const struct render_arguments *taken, const char *path,
                           struct scene_input *input)
{
    struct error error;
    if (scene_input_create(input, &error) != PS_OK) {
        print_error(error.text);
        return false;
    }
    ps_result result = scene_input_read(input, path, &taken->options.scene);
    if (result == PS_OK)
        result = render_options_apply(&taken->options, input);
    if (result != PS_OK)
        print_problems(input);
    return result == PS_OK;
}

bool render_arguments_load(const struct render_arguments *taken, struct scene_input *input,
                           struct render_settings *settings)
{
    if (!render_arguments_read(taken, taken->scene_path, input))
        return false;
    bool good = render_options_resolve(&taken->options, &input->description, input->sink,
                                       settings) == PS_OK;
    if (!good)
        print_problems(input);
    return good;
}
