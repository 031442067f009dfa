/* mesh_gltf_hide.c: hides from assimp what it need not see. */
#include "parser/mesh_gltf.h"

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
