/* scene.c: psplat_scene: options, and the scene that was loaded with them. */
#include "api/environment.h"
#include "api/handles.h"
#include "api/report.h"
#include "session/layers.h"

#include "base/clock.h"
#include "base/version.h"
#include "model/model.h"
#include <stdlib.h>

const char *psplat_version(void)
{
    return PSPLAT_VERSION;
}

int psplat_scene_is_model(const char *path)
{
    return model_is_file(path);
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
    fenv_t caller;
    environment_enter(&caller);
    unload(scene);
    processes_leave(scene->processes);
    environment_leave(&caller);
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
    result = layers_check_denoiser(output_options_layers(&scene->options.output.options), &settings,
                                   &error);
    if (result == PS_OK)
        result = render_options_check_size(&scene->options, &input->description.image, &settings,
                                           &error);
    if (result != PS_OK)
        diagnostics_report(input->sink, SEVERITY_ERROR, NULL, 0, "%s", error.text);
    settings_release(&settings);
    return result;
}

static ps_result report_to(struct diagnostics *sink, ps_result result, const struct error *error)
{
    if (result != PS_OK)
        diagnostics_report(sink, SEVERITY_ERROR, NULL, 0, "%s", error->text);
    return result;
}

/* The scene, and what traces rays through it. */
static ps_result build(psplat_scene *scene)
{
    struct error error;
    double start = clock_seconds();
    ps_result result = scene_input_build(&scene->input, &scene->scene);
    double made = clock_seconds();
    if (result != PS_OK)
        return result;
    result = trace_create(&scene->scene, scene->options.isa, &scene->trace, &error);
    scene->times.scene = made - start;
    scene->times.build = clock_seconds() - made;
    if (result != PS_OK)
        scene_release(&scene->scene);
    return report_to(scene->input.sink, result, &error);
}

static bool writes(const psplat_scene *scene)
{
    return processes_is_first(scene->processes);
}

static ps_result spare_scene(psplat_scene *scene)
{
    struct error error;
    ps_result result = PS_OK;
    if (writes(scene))
        result = render_options_check_not_input(&scene->options, &scene->input.description, &error);
    return report_to(scene->input.sink, result, &error);
}

/* What was read becomes a scene, or is released. `result`: that of reading. */
static ps_result finish_loading(psplat_scene *scene, ps_result result, psplat_error *error)
{
    struct scene_input *input = &scene->input;
    double start = clock_seconds();
    if (result == PS_OK)
        result = render_options_apply(&scene->options, input);
    if (result == PS_OK)
        result = try_settings(scene);
    if (result == PS_OK)
        result = spare_scene(scene);
    scene->times.load += clock_seconds() - start;
    if (result == PS_OK)
        result = build(scene);
    if (writes(scene))
        report_warnings(scene->listener, scene->user, input->sink);
    scene->is_loaded = result == PS_OK;
    if (scene->is_loaded)
        return PS_OK;
    report_problems(error, result, input->sink);
    scene_input_release(input);
    return report_of_process(error, result, scene->processes);
}

/* Finds out what can be told before anything is read, and joins the other processes. */
static ps_result prepare(psplat_scene *scene, struct error *error)
{
    const struct render_options *options = &scene->options;
    ps_result result = render_options_check(options, error);
    if (result == PS_OK && options->job.mpi && !scene->processes)
        result = processes_join(&scene->processes, error);
    if (result == PS_OK && scene->processes)
        scene->processes->has_agreed = false;
    if (result == PS_OK && writes(scene))
        result = render_options_check_files(options, error);
    return result == PS_OK ? scene_input_create(&scene->input, error) : result;
}

/* A file, or a text that stands for one. */
struct source {
    const char *path, *text; /* text NULL: a file */
    size_t length;
};

static ps_result read_source(psplat_scene *scene, const struct source *from)
{
    const struct scene_options *options = &scene->options.scene;
    struct scene_input *input = &scene->input;
    if (from->text)
        return scene_input_read_text(input, from->path, from->text, from->length, options);
    if (scene->processes)
        return scene_input_share(input, from->path, options, &scene->processes->transport);
    return scene_input_read(input, from->path, options);
}

static ps_result load(psplat_scene *scene, const struct source *from, psplat_error *error)
{
    struct error reason;
    fenv_t caller;
    unload(scene);
    environment_enter(&caller);
    double start = clock_seconds();
    ps_result result = prepare(scene, &reason);
    if (result == PS_OK) {
        scene->is_text = from->text != NULL;
        result = read_source(scene, from);
        scene->times = (struct load_times){.load = clock_seconds() - start};
        result = finish_loading(scene, result, error);
    } else {
        if (scene->processes && !from->text)
            scene_input_share_none(&scene->processes->transport);
        report_error(error, result, &reason);
        result = report_of_process(error, result, scene->processes);
    }
    environment_leave(&caller);
    return result;
}

ps_result psplat_scene_load(psplat_scene *scene, const char *path, psplat_error *error)
{
    const struct source file = {.path = path};
    return load(scene, &file, error);
}

ps_result psplat_scene_load_text(psplat_scene *scene, const char *text, size_t length,
                                 const char *name, psplat_error *error)
{
    const struct source source = {name ? name : "<text>", text ? text : "", length};
    return load(scene, &source, error);
}
