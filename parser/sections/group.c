/* group.c: objects by name, and their instances. A group is read when the first instance, or its
 * turn, comes. */
#include "parser/sections/object.h"

#include "parser/sections/fill.h"
#include "parser/sections/sections.h"
#include <stdlib.h>
#include <string.h>

/* Of groups in groups by instances; each level is a recursion here. */
#define DEEPEST_GROUPS 32

enum progress { WAITING, OPEN, DONE };

struct group_entry {
    const struct item *item; /* of the section */
    enum progress progress;
    int height; /* levels of instances in it */
};

static void read_entry(struct reader *reader, size_t index, int level)
{
    struct group_entry *entry = &reader->group_entries[index];
    if (entry->progress != WAITING)
        return;
    struct object_list list = {NULL, 0};
    const struct object_context context = {
        .list = &list, .placement = AFFINE_IDENTITY, .group = entry, .level = level};
    entry->progress = OPEN;
    objects_read(reader, entry->item->key->text, entry->item->value, &context);
    entry->progress = DONE;
    reader->description->groups[index].objects = list.items;
    reader->description->groups[index].object_count = list.count;
}

void groups_read(struct reader *reader, const struct node *root)
{
    struct scene_description *description = reader->description;
    const struct item *groups = node_find(root, "groups");
    if (!groups || !fill_expect(reader, "groups", groups->value, NODE_MAP) ||
        groups->value->count == 0)
        return;
    size_t count = groups->value->count;
    description->groups = reader_allocate(reader, count, sizeof *description->groups);
    reader->group_entries = arena_allocate(reader->arena, count * sizeof *reader->group_entries);
    if (!description->groups || !reader->group_entries) {
        reader->out_of_memory = true;
        return;
    }
    for (const struct item *item = groups->value->first; item; item = item->next) {
        size_t index = description->group_count++;
        description->groups[index].name = reader_copy(reader, item->key->text);
        reader->group_entries[index].item = item;
        reference_put(reader, &reader->groups, item->key->text, index);
    }
    for (size_t i = 0; i < count; i++)
        read_entry(reader, i, 0);
}

/* Whether the group may be used inside of the one that is being read; reads it if need be. */
static bool require(struct reader *reader, const struct object_keys *keys, size_t index,
                    const struct object_context *context)
{
    struct group_entry *used = &reader->group_entries[index];
    if (used->progress == OPEN) {
        reader_error(reader, keys->of, "group '%s' contains itself", keys->of->text);
        return false;
    }
    if (context->level < DEEPEST_GROUPS)
        read_entry(reader, index, context->level + 1);
    if (context->group->height <= used->height)
        context->group->height = used->height + 1;
    if (used->progress == DONE && context->group->height <= DEEPEST_GROUPS)
        return true;
    reader_error(reader, keys->of, "groups in groups are nested deeper than %d", DEEPEST_GROUPS);
    context->group->height = 0; /* once is enough */
    return false;
}

/* What a copy needs of its own: the few vertices of quads and boxes. */
static bool copy_vertices(struct reader *reader, struct object_description *object)
{
    const ps_vec3 *vertices = object->vertices;
    if (!vertices)
        return true;
    object->vertices = reader_allocate(reader, object->vertex_count, sizeof *vertices);
    if (!object->vertices)
        return false;
    memcpy(object->vertices, vertices, object->vertex_count * sizeof *vertices);
    return true;
}

static void copy_objects(struct reader *reader, const struct item *item, size_t material,
                         const struct group_description *group,
                         const struct object_context *context)
{
    for (size_t i = 0; i < group->object_count; i++) {
        struct object_description copy = group->objects[i];
        if (material != NO_INDEX)
            copy.material = material;
        if (!copy_vertices(reader, &copy))
            return;
        if (!object_append(reader, item->key, context, &copy)) {
            free(copy.vertices);
            return;
        }
    }
}

void group_instance(struct reader *reader, const struct item *item, const struct object_keys *keys,
                    const struct object_context *context)
{
    struct object_context placed;
    struct object_description object = keys->object;
    size_t index;
    bool good = reference_group(reader, keys->of, &index);
    if (!object_place(reader, item, keys, context, &placed) || !good)
        return;
    object.kind = OBJECT_INSTANCE;
    object.group = index;
    if (!context->group)
        object_append(reader, item->key, &placed, &object);
    else if (require(reader, keys, index, context))
        copy_objects(reader, item, object.material, &reader->description->groups[index], &placed);
}
