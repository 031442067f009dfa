/* gltf.c: from the bytes to the tree, and through the scene's nodes. */
#include "import/gltf.h"

#include <string.h>

#define GLB_HEADER 12
#define CHUNK_HEADER 8
#define CHUNK_JSON 0x4e4f534au
#define CHUNK_BINARY 0x004e4942u

static uint32_t little_endian(const char *bytes)
{
    const unsigned char *b = (const unsigned char *)bytes;
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static ps_result check_chunk(const struct mesh_file *file, size_t offset, uint32_t type,
                             struct error *error)
{
    if (file->length - offset < CHUNK_HEADER ||
        little_endian(file->bytes + offset) > file->length - offset - CHUNK_HEADER)
        return error_set(error, PS_ERROR_INVALID, "%s: the file is cut short", file->path);
    if (little_endian(file->bytes + offset + 4) != type)
        return error_set(error, PS_ERROR_INVALID, "%s: binary glTF with chunks in a wrong order",
                         file->path);
    return PS_OK;
}

/* Where the JSON lies in a .glb file. */
static ps_result find_json(const struct mesh_file *file, struct json_text *text,
                           struct error *error)
{
    if (file->length < GLB_HEADER || memcmp(file->bytes, "glTF", 4) != 0)
        return error_set(error, PS_ERROR_INVALID, "%s: not binary glTF", file->path);
    if (little_endian(file->bytes + 4) != 2)
        return error_set(error, PS_ERROR_INVALID, "%s: binary glTF of a version other than 2",
                         file->path);
    size_t length = little_endian(file->bytes + 8);
    if (length > file->length)
        return error_set(error, PS_ERROR_INVALID,
                         "%s: the file is cut short: %zu bytes of %zu are there", file->path,
                         file->length, length);
    ps_result result = check_chunk(file, GLB_HEADER, CHUNK_JSON, error);
    if (result != PS_OK)
        return result;
    text->start = file->bytes + GLB_HEADER + CHUNK_HEADER;
    text->length = little_endian(file->bytes + GLB_HEADER);
    size_t next = GLB_HEADER + CHUNK_HEADER + (text->length + 3) / 4 * 4;
    if (length >= next + CHUNK_HEADER)
        result = check_chunk(file, next, CHUNK_BINARY, error);
    return result;
}

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

static ps_result complain(const struct walk *walk, const char *what)
{
    return error_set(walk->error, PS_ERROR_INVALID, "glTF: %s", what);
}

static ps_result meet_materials(struct walk *walk, const struct json *mesh)
{
    struct gltf *gltf = walk->gltf;
    const struct json *primitives = json_member(mesh, "primitives");
    for (size_t i = 0; i < primitives->count; i++) {
        const struct json *primitive = json_element(primitives, i);
        size_t index;
        if (!json_member(primitive, "material"))
            continue;
        if (!json_size(primitive, "material", 0, &index) || index >= count_of(gltf, "materials"))
            return complain(walk, "a mesh has a material that the file lacks");
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
        return complain(walk, "a node has a mesh that the file lacks");
    if (walk->seen_meshes[index])
        return PS_OK;
    walk->seen_meshes[index] = true;
    ps_result result = gltf_check_mesh(walk->gltf, index, walk->error);
    if (result == PS_OK)
        result = meet_materials(walk, json_element(json_member(walk->gltf->root, "meshes"), index));
    return result;
}

static ps_result visit_nodes(struct walk *walk, const struct json *indices, int depth);

static ps_result visit_node(struct walk *walk, const struct json *reference, int depth)
{
    struct gltf *gltf = walk->gltf;
    if (reference->kind != JSON_NUMBER || reference->number < 0 ||
        reference->number >= (double)count_of(gltf, "nodes") ||
        reference->number != (double)(size_t)reference->number)
        return complain(walk, "a node that the file lacks is named");
    size_t index = (size_t)reference->number;
    if (walk->seen_nodes[index])
        return complain(walk, "a node has two parents, or is its own");
    if (depth > GLTF_DEPTH)
        return complain(walk, "nodes are nested more than 256 deep");
    if (gltf->node_count == GLTF_NODES)
        return complain(walk, "more than 1000000 nodes");
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
                           : complain(walk, "a list of nodes is no array");
    }
    return result;
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
    if (!walk.seen_nodes || !walk.seen_meshes || !walk.seen_materials || !gltf->nodes ||
        !gltf->materials)
        return error_memory(error, nodes, "the nodes of a mesh file");
    if (!json_size(gltf->root, "scene", 0, &scene) || scene >= count_of(gltf, "scenes"))
        return complain(&walk, "there is no scene");
    const struct json *roots =
        json_member(json_element(json_member(gltf->root, "scenes"), scene), "nodes");
    gltf->single_root = roots && roots->count == 1;
    return visit_nodes(&walk, roots, 1);
}

ps_result gltf_open(struct gltf *gltf, struct mesh_file *file, bool binary, struct error *error)
{
    struct json_text text = {file->bytes, file->length};
    struct error inner;
    ps_result result = binary ? find_json(file, &text, error) : PS_OK;
    if (result != PS_OK)
        return result;
    gltf->text = file->bytes + (text.start - file->bytes);
    result = json_read(&gltf->arena, gltf->text, text.length, &gltf->root, &inner);
    if (result == PS_OK)
        result = gltf_check_document(gltf, &inner);
    if (result == PS_OK)
        result = walk_scene(gltf, &inner);
    if (result == PS_OK)
        gltf_hide_rest(gltf);
    else
        error_set(error, result, "%s: %.3000s", file->path, inner.text);
    return result;
}

void gltf_release(struct gltf *gltf)
{
    arena_release(&gltf->arena);
    *gltf = (struct gltf){0};
}

/* --- hidden from assimp ---------------------------------------------------------------------- */

/* Only the text changes: the tree still knows the members by their names. */
static void hide(const struct gltf *gltf, const struct json *object, const char *name)
{
    if (!object || object->kind != JSON_OBJECT)
        return;
    for (struct json *item = object->items; item; item = item->next)
        if (json_is(&item->key, name)) {
            gltf->text[item->key.start - gltf->text] = '_';
            item->key.start = name;
        }
}

static void hide_all(const struct gltf *gltf, const struct json *object, const char *const names[])
{
    for (size_t i = 0; names[i]; i++)
        hide(gltf, object, names[i]);
}

static void hide_attributes(const struct gltf *gltf, const struct json *attributes)
{
    if (!attributes || attributes->kind != JSON_OBJECT)
        return;
    for (struct json *item = attributes->items; item; item = item->next)
        if (item->key.length > 0 && !json_is(&item->key, "POSITION") &&
            !json_is(&item->key, "NORMAL") && !json_is(&item->key, "TEXCOORD_0"))
            gltf->text[item->key.start - gltf->text] = '_';
}

static void hide_in_mesh(const struct gltf *gltf, const struct json *mesh)
{
    static const char *const names[] = {"targets", "extensions", "extras", NULL};
    const struct json *primitives = json_member(mesh, "primitives");
    for (size_t i = 0; primitives && i < primitives->count; i++) {
        const struct json *primitive = json_element(primitives, i);
        hide_all(gltf, primitive, names);
        hide_attributes(gltf, json_member(primitive, "attributes"));
    }
}

void gltf_hide_rest(struct gltf *gltf)
{
    static const char *const of_root[] = {"animations", "skins", "cameras", "extensions", NULL};
    static const char *const of_node[] = {"skin", "camera", "extensions", "extras", NULL};
    static const char *const of_mesh[] = {"weights", "extensions", "extras", NULL};
    const struct json *nodes = json_member(gltf->root, "nodes");
    const struct json *meshes = json_member(gltf->root, "meshes");
    for (size_t i = 0; nodes && i < nodes->count; i++)
        hide_all(gltf, json_element(nodes, i), of_node);
    for (size_t i = 0; meshes && i < meshes->count; i++) {
        hide_all(gltf, json_element(meshes, i), of_mesh);
        hide_in_mesh(gltf, json_element(meshes, i));
    }
    hide_all(gltf, gltf->root, of_root);
}
