/* pbrt.c: from file to files; see pbrt.h.
 *
 * The whole scene is read before anything is written: an error leaves no file.
 */
#include "pbrt/pbrt.h"

#include "base/file.h"
#include "base/path.h"
#include "base/version.h"
#include "parser/yaml/builder.h"
#include "parser/yaml/encoding.h"
#include "pbrt/camera.h"
#include "pbrt/parser.h"
#include "pbrt/scene_files.h"
#include "pbrt/state.h"
#include "pbrt/version.h"
#include <stdlib.h>
#include <string.h>

static void release(struct importer *importer)
{
    for (size_t i = 0; i < importer->kept_count; i++) {
        statement_release(importer->kept[i]);
        free(importer->kept[i]);
    }
    for (size_t i = 0; i < importer->said_count; i++)
        free(importer->said[i]);
    free(importer->kept);
    free(importer->said);
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
                       struct pbrt_scene *scene)
{
    struct importer importer = {.options = options, .sink = sink, .mirror = -1.0};
    *scene = (struct pbrt_scene){0};
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
    pbrt_scene_release(scene);
    return importer.no_memory ? PS_ERROR_MEMORY : PS_ERROR_INVALID;
}

/* --- files ------------------------------------------------------------------------------------------ */

/* "FOLDER/" of a path, or ""; to be freed. */
static char *folder_of(const char *path)
{
    return strndup(path, (size_t)(path_name(path) - path));
}

static char *resolved(const char *folder)
{
    return realpath(*folder ? folder : ".", NULL);
}

/* How one folder is reached from another, which ends in a slash or is ""; to be freed. NULL: out of memory, or there
 * is no such folder. */
static char *path_between(const char *from, const char *to)
{
    char *a = resolved(from), *b = resolved(to), *path = NULL;
    if (a && b) {
        size_t common = path_common_length(a, b), ups = 0;
        for (const char *c = a + common; *c; c++)
            ups += *c == '/' && c[1];
        const char *rest = b[common] == '/' ? b + common + 1 : b + common;
        size_t size = 3 * ups + strlen(rest) + 2;
        path = calloc(1, size);
        for (size_t i = 0; i < ups && path; i++)
            strcat(path, "../");
        if (path && *rest)
            strcat(strcat(path, rest), "/");
    }
    free(a);
    free(b);
    return path;
}

/* Reads and converts; errors of reading go to `error`. */
static ps_result convert_file(const char *path, const struct pbrt_options *options,
                              struct diagnostics *sink, struct pbrt_scene *scene,
                              struct error *error)
{
    struct file_text text = {0};
    struct pbrt_options whole = *options;
    ps_result result = file_read(path, &text, error);
    if (result == PS_OK) {
        whole.device = text.device;
        whole.serial = text.serial;
        result = pbrt_convert(path, text.bytes, text.length, &whole, sink, scene);
    } else {
        struct error reason = *error;
        error_set(error, result, "%s: %.2000s", path, reason.text);
    }
    file_release(&text);
    return result;
}

ps_result pbrt_import(const char *path, const char *output, const struct pbrt_options *options,
                      struct diagnostics *sink, struct error *error)
{
    char *scene_folder = folder_of(path), *output_folder = folder_of(output), *base = NULL,
         *between = NULL;
    struct pbrt_scene scene = {0};
    ps_result result = PS_OK;
    error->text[0] = '\0';
    if (scene_folder && output_folder) {
        base = strdup(output + strlen(output_folder));
        between = path_between(output_folder, scene_folder);
    }
    if (!base || !between) {
        result =
            error_set(error, PS_ERROR_IO, "%s: can't find its folder, or that of %s", output, path);
    } else if (!utf8_is_valid(base, strlen(base)) || !utf8_is_valid(between, strlen(between))) {
        result = error_set(error, PS_ERROR_INVALID,
                           "%s: its name, and the way from it to %s, must be UTF-8", output, path);
    } else {
        struct pbrt_options whole = *options;
        base[strlen(base) - strlen(".psd")] = '\0';
        whole.base = base;
        whole.scene_folder = scene_folder;
        whole.from_output = between;
        result = convert_file(path, &whole, sink, &scene, error);
        if (result == PS_OK)
            result = scene_files_write(&scene, path, output, output_folder, error);
    }
    pbrt_scene_release(&scene);
    free(scene_folder);
    free(output_folder);
    free(base);
    free(between);
    return result;
}
