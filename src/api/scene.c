/* scene.c: psplat_scene: options, and the scene that was loaded with them. */
#include "api/environment.h"
#include "api/handles.h"
#include "api/report.h"
#include "session/layers.h"

#include "base/version.h"
#include <stdlib.h>

const char *psplat_version(void)
{
    return PSPLAT_VERSION;
}

psplat_scene *psplat_scene_create(void)
{
    psplat_scene *scene = calloc(1, sizeof *scene);
    if (scene)
        scene->options = render_options_init();
    return scene;
}

static void unload(psplat_scene *scene)
{
    if (!scene->is_loaded)
        return;
    trace_destroy(scene->trace);
    scene_release(&scene->scene);
    scene_input_release(&scene->input);
    scene->is_loaded = false;
}

void psplat_scene_destroy(psplat_scene *scene)
{
    if (!scene)
        return;
    unload(scene);
    render_options_release(&scene->options);
    free(scene);
}

ps_result psplat_scene_set(psplat_scene *scene, const char *option, const char *value,
                           psplat_error *error)
{
    struct error reason;
    fenv_t caller;
    environment_enter(&caller);
    ps_result result = render_options_set(&scene->options, option, value, &reason);
    environment_leave(&caller);
    if (result != PS_OK)
        return report_error(error, result, &reason);
    unload(scene);
    return PS_OK;
}

void psplat_scene_listen(psplat_scene *scene, psplat_listener listener, void *user)
{
    scene->listener = listener;
    scene->user = user;
}

/* Whether it can be rendered, by settings that are made for nothing else. */
static ps_result try_settings(psplat_scene *scene)
{
    struct scene_input *input = &scene->input;
    struct render_settings settings;
    struct error error;
    ps_result result =
        render_options_resolve(&scene->options, &input->description, input->sink, &settings);
    if (result != PS_OK)
        return result;
    settings.display = true;
    result = layers_suit(output_options_layers(&scene->options.output), &settings, &error);
    if (result == PS_OK)
        result = render_options_check_size(&input->description.image, &settings, false, &error);
    if (result != PS_OK)
        diagnostics_report(input->sink, SEVERITY_ERROR, NULL, 0, "%s", error.text);
    settings_release(&settings);
    return result;
}

/* The scene, and what traces rays through it. */
static ps_result build(psplat_scene *scene)
{
    struct error error;
    ps_result result = scene_input_build(&scene->input, &scene->scene);
    if (result != PS_OK)
        return result;
    result = trace_create(&scene->scene, scene->options.isa, &scene->trace, &error);
    if (result == PS_OK)
        return PS_OK;
    diagnostics_report(scene->input.sink, SEVERITY_ERROR, NULL, 0, "%s", error.text);
    scene_release(&scene->scene);
    return result;
}

/* What was read becomes a scene, or is released. `result`: that of reading. */
static ps_result finish_loading(psplat_scene *scene, ps_result result, psplat_error *error)
{
    struct scene_input *input = &scene->input;
    if (result == PS_OK)
        result = render_options_lay_over(&scene->options, input);
    if (result == PS_OK)
        result = try_settings(scene);
    if (result == PS_OK)
        result = build(scene);
    report_warnings(scene->listener, scene->user, input->sink);
    scene->is_loaded = result == PS_OK;
    if (scene->is_loaded)
        return PS_OK;
    report_problems(error, result, input->sink);
    scene_input_release(input);
    return result;
}

/* Reads a file, or a text that stands for one. */
static ps_result load(psplat_scene *scene, const char *path, const char *text, size_t length,
                      psplat_error *error)
{
    struct error reason;
    fenv_t caller;
    unload(scene);
    ps_result result = scene_input_create(&scene->input, &reason);
    if (result != PS_OK)
        return report_error(error, result, &reason);
    scene->is_text = text != NULL;
    environment_enter(&caller);
    if (text)
        result = scene_input_read_text(&scene->input, path, text, length, &scene->options.scene);
    else
        result = scene_input_read(&scene->input, path, &scene->options.scene);
    result = finish_loading(scene, result, error);
    environment_leave(&caller);
    return result;
}

ps_result psplat_scene_load(psplat_scene *scene, const char *path, psplat_error *error)
{
    return load(scene, path, NULL, 0, error);
}

ps_result psplat_scene_load_text(psplat_scene *scene, const char *text, size_t length,
                                 const char *name, psplat_error *error)
{
    return load(scene, name ? name : "<text>", text ? text : "", length, error);
}
