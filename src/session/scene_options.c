#include "session/scene_options.h"

#include "base/input_file.h"
#include "base/suggestion.h"
#include "session/option_value.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* The parser's view of the lists, which may have moved. */
static void refer_to_words(struct scene_options *options)
{
    options->psd.parameters = (const char *const *)options->parameters.words;
    options->psd.parameter_count = options->parameters.count;
    options->psd.sets = (const char *const *)options->sets.words;
    options->psd.set_count = options->sets.count;
}

ps_result scene_options_add_parameter(struct scene_options *options, const char *word,
                                      struct error *error)
{
    ps_result result = option_assignment("param", word, error);
    if (result == PS_OK)
        result = word_list_insert(&options->parameters, options->parameters.count, word, error);
    refer_to_words(options);
    return result;
}

ps_result scene_options_add_set(struct scene_options *options, size_t index, const char *word,
                                struct error *error)
{
    ps_result result = option_assignment("set", word, error);
    if (result == PS_OK)
        result = word_list_insert(&options->sets, index, word, error);
    refer_to_words(options);
    return result;
}

static ps_result refuse_both(struct error *error)
{
    return error_set(error, PS_ERROR_INVALID,
                     "--restrict and --allow-scene-plugins exclude each other");
}

ps_result scene_options_allow_plugins(struct scene_options *options, struct error *error)
{
    if (options->folder)
        return refuse_both(error);
    options->psd.allow_plugin_paths = true;
    return PS_OK;
}

/* The absolute path of an option's folder takes the place of an earlier one. */
static ps_result take_folder(const char *option, const char *path, char **folder,
                             struct error *error)
{
    struct error reason;
    char *resolved = input_folder_resolve(path, &reason);
    if (!resolved)
        return error_set(error, PS_ERROR_IO, "--%s: %.4000s", option, reason.text);
    free(*folder);
    *folder = resolved;
    return PS_OK;
}

ps_result scene_options_restrict(struct scene_options *options, const char *path,
                                 struct error *error)
{
    if (options->psd.allow_plugin_paths)
        return refuse_both(error);
    ps_result result = take_folder("restrict", path, &options->folder, error);
    options->psd.folder = options->folder;
    return result;
}

ps_result scene_options_cache(struct scene_options *options, const char *path, struct error *error)
{
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
        return error_set(error, PS_ERROR_IO, "--cache: cannot make the folder %.1000s: %s", path,
                         strerror(errno));
    ps_result result = take_folder("cache", path, &options->cache, error);
    options->psd.cache = options->cache;
    return result;
}

void scene_options_release(struct scene_options *options)
{
    free(options->cache);
    word_list_release(&options->parameters);
    word_list_release(&options->sets);
    free(options->folder);
    free(options->camera);
    *options = (struct scene_options){0};
}

/* A scene's only camera needs no name. */
static const char *name_of(const struct camera_description *camera)
{
    return camera->name ? camera->name : "camera";
}

static void report_unknown(const char *name, const struct scene_description *description,
                           struct diagnostics *sink)
{
    struct suggestion suggestion = suggestion_start(name);
    char hint[SUGGESTION_TEXT], names[1000] = "";
    for (size_t i = 0; i < description->camera_count; i++)
        suggestion_consider(&suggestion, name_of(&description->cameras[i]));
    suggestion_text(&suggestion, hint);
    for (size_t i = 0; i < description->camera_count && !suggestion.best; i++) {
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", i > 0 ? ", " : "; it has ",
                 name_of(&description->cameras[i]));
    }
    diagnostics_report(sink, SEVERITY_ERROR, NULL, 0, "--camera: the scene has no camera '%s'%s%s",
                       name, hint, names);
}

ps_result scene_options_choose_camera(const struct scene_options *options,
                                      struct scene_description *description,
                                      struct diagnostics *sink)
{
    if (!options->camera)
        return PS_OK;
    for (size_t i = 0; i < description->camera_count; i++)
        if (strcmp(name_of(&description->cameras[i]), options->camera) == 0) {
            struct camera_description chosen = description->cameras[i];
            memmove(description->cameras + 1, description->cameras, i * sizeof chosen);
            description->cameras[0] = chosen;
            return PS_OK;
        }
    report_unknown(options->camera, description, sink);
    return PS_ERROR_INVALID;
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
    const char *camera = options->camera;
    each_option("--param", options->psd.parameters, options->psd.parameter_count, each, user);
    each_option("--set", options->psd.sets, options->psd.set_count, each, user);
    each_option("--camera", &camera, camera ? 1 : 0, each, user);
    if (options->psd.allow_plugin_paths)
        each(user, "--allow-scene-plugins");
}
