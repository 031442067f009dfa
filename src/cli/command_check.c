/* command_check.c: psplat check: is a scene file right? */
#include "cli/command.h"
#include "cli/scene_input.h"

#include <stdio.h>

static const struct option options[] = {
    {'p', "plugin", "KIND=NAME[:KEY=VALUE,...]", "check with another strategy"},
};

static bool check_scene(const struct argument *arguments, size_t count, const char *path)
{
    struct scene_input input;
    struct render_settings settings;
    bool good = scene_input_read(&input, path);
    for (size_t i = 0; i < count && good; i++)
        if (arguments[i].option)
            good = scene_input_override(&input, arguments[i].value);
    if (good) {
        good = scene_input_resolve(&input, 1, 1, &settings);
        if (good)
            settings_release(&settings);
    }
    scene_input_release(&input);
    return good;
}

static int run(const struct argument *arguments, size_t count)
{
    int status = STATUS_OK;
    size_t scenes = 0;
    for (size_t i = 0; i < count; i++) {
        if (arguments[i].option)
            continue;
        scenes++;
        if (!check_scene(arguments, count, arguments[i].value))
            status = STATUS_USAGE;
    }
    if (scenes == 0) {
        print_error("check: which scene? Try 'psplat check --help'.");
        return STATUS_USAGE;
    }
    return status;
}

const struct command command_check = {
    .name = "check",
    .operands = "SCENE.psd...",
    .summary = "reads scenes and reports what is wrong with them",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
