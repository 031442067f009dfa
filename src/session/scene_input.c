#include "session/scene_input.h"

#include "job/scene_message.h"
#include "model/model.h"
#include "model/model_scene.h"
#include "session/option_value.h"
#include <stdlib.h>
#include <string.h>

ps_result scene_input_create(struct scene_input *input, struct error *error)
{
    *input = (struct scene_input){.sink = diagnostics_create()};
    return input->sink ? PS_OK : error_set(error, PS_ERROR_MEMORY, "out of memory");
}

/* The text stands for the model's file in messages, and where files are looked for. */
static ps_result read_model(struct scene_input *input, const char *path,
                            const struct psd_options *options)
{
    struct error error;
    char *text = NULL;
    struct mesh_ahead content;
    struct psd_options with_content = *options;
    const struct model_file file = {path, options->folder, options->cache, options->memory_limit};
    ps_result result = model_scene_make(&file, NULL, &text, &content, &error);
    if (result != PS_OK) {
        diagnostics_report(input->sink, SEVERITY_ERROR, NULL, 0, "%s", error.text);
        return result;
    }
    with_content.ahead = &content;
    result = psd_read_text_with(path, text, strlen(text), &with_content, input->sink,
                                &input->description);
    mesh_ahead_release(&content);
    free(text);
    return result;
}

ps_result scene_input_read(struct scene_input *input, const char *path,
                           const struct scene_options *options)
{
    ps_result result = model_is_file(path) ? read_model(input, path, &options->psd)
                                           : psd_read_file_with(path, &options->psd, input->sink,
                                                                &input->description);
    return result == PS_OK ? scene_options_choose_camera(options, &input->description, input->sink)
                           : result;
}

ps_result scene_input_read_text(struct scene_input *input, const char *name, const char *text,
                                size_t length, const struct scene_options *options)
{
    ps_result result =
        psd_read_text_with(name, text, length, &options->psd, input->sink, &input->description);
    return result == PS_OK ? scene_options_choose_camera(options, &input->description, input->sink)
                           : result;
}

static ps_result receive(struct scene_input *input, const struct transport *transport)
{
    struct error error;
    ps_result result = scene_message_receive(transport, &input->description, &error);
    if (result != PS_OK)
        diagnostics_report(input->sink, SEVERITY_ERROR, NULL, 0, "%s", error.text);
    return result;
}

ps_result scene_input_share(struct scene_input *input, const char *path,
                            const struct scene_options *options, const struct transport *transport)
{
    if (transport->rank > 0)
        return receive(input, transport);
    ps_result result = scene_input_read(input, path, options);
    scene_message_send(transport, result == PS_OK ? &input->description : NULL);
    return result;
}

void scene_input_share_none(const struct transport *transport)
{
    if (transport->rank > 0)
        scene_message_skip(transport);
    else
        scene_message_send(transport, NULL);
}

ps_result scene_input_override(struct scene_input *input, const char *text)
{
    struct strategy_choice choice;
    struct error error;
    ps_kind kind;
    ps_result result = option_plugin(text, &kind, &choice, &error);
    if (result == PS_OK)
        result = settings_override(&input->description.render.strategies[kind], &choice, &error);
    if (result != PS_OK)
        diagnostics_report(input->sink, SEVERITY_ERROR, NULL, 0, "%s", error.text);
    return result;
}

static void warn(void *sink, const char *message)
{
    diagnostics_report(sink, SEVERITY_WARNING, NULL, 0, "%s", message);
}

static void report(void *sink, const struct origin *origin, const char *message)
{
    diagnostics_report(sink, SEVERITY_ERROR, origin->line > 0 ? origin : NULL, 0, "%s", message);
}

ps_result scene_input_resolve(const struct render_description *description, uint32_t threads,
                              size_t batch, struct diagnostics *sink,
                              struct render_settings *settings)
{
    struct loader *loader;
    struct error error;
    ps_result result = loader_create(&loader, &error);
    if (result != PS_OK) {
        diagnostics_report(sink, SEVERITY_ERROR, NULL, 0, "%s", error.text);
        return result;
    }
    loader_set_warnings(loader, warn, sink);
    result = settings_resolve(loader, description, threads, batch, report, sink, settings);
    loader_destroy(loader);
    return result;
}

static void warn_of_dropped(struct diagnostics *sink, const struct origin *first, size_t count)
{
    if (count == 1)
        diagnostics_report(sink, SEVERITY_WARNING, first, 0, "a triangle without area is left out");
    else if (count > 1)
        diagnostics_report(sink, SEVERITY_WARNING, first, 0,
                           "%zu triangles without area are left out; the first of them are here",
                           count);
}

static void warn_of_textures(const struct scene_input *input, const struct scene *scene)
{
    for (size_t i = 0; i < scene->texture_count; i++) {
        const struct texture *texture = &scene->textures[i];
        const struct texture_description *from = &input->description.textures[i];
        size_t mended = texture->raster.mended;
        if (mended > 0)
            diagnostics_report(input->sink, SEVERITY_WARNING, &from->origin, 0,
                               "%s: %zu number%s NaN or infinite: NaN counts as 0, infinity as "
                               "65504",
                               from->path, mended, mended > 1 ? "s are" : " is");
        if (texture->note)
            diagnostics_report(input->sink, SEVERITY_WARNING, &from->origin, 0,
                               "%s: it is not kept in the cache: %s", from->path, texture->note);
        if (texture->clipped)
            diagnostics_report(input->sink, SEVERITY_WARNING, &from->origin, 0,
                               "%s: reflectances above 1 count as 1, and below 0 as 0", from->path);
    }
}

ps_result scene_input_build(struct scene_input *input, struct scene *scene)
{
    struct origin where = {0};
    struct error error;
    ps_result result = scene_create(&input->description, scene, &where, &error);
    if (result != PS_OK) {
        report(input->sink, &where, error.text);
        return result;
    }
    warn_of_dropped(input->sink, &where, scene->dropped_triangles);
    warn_of_textures(input, scene);
    return PS_OK;
}

void scene_input_release(struct scene_input *input)
{
    scene_description_release(&input->description);
    diagnostics_destroy(input->sink);
}
