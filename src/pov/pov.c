/* pov.c: from text to scene; see pov.h.
 *
 * The whole scene is read before anything is written: an error leaves no file.
 */
#include "pov/pov.h"

#include "base/version.h"
#include "parser/yaml/builder.h"
#include "pov/write.h"
#include "writer/import_file.h"
#include <stdlib.h>
#include <string.h>

static void write_all(struct pov_reader *reader)
{
    size_t steps = reader->options->most_steps;
    struct pov_writer writer = {
        .reader = reader, .cutting_left = POV_MOST_CUTTING * (steps ? steps : POV_MOST_STEPS)};
    const struct pov_above world = {.place = transform_identity,
                                    .texture_place = transform_identity};
    if (!reader->has_gamma)
        pov_warn(reader, &(struct pov_token){0},
                 "no assumed_gamma: colours are taken for linear ones");
    pov_write_camera(&writer);
    for (size_t i = 0; i < reader->object_count && !reader->stopped; i++)
        pov_write_object(&writer, reader->objects[i], &world);
    if (!reader->stopped)
        pov_write_sky(&writer);
    name_index_release(&writer.meshes);
    free(writer.mesh_files);
    name_index_release(&writer.picture_index);
    free(writer.pictures);
    name_index_release(&writer.solid_index);
    for (size_t i = 0; i < writer.solid_count; i++)
        free(writer.solids[i].pieces);
    free(writer.solids);
}

static void finish(struct pov_reader *reader, struct written_scene *scene)
{
    static const char comment[] =
        "# Made by psplat import, version " PSPLAT_VERSION ", from a scene of POV-Ray.\n";
    if (!scene_text_finish(&reader->scene, comment, scene))
        pov_no_memory(reader);
    else if (scene_text_values(scene->text) > MOST_NODES)
        diagnostics_report(reader->sink, SEVERITY_ERROR, NULL, 0,
                           "the scene has more than %zu values, the most that psplat reads",
                           MOST_NODES);
}

/* A reader of its own on the heap: it is large. NULL: out of memory. */
static struct pov_reader *start(const struct pov_options *options, struct diagnostics *sink)
{
    struct pov_reader *reader = calloc(1, sizeof *reader);
    if (!reader)
        return NULL;
    reader->options = options;
    reader->sink = sink;
    reader->version = 3.7;
    reader->gamma = 1.0;
    for (int i = 0; i < 3; i++)
        reader->ambient_light[i] = 1.0;
    struct pov_look *look = pov_allocate(reader, 1, sizeof *look);
    if (!look || !scene_text_open(&reader->scene)) {
        arena_release(&reader->arena);
        free(reader);
        return NULL;
    }
    *look = (struct pov_look){
        .texture = {.pigment = pov_usual_pigment, .finish = pov_usual_finish, .name = POV_texture},
        .interior = pov_usual_interior};
    reader->look = look;
    return reader;
}

ps_result pov_convert(const char *name, const char *text, size_t length,
                      const struct pov_options *options, struct diagnostics *sink,
                      struct written_scene *scene)
{
    struct pov_reader *reader = start(options, sink);
    *scene = (struct written_scene){0};
    if (!reader) {
        diagnostics_report(sink, SEVERITY_ERROR, NULL, 0, "out of memory");
        return PS_ERROR_MEMORY;
    }
    if (pov_start(reader, name, text, length))
        pov_read_scene(reader);
    if (!reader->stopped)
        write_all(reader);
    if (!reader->stopped)
        finish(reader, scene);
    bool no_memory = reader->no_memory;
    pov_release(reader);
    free(reader);
    if (diagnostics_error_count(sink) == 0)
        return PS_OK;
    written_scene_release(scene);
    return no_memory ? PS_ERROR_MEMORY : PS_ERROR_INVALID;
}

struct request {
    const struct pov_options *options;
    struct diagnostics *sink;
};

static ps_result convert(void *user, const char *name, const struct file_text *text,
                         const struct import_paths *paths, struct written_scene *scene)
{
    const struct request *request = user;
    struct pov_options options = *request->options;
    options.base = paths->base;
    options.scene_folder = paths->scene_folder;
    options.from_output = paths->from_output;
    options.device = text->device;
    options.serial = text->serial;
    return pov_convert(name, text->bytes, text->length, &options, request->sink, scene);
}

ps_result pov_import(const char *path, const char *output, const struct pov_options *options,
                     struct diagnostics *sink, struct error *error)
{
    struct request request = {options, sink};
    return import_file(path, output, convert, &request, error);
}
