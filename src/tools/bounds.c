#include "tools/bounds.h"

#include "base/text.h"
#include "scene/scene_box.h"
#include <stdio.h>

static void print_point(const char *name, ps_vec3 p)
{
    char x[32], y[32], z[32];
    text_from_float(p.x, x, sizeof x);
    text_from_float(p.y, y, sizeof y);
    text_from_float(p.z, z, sizeof z);
    printf("%s [%s, %s, %s]", name, x, y, z);
}

static void print_box(const struct box *box)
{
    if (box_is_empty(box)) {
        printf(": nothing\n");
        return;
    }
    print_point(": extent", ps_subtract(box->high, box->low));
    print_point(", center", box_center(box));
    print_point(", from", box->low);
    print_point(" to", box->high);
    printf("\n");
}

/* The parts of one mesh, which follow one another. */
struct part_list {
    const struct scene_description *description;
    const struct object_description *first; /* NULL: none yet */
    struct box box;
};

static const char *file_of(const struct part_list *list, const struct object_description *object)
{
    const struct scene_description *description = list->description;
    const char *file = NULL;
    if (object->kind == OBJECT_MESH)
        return description->meshes[object->mesh].file;
    if (object->kind != OBJECT_INSTANCE)
        return NULL;
    const struct group_description *group = &description->groups[object->group];
    for (size_t i = 0; i < group->object_count && !file; i++)
        file = file_of(list, &group->objects[i]);
    return file;
}

/* Of a group that the scene names; other groups are meshes that repeat. */
static bool is_instance(const struct part_list *list, const struct object_description *object)
{
    return object->kind == OBJECT_INSTANCE && list->description->groups[object->group].name;
}

static void print_parts(struct part_list *list)
{
    const struct object_description *first = list->first;
    if (!first)
        return;
    if (is_instance(list, first))
        printf("  instance of %s", list->description->groups[first->group].name);
    else
        printf("  mesh %s", file_of(list, first));
    printf(" (%s:%d:%d)", first->origin.file, first->origin.line, first->origin.column);
    print_box(&list->box);
    list->first = NULL;
}

/* A mesh file that is read twice has two names, though they are spelled alike; instances are never
 * joined. */
static void add_part(void *user, const struct object_description *object, const struct box *box)
{
    struct part_list *list = user;
    const char *file = file_of(list, object);
    if (!file || !list->first || is_instance(list, object) || file_of(list, list->first) != file)
        print_parts(list);
    if (!file)
        return;
    if (!list->first) {
        list->box = (struct box)BOX_EMPTY;
        list->first = object;
    }
    box_add_box(&list->box, box);
}

static void print_number(const char *key, double value)
{
    char number[32];
    text_from_number(value, number, sizeof number);
    printf(", %s: %s", key, number);
}

static void print_camera(const struct camera_description *camera)
{
    bool upright = ps_same(camera->up, (ps_vec3){0, 1, 0});
    const char *key = camera->kind == CAMERA_ORTHOGRAPHIC ? "projection: orthographic, width"
                      : camera->vertical_angle > 0        ? "vertical_angle"
                                                          : "angle";
    double value = camera->kind == CAMERA_ORTHOGRAPHIC ? camera->width
                   : camera->vertical_angle > 0        ? camera->vertical_angle
                                                       : camera->angle;
    print_point("  camera: {location:", camera->location);
    print_point(", look_at:", camera->look_at);
    if (!upright)
        print_point(", up:", camera->up);
    print_number(key, value);
    if (camera->aperture > 0)
        print_number("aperture", camera->aperture);
    if (camera->focus > 0)
        print_number("focus", camera->focus);
    printf("}\n");
}

ps_result bounds_print(const struct scene_description *description, const struct scene *scene,
                       struct error *error)
{
    struct box box = scene_box(description, scene);
    struct part_list list = {description, NULL, BOX_EMPTY};
    struct camera_description camera;
    printf("%s\n  scene", description->path);
    print_box(&box);
    scene_each_box(description, scene, add_part, &list);
    print_parts(&list);
    ps_result result = scene_find_camera(description, scene, &camera, error);
    if (result == PS_OK)
        print_camera(&camera);
    return result;
}
