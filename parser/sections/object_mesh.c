/* object_mesh.c: mesh files as objects. */
#include "parser/sections/object.h"

#include "base/suggestion.h"
#include "import/ahead.h"
#include "parser/sections/fill.h"
#include "parser/sections/sections.h"
#include <stdlib.h>
#include <string.h>

/* The words of `use`, in their order in the table. */
enum { USE_GEOMETRY = 1, USE_MATERIALS = 2, USE_CAMERA = 4, USE_LIGHTS = 8 };

static void warn(const struct reader *reader, const struct node *at, size_t count, const char *file,
                 const char *what)
{
    struct origin origin = reader_origin(reader, at);
    if (count > 0)
        diagnostics_report(reader->sink, SEVERITY_WARNING, &origin, at->mark.width, "%s: %zu %s%s",
                           file, count, what, count > 1 ? "s" : "");
}

static void warn_of(const struct reader *reader, const struct node *at, const char *file,
                    const struct mesh_report *report)
{
    struct origin origin = reader_origin(reader, at);
    warn(reader, at, report->dropped_triangles, file, "unusable triangle");
    warn(reader, at, report->dropped_lights, file, "unusable light");
    size_t missing = report->missing_textures;
    if (missing > 0)
        diagnostics_report(reader->sink, SEVERITY_WARNING, &origin, at->mark.width,
                           "%s: %zu missing texture%s: %s%s", file, missing, missing > 1 ? "s" : "",
                           report->missing_names, missing > MESH_MISSING_NAMES ? ", ..." : "");
    for (const char *note = report->notes; *note;) {
        int length = (int)strcspn(note, "\n");
        diagnostics_report(reader->sink, SEVERITY_WARNING, &origin, at->mark.width, "%s: %.*s",
                           file, length, note);
        note += length;
        note += *note == '\n';
    }
}

/* A scene that says what the file does not say gets no warning. */
static void warn_of_plain(const struct reader *reader, const struct node *at, const char *file,
                          size_t count)
{
    struct origin origin = reader_origin(reader, at);
    if (count > 0 && !reader->out_of_memory)
        diagnostics_report(reader->sink, SEVERITY_WARNING, &origin, at->mark.width,
                           "%s: %zu part%s without a material: grey, of reflectance %g; 'material' "
                           "gives another",
                           file, count, count > 1 ? "s" : "", MESH_PLAIN_REFLECTANCE);
}

static bool names_material(const struct material_description *material, const char *name)
{
    return material->name && strcmp(material->name, name) == 0;
}

/* A name of the map stands for every material of the file that has it. */
static bool replace(struct reader *reader, const struct item *item,
                    const struct scene_description *content, size_t *replacements)
{
    struct suggestion suggestion = suggestion_start(item->key->text);
    char hint[SUGGESTION_TEXT];
    size_t material;
    bool found = false;
    if (item->value->kind != NODE_SCALAR || node_is_null(item->value)) {
        reader_error(reader, item->value,
                     "materials in mesh: expected the name of a material, got %s",
                     node_kind_name(item->value));
        return false;
    }
    bool good = reference_material(reader, item->value, &material);
    for (size_t i = 0; i < content->material_count; i++) {
        if (content->materials[i].name)
            suggestion_consider(&suggestion, content->materials[i].name);
        if (!names_material(&content->materials[i], item->key->text))
            continue;
        found = true;
        replacements[i] = good ? material : NO_INDEX;
    }
    suggestion_text(&suggestion, hint);
    if (!found)
        reader_error(reader, item->key, "the mesh file has no material '%s'%s", item->key->text,
                     hint);
    return good && found;
}

static size_t *read_replacements(struct reader *reader, const struct node *map,
                                 const struct scene_description *content, bool *good)
{
    size_t *replacements =
        reader_allocate(reader, content->material_count + 1, sizeof *replacements);
    if (!replacements)
        return NULL;
    for (size_t i = 0; i < content->material_count; i++)
        replacements[i] = NO_INDEX;
    for (const struct item *item = map ? map->first : NULL; item; item = item->next)
        *good = replace(reader, item, content, replacements) && *good;
    return replacements;
}

static void append(struct reader *reader, const struct item *item, const struct object_keys *keys,
                   struct scene_description *content, const struct object_context *placed)
{
    bool good = true;
    const char *name = reader_add_file(reader, keys->file->text);
    struct object_context context = *placed;
    context.placement = (struct affine)AFFINE_IDENTITY; /* which the import applied */
    for (size_t i = 0; i < content->mesh_count; i++)
        content->meshes[i].file = name;
    size_t *replacements = read_replacements(reader, keys->materials, content, &good);
    const struct fragment fragment = {
        .content = content,
        .replacements = replacements,
        .otherwise = keys->object.material,
        .keep_materials = keys->use & USE_MATERIALS,
    };
    if (replacements && good)
        warn_of_plain(reader, item->key, keys->file->text,
                      fragment_append(reader, item->key, &fragment, &context));
    free(replacements);
}

/* A group can stand anywhere, but a camera or a light must be at one place. */
static bool check_use(const struct reader *reader, const struct item *item,
                      const struct object_keys *keys, const struct object_context *context)
{
    const struct item *use = node_find(item->value, "use");
    if (!context->group || !(keys->use & (USE_CAMERA | USE_LIGHTS)))
        return true;
    reader_error(reader, use->value, "use in mesh: a group holds no cameras and no lights");
    return false;
}

void object_mesh_read(struct reader *reader, const struct item *item,
                      const struct object_keys *keys, const struct object_context *context)
{
    struct object_context placed;
    struct scene_description content = {.path = NULL};
    struct mesh_report report = {0};
    struct error error;
    if (!object_place(reader, item, keys, context, &placed) ||
        !check_use(reader, item, keys, context))
        return;
    char *path = reader_path(reader, keys->file, keys->file->text);
    if (!path)
        return;
    const struct mesh_request request = {
        .path = path,
        .folder = reader->description->folder,
        .cache = reader->description->cache,
        .memory_limit = reader->description->memory_limit,
        .geometry = keys->use & USE_GEOMETRY,
        .materials = (keys->use & USE_MATERIALS && keys->object.material == NO_INDEX) ||
                     keys->materials != NULL,
        .camera = keys->use & USE_CAMERA,
        .lights = keys->use & USE_LIGHTS,
        .unit = keys->unit,
        .up = keys->up,
        .diffuse_only = keys->diffuse_only != 0,
        .srgb_colors = keys->colors != 0,
        .bump_scale = keys->bump_scale,
        .smooth_angle = keys->smooth_angle,
        .placement = placed.placement,
        .origin = reader_origin(reader, item->key),
    };
    ps_result result = mesh_take_ahead(reader->ahead, &request, &content, &report)
                           ? PS_OK
                           : mesh_import(&request, &content, &report, &error);
    if (result == PS_OK) {
        reader_add_file(reader, path);
        warn_of(reader, item->key, path, &report);
        append(reader, item, keys, &content, &placed);
    } else {
        reader->out_of_memory = reader->out_of_memory || result == PS_ERROR_MEMORY;
        reader_error(reader, keys->file, "%s", error.text);
    }
    scene_description_release(&content);
    free(path);
}
