/* pbrt.c: from file to files; see pbrt.h.
 *
 * The whole scene is read before anything is written: an error leaves no file.
 */
#include "pbrt/pbrt.h"

#include "base/version.h"
#include "parser/yaml/builder.h"
#include "pbrt/camera.h"
#include "pbrt/parser.h"
#include "pbrt/state.h"
#include "pbrt/version.h"
#include "writer/import_file.h"
#include <stdlib.h>
#include <string.h>

static void release(struct importer *importer)
{
    for (size_t i = 0; i < importer->kept_count; i++) {
        statement_release(importer->kept[i]);
        free(importer->kept[i]);
    }
    free(importer->kept);
    warnings_release(&importer->warnings);
    free(importer->stack);
    free(importer->coordinates);
    free(importer->materials);
    free(importer->textures);
    name_index_release(&importer->materials_by_name);
    name_index_release(&importer->textures_by_name);
    free(importer->objects);
    arena_release(&importer->arena);
    scene_text_release(&importer->scene);
}

static void choose_version(struct importer *importer, const char *name, const char *text,
                           size_t length)
{
    int guess = version_guess(text, length);
    importer->version = importer->options->version ? importer->options->version : guess ? guess : 4;
    if (!importer->options->version && !guess)
        importer_warn(importer, &(struct origin){name, 1, 1}, 1,
                      "no word here tells pbrt-v3 from pbrt-v4; read as pbrt-v4");
}

static const char *word_of(char mark)
{
    return mark == MARK_ATTRIBUTES  ? "AttributeBegin"
           : mark == MARK_TRANSFORM ? "TransformBegin"
           : mark == MARK_OBJECT    ? "ObjectBegin"
                                    : "Import";
}

/* What is open at the end, or missing. */
static void check_end(struct importer *importer, const char *name)
{
    if (importer->stopped)
        return;
    const struct origin start = {name, 1, 1};
    if (!importer->in_world)
        importer_error(importer, &start, 1, "the scene has no WorldBegin");
    if (importer->depth > 0)
        importer_error(importer, &start, 1, "the scene ends before a %s is closed",
                       word_of(importer->stack[importer->depth - 1].mark));
}

/* Parameters of Attribute directives are used by what follows them, or by nothing. */
static void report_attributes(struct importer *importer)
{
    for (size_t i = 0; i < importer->kept_count; i++)
        if (strcmp(importer->kept[i]->directive, "Attribute") == 0)
            statement_report_unused(importer, importer->kept[i]);
}

ps_result pbrt_convert(const char *name, const char *text, size_t length,
                       const struct pbrt_options *options, struct diagnostics *sink,
                       struct written_scene *scene)
{
    struct importer importer = {.options = options, .sink = sink, .mirror = -1.0};
    *scene = (struct written_scene){0};
    importer.state.ctm = importer.camera = transform_identity;
    const char *shown = diagnostics_add_source(sink, name, text, length);
    if (!shown || !scene_text_open(&importer.scene)) {
        importer_no_memory(&importer);
        return PS_ERROR_MEMORY;
    }
    choose_version(&importer, shown, text, length);
    parser_read(&importer, shown, text, length);
    check_end(&importer, shown);
    if (diagnostics_error_count(sink) == 0)
        camera_write(&importer);
    report_attributes(&importer);
    char comment[128];
    snprintf(comment, sizeof comment,
             "# Made by psplat import, version %s, from a scene of pbrt-v%d.\n", PSPLAT_VERSION,
             importer.version);
    if (diagnostics_error_count(sink) == 0 && !scene_text_finish(&importer.scene, comment, scene))
        importer_no_memory(&importer);
    if (scene->text && scene_text_values(scene->text) > MOST_NODES)
        importer_error(&importer, NULL, 0,
                       "the scene has more than %zu values, the most that psplat reads",
                       MOST_NODES);
    release(&importer);
    if (diagnostics_error_count(sink) == 0)
        return PS_OK;
    written_scene_release(scene);
    return importer.no_memory ? PS_ERROR_MEMORY : PS_ERROR_INVALID;
}

/* --- files
 * ------------------------------------------------------------------------------------------ */

struct request {
    const struct pbrt_options *options;
    struct diagnostics *sink;
};

static ps_result convert(void *user, const char *name, const struct file_text *text,
                         const struct import_paths *paths, struct written_scene *scene)
{
    const struct request *request = user;
    struct pbrt_options options = *request->options;
    options.base = paths->base;
    options.scene_folder = paths->scene_folder;
    options.from_output = paths->from_output;
    options.device = text->device;
    options.serial = text->serial;
    return pbrt_convert(name, text->bytes, text->length, &options, request->sink, scene);
}

ps_result pbrt_import(const char *path, const char *output, const struct pbrt_options *options,
                      struct diagnostics *sink, struct error *error)
{
    struct request request = {options, sink};
    return import_file(path, output, convert, &request, error);
}
