/* object.c: a list of objects, each by the table of its kind. */
#include "parser/sections/object.h"

#include "parser/sections/check.h"
#include "parser/sections/fill.h"
#include "parser/sections/sections.h"
#include <psplat/math.h>
#include <stdlib.h>

bool object_place(struct reader *reader, const struct item *item, const struct object_keys *keys,
                  const struct object_context *context, struct object_context *placed)
{
    struct affine own;
    *placed = *context;
    placed->hidden = context->hidden || !keys->camera;
    placed->front_only = context->front_only || keys->sides == 1;
    if (!placement_read(reader, item->key, item->value, &keys->placement, &own))
        return false;
    placed->placement = affine_compose(&context->placement, &own);
    if (placement_is_regular(&placed->placement))
        return true;
    reader_error(reader, item->key, "all transforms together are singular: they have no inverse");
    return false;
}

bool object_append(struct reader *reader, const struct node *at,
                   const struct object_context *context, const struct object_description *object)
{
    struct object_list *list = context->list;
    if (reader->object_count >= MOST_OBJECTS) {
        if (reader->object_count++ == MOST_OBJECTS)
            reader_error(reader, at, "more than %zu objects in one scene", MOST_OBJECTS);
        return false;
    }
    struct object_description *items =
        reader_extend(reader, list->items, list->count, 1, sizeof *items);
    if (!items)
        return false;
    list->items = items;
    items[list->count] = *object;
    items[list->count].placement = affine_compose(&context->placement, &object->placement);
    items[list->count].hidden = context->hidden || object->hidden;
    items[list->count++].front_only = context->front_only || object->front_only;
    reader->object_count++;
    return true;
}

/* Triangles with more than points, and those of a group, which may be copied, share a mesh. */
static bool make_mesh(struct reader *reader, struct object_keys *keys,
                      struct object_description *object)
{
    struct scene_description *description = reader->description;
    struct mesh_description *meshes =
        reader_extend(reader, description->meshes, description->mesh_count, 1, sizeof *meshes);
    if (!meshes)
        return false;
    description->meshes = meshes;
    meshes[description->mesh_count] = (struct mesh_description){
        .vertices = keys->vertices.items,
        .normals = keys->normals.items,
        .uv = keys->uv.items,
        .vertex_count = keys->vertices.count,
        .triangles = keys->triangles.items,
        .triangle_count = keys->triangles.count,
    };
    keys->vertices.items = keys->normals.items = NULL;
    keys->uv.items = NULL;
    keys->triangles.items = NULL;
    object->kind = OBJECT_MESH;
    object->mesh = description->mesh_count++;
    return true;
}

static size_t height_texture(struct reader *reader, const struct node *file)
{
    const struct texture_keys keys = {
        .file = file, .wrap = WRAP_CLAMP, .encoding = ENCODING_LINEAR};
    return texture_add(reader, &keys);
}

/* Moves what the keys hold into the object. */
static bool finish_shape(struct reader *reader, struct object_keys *keys,
                         const struct object_context *context, struct object_description *object)
{
    *object = keys->object;
    object->open = keys->open != 0;
    object->smooth = keys->smooth != 0;
    object->extent = keys->extent.choice < 0 ? keys->extent.number : 0;
    if (object->kind == OBJECT_PLANE)
        object->distance = keys->distance.choice < 0 ? keys->distance.number : DISTANCE_BELOW_ALL;
    object->normal = check_unit(object->normal);
    if (object->kind == OBJECT_HEIGHT_FIELD)
        object->texture = height_texture(reader, keys->file);
    if (object->kind == OBJECT_TRIANGLES &&
        (context->group || keys->normals.items || keys->uv.items))
        return make_mesh(reader, keys, object);
    object->vertices = keys->vertices.items;
    object->vertex_count = keys->vertices.count;
    object->triangles = keys->triangles.items;
    object->triangle_count = keys->triangles.count;
    keys->vertices.items = NULL;
    keys->triangles.items = NULL;
    return true;
}

static bool check_cone(const struct reader *reader, const struct node *at, const struct node *map,
                       const struct object_description *object)
{
    bool good = check_expect(reader, !ps_same(object->points[0], object->points[1]),
                             check_value(map, at, "to"), "its two ends are at the same point");
    return check_expect(reader,
                        object->kind == OBJECT_CYLINDER || object->radius > 0 ||
                            object->to_radius > 0,
                        check_value(map, at, "to_radius"), "both radii of the cone are 0") &&
           good;
}

static bool check_disc(const struct reader *reader, const struct node *at, const struct node *map,
                       const struct object_description *object)
{
    return check_expect(reader, object->kind != OBJECT_DISC || object->hole_radius < object->radius,
                        check_value(map, at, "hole"), "the hole is as large as the disc");
}

static bool check_count(const struct reader *reader, const struct node *map, const char *key,
                        size_t count, size_t vertex_count)
{
    const struct item *item = node_find(map, key);
    if (!item || count == vertex_count)
        return true;
    reader_error(reader, item->value,
                 "%s in triangles: expected one for each of %zu vertices, got %zu", key,
                 vertex_count, count);
    return false;
}

static bool check_triangles(const struct reader *reader, const struct node *map,
                            const struct object_keys *keys)
{
    bool good = check_count(reader, map, "normals", keys->normals.count, keys->vertices.count);
    good = check_count(reader, map, "uv", keys->uv.count, keys->vertices.count) && good;
    const struct item *item = node_find(map, "normals");
    const ps_vec3 *normal = keys->normals.items;
    for (const struct item *each = item ? item->value->first : NULL; each; each = each->next)
        good = check_expect(reader, !check_zero(*normal++), each->value,
                            "the length of this normal is 0") &&
               good;
    return good;
}

static bool check_object(const struct reader *reader, const struct node *at, const struct node *map,
                         const struct object_keys *keys)
{
    const struct object_description *object = &keys->object;
    bool facing = object->kind == OBJECT_DISC || object->kind == OBJECT_PLANE;
    bool good = check_expect(reader, !facing || !check_zero(object->normal),
                             check_value(map, at, "normal"), "the length of normal is 0");
    switch (object->kind) {
    case OBJECT_TRIANGLES:
        return check_triangles(reader, map, keys);
    case OBJECT_CYLINDER:
    case OBJECT_CONE:
        return check_cone(reader, at, map, object);
    case OBJECT_DISC:
        return check_disc(reader, at, map, object) && good;
    case OBJECT_TORUS:
        return check_expect(reader, object->minor_radius < object->radius,
                            check_value(map, at, "minor_radius"),
                            "minor_radius must be smaller than radius");
    default:
        return good;
    }
}

static void read_shape(struct reader *reader, const struct item *item, struct object_keys *keys,
                       const struct object_context *context)
{
    struct object_context placed;
    struct object_description object;
    bool good = check_object(reader, item->key, item->value, keys);
    if (!object_place(reader, item, keys, context, &placed) || !good ||
        !finish_shape(reader, keys, context, &object))
        return;
    if (!object_append(reader, item->key, &placed, &object))
        object_description_release(&object);
}

static void read_group(struct reader *reader, const struct item *item,
                       const struct object_keys *keys, const struct object_context *context)
{
    struct object_context placed;
    if (!object_place(reader, item, keys, context, &placed))
        placed = *context; /* the objects may have errors too */
    objects_read(reader, "objects", node_find(item->value, "objects")->value, &placed);
}

static void read_object(struct reader *reader, const struct schema_section *section,
                        const struct item *item, const struct object_context *context)
{
    struct object_keys keys = {.object = {
                                   .placement = AFFINE_IDENTITY,
                                   .material = NO_INDEX,
                                   .texture = NO_INDEX,
                                   .mesh = NO_INDEX,
                                   .group = NO_INDEX,
                                   .origin = reader_origin(reader, item->key),
                               }};
    bool good = fill_section(reader, section, item->key, item->value, &keys);
    if (section->kind < KEYS_MESH_FILE)
        keys.object.kind = (enum object_kind)section->kind;
    if (section->kind == KEYS_GROUP && node_find(item->value, "objects"))
        read_group(reader, item, &keys, context);
    else if (good && section->kind == KEYS_MESH_FILE)
        object_mesh_read(reader, item, &keys, context);
    else if (good && section->kind == KEYS_INSTANCE)
        group_instance(reader, item, &keys, context);
    else if (good)
        read_shape(reader, item, &keys, context);
    free(keys.vertices.items);
    free(keys.normals.items);
    free(keys.uv.items);
    free(keys.triangles.items);
}

void objects_read(struct reader *reader, const char *name, const struct node *list,
                  const struct object_context *context)
{
    if (!fill_expect(reader, name, list, NODE_LIST))
        return;
    for (const struct item *item = list->first; item; item = item->next) {
        const struct schema_section *section = fill_find_kind(reader, "objects", name, item->value);
        if (section)
            read_object(reader, section, item->value->first, context);
    }
}
