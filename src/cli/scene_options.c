#include "cli/scene_options.h"

#include "base/input_file.h"
#include "base/suggestion.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static size_t collect(const struct argument *arguments, size_t count, const char *name,
                      const char **words)
{
    size_t found = 0;
    for (size_t i = 0; i < count; i++)
        if (argument_is(&arguments[i], name))
            words[found++] = arguments[i].value;
    return found;
}

static const char *last_value(const struct argument *arguments, size_t count, const char *name)
{
    while (count > 0 && !argument_is(&arguments[count - 1], name))
        count--;
    return count > 0 ? arguments[count - 1].value : NULL;
}

/* A plugin can read any file, so that it makes no sense to limit which ones the scene names. */
static bool restrict_to(struct scene_options *options, const char *path)
{
    struct error error;
    if (!path)
        return true;
    if (options->psd.allow_plugin_paths) {
        print_error("--restrict and --allow-scene-plugins exclude each other");
        return false;
    }
    options->folder = input_folder_resolve(path, &error);
    options->psd.folder = options->folder;
    if (!options->folder)
        fprintf(stderr, "psplat: error: --restrict: %s\n", error.text);
    return options->folder != NULL;
}

bool scene_options_take(struct scene_options *options, const struct argument *arguments,
                        size_t count)
{
    *options = (struct scene_options){.words = calloc(count + 1, sizeof *options->words)};
    if (!options->words) {
        print_error("out of memory");
        return false;
    }
    options->psd.parameters = options->words;
    options->psd.parameter_count = collect(arguments, count, "param", options->words);
    options->psd.sets = options->words + options->psd.parameter_count;
    options->psd.set_count =
        collect(arguments, count, "set", options->words + options->psd.parameter_count);
    options->camera = last_value(arguments, count, "camera");
    for (size_t i = 0; i < count; i++)
        if (argument_is(&arguments[i], "allow-scene-plugins"))
            options->psd.allow_plugin_paths = true;
    return restrict_to(options, last_value(arguments, count, "restrict"));
}

void scene_options_release(struct scene_options *options)
{
    free(options->words);
    free(options->folder);
    *options = (struct scene_options){0};
}

/* A scene's only camera needs no name. */
static const char *name_of(const struct camera_description *camera)
{
    return camera->name ? camera->name : "camera";
}

static void report_unknown(const char *name, const struct scene_description *description)
{
    struct suggestion suggestion = suggestion_start(name);
    char hint[SUGGESTION_TEXT];
    for (size_t i = 0; i < description->camera_count; i++)
        suggestion_consider(&suggestion, name_of(&description->cameras[i]));
    suggestion_text(&suggestion, hint);
    fprintf(stderr, "psplat: error: --camera: the scene has no camera '%s'%s", name, hint);
    for (size_t i = 0; i < description->camera_count && !suggestion.best; i++)
        fprintf(stderr, "%s%s", i > 0 ? ", " : "; it has ", name_of(&description->cameras[i]));
    fprintf(stderr, "\n");
}

bool scene_options_choose_camera(const struct scene_options *options,
                                 struct scene_description *description)
{
    if (!options->camera)
        return true;
    for (size_t i = 0; i < description->camera_count; i++)
        if (strcmp(name_of(&description->cameras[i]), options->camera) == 0) {
            struct camera_description chosen = description->cameras[i];
            memmove(description->cameras + 1, description->cameras, i * sizeof chosen);
            description->cameras[0] = chosen;
            return true;
        }
    report_unknown(options->camera, description);
    return false;
}

static void each_option(const char *option, const char *const *values, size_t count,
                        void (*each)(void *user, const char *word), void *user)
{
    for (size_t i = 0; i < count; i++) {
        each(user, option);
        each(user, values[i]);
    }
}

void scene_options_each_word(const struct scene_options *options,
                             void (*each)(void *user, const char *word), void *user)
{
    each_option("--param", options->psd.parameters, options->psd.parameter_count, each, user);
    each_option("--set", options->psd.sets, options->psd.set_count, each, user);
    each_option("--camera", &options->camera, options->camera ? 1 : 0, each, user);
    if (options->psd.allow_plugin_paths)
        each(user, "--allow-scene-plugins");
}
