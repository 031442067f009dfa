/* command_check.c: psplat check: is a scene file right? */
#include "base/input_file.h"
#include "cli/command.h"
#include "model/model.h"
#include "pipeline/render.h"
#include "tools/bounds.h"
#include "tools/render_arguments.h"

#include <stdio.h>
#include <unistd.h>

static const struct option options[] = {
    {0, "bounds", NULL, "print the boxes around the scene and its meshes, and the camera"},
    {'p', "plugin", "KIND=NAME[:KEY=VALUE,...]", "check with another strategy"},
    SCENE_OPTIONS,
    {0, "parameters", NULL, "list the parameters of the scenes instead"},
};

static void print_log(void *user, ps_log_level level, const char *message)
{
    (void)user;
    if (level == PS_LOG_WARNING)
        print_warning(message);
}

static bool asks_for(const struct argument *arguments, size_t count, const char *name)
{
    bool found = false;
    for (size_t i = 0; i < count; i++)
        found = found || argument_is(&arguments[i], name);
    return found;
}

/* Pictures are read, shapes and lights made, and strategies started: what is wrong with those shows
 * only then. */
static bool builds(struct scene_input *input, struct render_settings *settings, bool prints_bounds)
{
    static const struct render_callbacks callbacks = {.log = print_log};
    struct scene scene;
    struct error error;
    ps_result result = scene_input_build(input, &scene);
    print_problems(input);
    if (result != PS_OK)
        return false;
    result = render_try(&scene, settings, &callbacks, &error);
    if (result == PS_OK && prints_bounds)
        result = bounds_print(&input->description, &scene, &error);
    scene_release(&scene);
    if (result != PS_OK)
        print_error(error.text);
    return result == PS_OK;
}

static bool check_scene(const struct render_arguments *taken, const char *path, bool prints_bounds)
{
    struct scene_input input;
    struct render_settings settings;
    bool good = render_arguments_read(taken, path, &input);
    if (good) {
        good = scene_input_resolve(&input.description.render, 1, 1, input.sink, &settings) == PS_OK;
        if (good) {
            good = builds(&input, &settings, prints_bounds);
            settings_release(&settings);
        } else {
            print_problems(&input);
        }
    }
    scene_input_release(&input);
    return good;
}

/* In the form of the parameters of plugins. */
static void print_parameter(void *user, const struct psd_parameter *parameter)
{
    size_t *count = user;
    ++*count;
    printf("  %s\n", parameter->name);
    if (parameter->help)
        printf("      %s\n", parameter->help);
    if (parameter->default_value)
        printf("      %s; default: %s\n", parameter->type, parameter->default_value);
    else
        printf("      %s; required\n", parameter->type);
}

static bool list_parameters(const struct scene_options *scene_options, const char *path)
{
    struct diagnostics *sink = diagnostics_create();
    size_t count = 0;
    if (!sink) {
        print_error("out of memory");
        return false;
    }
    printf("%s:\n", path);
    ps_result result =
        psd_list_parameters(path, &scene_options->psd, sink, print_parameter, &count);
    if (result == PS_OK && count == 0)
        printf("  no parameters\n");
    diagnostics_print(sink, stderr);
    diagnostics_destroy(sink);
    return result == PS_OK;
}

/* The scene of a model has none, and is not made to say so. */
static bool list_nothing(const struct scene_options *scene_options, const char *path)
{
    struct input_file file;
    struct error error;
    if (input_file_open(path, scene_options->psd.folder, &file, &error) != PS_OK) {
        fprintf(stderr, "psplat: error: %s: %s\n", path, error.text);
        return false;
    }
    close(file.descriptor);
    printf("%s:\n  no parameters\n", path);
    return true;
}

static bool list_of(const struct scene_options *scene_options, const char *path)
{
    return model_is_file(path) ? list_nothing(scene_options, path)
                               : list_parameters(scene_options, path);
}

static int check_scenes(const struct argument *arguments, size_t count,
                        const struct render_arguments *taken)
{
    int status = STATUS_OK;
    size_t scenes = 0;
    bool lists = asks_for(arguments, count, "parameters");
    bool bounds = asks_for(arguments, count, "bounds");
    for (size_t i = 0; i < count; i++) {
        const char *path = arguments[i].value;
        if (arguments[i].option)
            continue;
        scenes++;
        if (!(lists ? list_of(&taken->options.scene, path) : check_scene(taken, path, bounds)))
            status = STATUS_USAGE;
    }
    if (scenes > 0)
        return status;
    print_error("check: which scene? Try 'psplat check --help'.");
    return STATUS_USAGE;
}

static int run(const struct argument *arguments, size_t count)
{
    struct render_arguments taken;
    int status = STATUS_USAGE;
    if (render_arguments_take(&taken, arguments, count))
        status = check_scenes(arguments, count, &taken);
    render_arguments_release(&taken);
    return status;
}

const struct command command_check = {
    .name = "check",
    .operands = "SCENE.psd|MODEL...",
    .summary = "reads scenes and reports what is wrong with them",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
