/* gltf.c: from the text to the tree, through the scene's nodes, and what of it assimp is not to
 * see. */
#include "import/gltf_data.h"

#include <string.h>

/* --- the document
 * ------------------------------------------------------------------------------ */

static const char *const known_extensions[] = {
    "EXT_mesh_gpu_instancing", "EXT_meshopt_compression",
    "EXT_texture_webp",        "KHR_draco_mesh_compression",
    "KHR_lights_punctual",     "KHR_materials_emissive_strength",
    "KHR_materials_ior",       "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_specular",  "KHR_materials_transmission",
    "KHR_materials_unlit",     "KHR_materials_variants",
    "KHR_materials_volume",    "KHR_mesh_quantization",
    "KHR_texture_basisu",      "KHR_texture_transform",
};

static bool is_known_extension(const struct json *name)
{
    if (name->kind != JSON_STRING)
        return false;
    for (size_t i = 0; i < sizeof known_extensions / sizeof known_extensions[0]; i++)
        if (json_is(&name->text, known_extensions[i]))
            return true;
    return false;
}

static ps_result check_required_extensions(const struct gltf *gltf, struct error *error)
{
    const struct json *required = json_member(gltf->root, "extensionsRequired");
    for (size_t i = 0; required && i < required->count; i++) {
        const struct json *name = json_element(required, i);
        if (!name)
            return gltf_refuse(error, "extensionsRequired is no array");
        if (!is_known_extension(name))
            return error_set(error, PS_ERROR_INVALID,
                             "glTF: the file requires the extension %.*s, which psplat lacks",
                             name->text.length < 100 ? (int)name->text.length : 100,
                             name->text.start ? name->text.start : "");
    }
    return PS_OK;
}

static ps_result check_document(const struct gltf *gltf, struct error *error)
{
    const struct json *version = json_member(json_member(gltf->root, "asset"), "version");
    if (!version || version->kind != JSON_STRING || version->text.length < 2 ||
        memcmp(version->text.start, "2.", 2) != 0)
        return gltf_refuse(error, "the file does not say that it is of version 2");
    return check_required_extensions(gltf, error);
}

/* --- what meshes are made of
 * --------------------------------------------------------------------- */

#define DRACO "KHR_draco_mesh_compression"

bool gltf_is_draco(const struct json *primitive)
{
    return json_member(json_member(primitive, "extensions"), DRACO) != NULL;
}

/* --- the walk
 * ---------------------------------------------------------------------------------- */

/* A walk through the nodes in assimp's order. */
struct walk {
    struct gltf *gltf;
    bool *seen_nodes, *seen_meshes, *seen_materials;
    struct error *error;
};

static size_t count_of(const struct gltf *gltf, const char *name)
{
    const struct json *array = json_member(gltf->root, name);
    return array && array->kind == JSON_ARRAY ? array->count : 0;
}

/* As the file says; assimp leaves out those of vertices that are not there. */
static size_t count_triangles(const struct gltf *gltf, const struct json *primitive)
{
    size_t mode, accessor, corners;
    const struct json *attributes = json_member(primitive, "attributes");
    bool has_indices = json_member(primitive, "indices") != NULL;
    if (!json_size(primitive, "mode", 4, &mode) || mode < 4 ||
        !json_size(has_indices ? primitive : attributes, has_indices ? "indices" : "POSITION",
                   SIZE_MAX, &accessor) ||
        !json_size(json_element(json_member(gltf->root, "accessors"), accessor), "count", 0,
                   &corners))
        return 0;
    return mode == 4 ? corners / 3 : corners > 2 ? corners - 2 : 0;
}

static ps_result meet_materials(struct walk *walk, const struct json *mesh)
{
    struct gltf *gltf = walk->gltf;
    const struct json *primitives = json_member(mesh, "primitives");
    for (size_t i = 0; primitives && i < primitives->count; i++) {
        const struct json *primitive = json_element(primitives, i);
        size_t index;
        gltf->primitives[gltf->primitive_count++] = primitive;
        gltf->draco |= gltf_is_draco(primitive);
        gltf->triangle_count += count_triangles(gltf, primitive);
        if (!json_member(primitive, "material"))
            continue;
        if (!json_size(primitive, "material", 0, &index) || index >= count_of(gltf, "materials"))
            return gltf_refuse(walk->error, "a mesh has a material that the file lacks");
        if (!walk->seen_materials[index])
            gltf->materials[gltf->material_count++] =
                json_element(json_member(gltf->root, "materials"), index);
        walk->seen_materials[index] = true;
    }
    return PS_OK;
}

static ps_result visit_mesh(struct walk *walk, const struct json *node)
{
    size_t index;
    if (!json_member(node, "mesh"))
        return PS_OK;
    if (!json_size(node, "mesh", 0, &index) || index >= count_of(walk->gltf, "meshes"))
        return gltf_refuse(walk->error, "a node has a mesh that the file lacks");
    const struct json *mesh = json_element(json_member(walk->gltf->root, "meshes"), index);
    const struct json *primitives = json_member(mesh, "primitives");
    size_t placed = primitives ? primitives->count : 0;
    if (placed > MESH_OBJECTS - walk->gltf->placed)
        return gltf_refuse(walk->error, "nodes and primitives make more than 1000000 objects");
    walk->gltf->placed += placed;
    if (walk->seen_meshes[index])
        return PS_OK;
    walk->seen_meshes[index] = true;
    return meet_materials(walk, mesh);
}

static ps_result visit_nodes(struct walk *walk, const struct json *indices, int depth);

static ps_result visit_node(struct walk *walk, const struct json *reference, int depth)
{
    struct gltf *gltf = walk->gltf;
    if (reference->kind != JSON_NUMBER || reference->number < 0 ||
        reference->number >= (double)count_of(gltf, "nodes") ||
        reference->number != (double)(size_t)reference->number)
        return gltf_refuse(walk->error, "a node that the file lacks is named");
    size_t index = (size_t)reference->number;
    if (walk->seen_nodes[index])
        return gltf_refuse(walk->error, "a node has two parents, or is its own");
    if (depth > GLTF_DEPTH)
        return gltf_refuse(walk->error, "nodes are nested more than 256 deep");
    walk->seen_nodes[index] = true;
    const struct json *node = json_element(json_member(gltf->root, "nodes"), index);
    gltf->nodes[gltf->node_count++] = node;
    ps_result result = visit_nodes(walk, json_member(node, "children"), depth + 1);
    return result == PS_OK ? visit_mesh(walk, node) : result;
}

static ps_result visit_nodes(struct walk *walk, const struct json *indices, int depth)
{
    ps_result result = PS_OK;
    for (size_t i = 0; result == PS_OK && indices && i < indices->count; i++) {
        const struct json *reference = json_element(indices, i);
        result = reference ? visit_node(walk, reference, depth)
                           : gltf_refuse(walk->error, "a list of nodes is no array");
    }
    return result;
}

static size_t count_primitives(const struct gltf *gltf)
{
    const struct json *meshes = json_member(gltf->root, "meshes");
    size_t count = 0;
    for (size_t i = 0; i < count_of(gltf, "meshes"); i++) {
        const struct json *primitives = json_member(json_element(meshes, i), "primitives");
        count += primitives ? primitives->count : 0;
    }
    return count;
}

static ps_result walk_scene(struct gltf *gltf, struct error *error)
{
    size_t nodes = count_of(gltf, "nodes"), materials = count_of(gltf, "materials"), scene;
    struct walk walk = {
        .gltf = gltf,
        .seen_nodes = arena_allocate(&gltf->arena, nodes),
        .seen_meshes = arena_allocate(&gltf->arena, count_of(gltf, "meshes")),
        .seen_materials = arena_allocate(&gltf->arena, materials),
        .error = error,
    };
    gltf->nodes = arena_allocate(&gltf->arena, nodes * sizeof(struct json *));
    gltf->materials = arena_allocate(&gltf->arena, materials * sizeof(struct json *));
    gltf->primitives = arena_allocate(&gltf->arena, count_primitives(gltf) * sizeof(struct json *));
    if (!walk.seen_nodes || !walk.seen_meshes || !walk.seen_materials || !gltf->nodes ||
        !gltf->materials || !gltf->primitives)
        return error_memory(error, nodes, "the nodes of a mesh file");
    if (!json_size(gltf->root, "scene", 0, &scene) || scene >= count_of(gltf, "scenes"))
        return gltf_refuse(error, "there is no scene");
    const struct json *roots =
        json_member(json_element(json_member(gltf->root, "scenes"), scene), "nodes");
    gltf->single_root = roots && roots->count == 1;
    return visit_nodes(&walk, roots, 1);
}

/* --- hidden from assimp ---------------------------------------------------------------------- */

/* json_rewrite leaves it out; the tree still has it. */
static void hide(const struct json *object, const char *name)
{
    if (!object || object->kind != JSON_OBJECT)
        return;
    for (struct json *item = object->items; item; item = item->next)
        item->hidden |= json_is(&item->key, name);
}

static void hide_all(const struct json *object, const char *const names[])
{
    for (size_t i = 0; names[i]; i++)
        hide(object, names[i]);
}

static bool is_used_attribute(const struct json_text *name)
{
    static const char *const used[] = {"POSITION", "NORMAL", "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"};
    for (size_t i = 0; i < sizeof used / sizeof used[0]; i++)
        if (json_is(name, used[i]))
            return true;
    return false;
}

static void hide_attributes(const struct json *attributes)
{
    if (!attributes || attributes->kind != JSON_OBJECT)
        return;
    for (struct json *item = attributes->items; item; item = item->next)
        item->hidden |= !is_used_attribute(&item->key);
}

/* Its list of attributes says the same as the primitive's. */
static void hide_all_but_draco(const struct json *extensions)
{
    for (struct json *item = extensions->items; item; item = item->next)
        item->hidden |= !json_is(&item->key, DRACO);
    hide_attributes(json_member(json_member(extensions, DRACO), "attributes"));
}

static void hide_in_mesh(const struct json *mesh)
{
    static const char *const names[] = {"targets", "extras", NULL};
    const struct json *primitives = json_member(mesh, "primitives");
    for (size_t i = 0; primitives && i < primitives->count; i++) {
        const struct json *primitive = json_element(primitives, i);
        hide_all(primitive, names);
        if (gltf_is_draco(primitive))
            hide_all_but_draco(json_member(primitive, "extensions"));
        else
            hide(primitive, "extensions");
        hide_attributes(json_member(primitive, "attributes"));
    }
}

static void hide_rest(const struct gltf *gltf)
{
    static const char *const of_root[] = {"animations", "skins", "cameras", "extensions", NULL};
    static const char *const of_node[] = {"skin", "camera", "extensions", "extras", NULL};
    static const char *const of_mesh[] = {"weights", "extensions", "extras", NULL};
    const struct json *nodes = json_member(gltf->root, "nodes");
    const struct json *meshes = json_member(gltf->root, "meshes");
    for (size_t i = 0; nodes && i < nodes->count; i++)
        hide_all(json_element(nodes, i), of_node);
    for (size_t i = 0; meshes && i < meshes->count; i++) {
        hide_all(json_element(meshes, i), of_mesh);
        hide_in_mesh(json_element(meshes, i));
    }
    hide_all(gltf->root, of_root);
}

/* --- all
 * ----------------------------------------------------------------------------------------- */

static ps_result prepare(struct gltf *gltf, struct error *error)
{
    gltf->buffer_count = count_of(gltf, "buffers");
    gltf->view_count = count_of(gltf, "bufferViews");
    gltf->accessor_count = count_of(gltf, "accessors");
    gltf->buffers = arena_allocate(&gltf->arena, (gltf->buffer_count + 1) * sizeof *gltf->buffers);
    gltf->views = arena_allocate(&gltf->arena, (gltf->view_count + 1) * sizeof *gltf->views);
    return gltf->buffers && gltf->views
               ? PS_OK
               : error_memory(error, gltf->view_count * sizeof *gltf->views, "a mesh file");
}

static ps_result read_document(struct gltf *gltf, const struct json_text *text, struct error *error)
{
    char *copy = arena_copy(&gltf->arena, text->start, text->length);
    if (!copy)
        return error_memory(error, text->length, "a mesh file");
    ps_result result = json_read(&gltf->arena, copy, text->length, &gltf->root, error);
    if (result == PS_OK)
        result = check_document(gltf, error);
    if (result == PS_OK)
        result = prepare(gltf, error);
    if (result == PS_OK)
        result = walk_scene(gltf, error);
    if (result != PS_OK)
        return result;
    hide_rest(gltf);
    return gltf_unpack(gltf, error);
}

ps_result gltf_open(struct gltf *gltf, struct mesh_file *file, struct mesh_files *files,
                    bool binary, struct error *error)
{
    struct json_text text = {file->bytes, file->length};
    struct error inner;
    gltf->file = file;
    gltf->files = files;
    gltf->binary = binary;
    ps_result result = binary ? gltf_find_json(file, &text, error) : PS_OK;
    if (result != PS_OK)
        return result;
    result = read_document(gltf, &text, &inner);
    if (result == PS_OK)
        result = gltf_rewrite(gltf, &text, &inner);
    if (result != PS_OK)
        error_set(error, result, "%s: %.3000s", file->path, inner.text);
    return result;
}

void gltf_release(struct gltf *gltf)
{
    arena_release(&gltf->arena);
    *gltf = (struct gltf){0};
}

const struct json *gltf_primitive(const struct gltf *gltf, size_t index, size_t mesh_count)
{
    return gltf->primitive_count == mesh_count ? gltf->primitives[index] : NULL;
}

bool gltf_has_alpha(const struct gltf *gltf, const struct json *primitive)
{
    size_t accessor;
    if (!json_size(json_member(primitive, "attributes"), "COLOR_0", SIZE_MAX, &accessor))
        return false;
    const struct json *type =
        json_member(json_element(json_member(gltf->root, "accessors"), accessor), "type");
    return type && type->kind == JSON_STRING && json_is(&type->text, "VEC4");
}
