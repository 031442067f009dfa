#include "cli/scene_input.h"

#include "cli/command.h"
#include "plugin/kind.h"
#include <stdio.h>
#include <string.h>

static void warn(void *user, const char *message)
{
    (void)user;
    print_warning(message);
}

bool scene_input_read(struct scene_input *input, const char *path,
                      const struct scene_options *options)
{
    struct error error;
    *input = (struct scene_input){.sink = diagnostics_create()};
    if (!input->sink) {
        print_error("out of memory");
        return false;
    }
    if (loader_create(&input->loader, &error) != PS_OK) {
        print_error(error.text);
        return false;
    }
    loader_set_warnings(input->loader, warn, NULL);
    ps_result result = psd_read_file_with(path, &options->psd, input->sink, &input->description);
    if (result != PS_OK)
        diagnostics_print(input->sink, stderr);
    return result == PS_OK && scene_options_choose_camera(options, &input->description);
}

bool scene_input_override(struct scene_input *input, const char *text)
{
    struct strategy_choice choice;
    struct error error;
    char message[sizeof error.text + 64];
    const char *wanted;
    ps_kind kind = kind_parse(text, &wanted);
    if (kind == PS_KINDS || !wanted) {
        snprintf(message, sizeof message,
                 "--plugin: expected KIND=NAME[:KEY=VALUE,...], got '%.200s'; 'psplat plugins' "
                 "lists the kinds",
                 text);
        print_error(message);
        return false;
    }
    ps_result result = settings_parse_choice(wanted, &choice, &error);
    if (result == PS_OK)
        result = settings_override(&input->description.render.strategies[kind], &choice, &error);
    if (result == PS_OK)
        return true;
    snprintf(message, sizeof message, "--plugin %s: %s", kinds[kind].name, error.text);
    print_error(message);
    return false;
}

static void report(void *user, const struct origin *origin, const char *message)
{
    struct diagnostics *sink = user;
    if (origin->line > 0)
        diagnostics_report(sink, SEVERITY_ERROR, origin, 0, "%s", message);
    else
        print_error(message);
}

bool scene_input_resolve(struct scene_input *input, uint32_t threads, size_t batch,
                         struct render_settings *settings)
{
    ps_result result = settings_resolve(input->loader, &input->description.render, threads, batch,
                                        report, input->sink, settings);
    if (result != PS_OK)
        diagnostics_print(input->sink, stderr);
    return result == PS_OK;
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

ps_result scene_input_build(struct scene_input *input, struct scene *scene, struct error *error)
{
    struct origin where = {0};
    ps_result result = scene_create(&input->description, scene, &where, error);
    if (result == PS_OK) {
        warn_of_dropped(input->sink, &where, scene->dropped_triangles);
    } else if (where.line > 0) {
        diagnostics_report(input->sink, SEVERITY_ERROR, &where, 0, "%s", error->text);
        error->text[0] = '\0';
    }
    diagnostics_print(input->sink, stderr);
    return result;
}

void scene_input_release(struct scene_input *input)
{
    scene_description_release(&input->description);
    loader_destroy(input->loader);
    diagnostics_destroy(input->sink);
}
