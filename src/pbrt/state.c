/* state.c: see state.h. */
#include "pbrt/state.h"

#include "pbrt/camera.h"
#include <stdlib.h>
#include <string.h>

#define DEEPEST 10000 /* levels of the stack */

bool state_push(struct importer *importer, enum state_mark mark, const struct origin *origin,
                int width)
{
    if (importer->depth == DEEPEST) {
        importer_error(importer, origin, width, "more than %d levels are open here", DEEPEST);
        importer->stopped = true;
        return false;
    }
    if (!importer_grow(importer, (void **)&importer->stack, &importer->stack_capacity,
                       importer->depth + 1, sizeof *importer->stack))
        return false;
    importer->state.texture_count = importer->texture_count;
    importer->state.material_count = importer->material_count;
    importer->state.mark = (char)mark;
    importer->stack[importer->depth++] = importer->state;
    return true;
}

bool state_pop(struct importer *importer, enum state_mark mark, const struct origin *origin,
               int width)
{
    if (importer->depth == 0 || importer->stack[importer->depth - 1].mark != (char)mark) {
        importer_error(importer, origin, width,
                       mark == MARK_IMPORT
                           ? "the file that was imported before this closes not all "
                             "that it opens"
                           : "no Begin of this is open here");
        importer->stopped = true;
        return false;
    }
    const struct graphics_state *saved = &importer->stack[--importer->depth];
    if (mark == MARK_TRANSFORM) {
        importer->state.ctm = saved->ctm;
        importer->state.only_end_time = saved->only_end_time;
        return true;
    }
    importer->state = *saved;
    if (importer->version == 3) { /* where textures and named materials belong to the state */
        importer->texture_count = saved->texture_count;
        importer->material_count = saved->material_count;
        name_index_cut(&importer->textures_by_name, saved->texture_count);
        name_index_cut(&importer->materials_by_name, saved->material_count);
    }
    return true;
}

void state_transform(struct importer *importer, const struct transform *map)
{
    if (!importer->state.only_end_time)
        importer->state.ctm = transform_compose(&importer->state.ctm, map);
}

bool state_begin_world(struct importer *importer)
{
    if (!importer->camera_statement)
        importer->camera = importer->state.ctm;
    camera_settle(importer);
    importer->in_world = true;
    importer->state.ctm = transform_identity;
    importer->state.reverse = importer->state.only_end_time = false;
    return state_name_coordinates(importer, "world", &transform_identity);
}

bool state_name_coordinates(struct importer *importer, const char *name,
                            const struct transform *transform)
{
    char *copy = arena_copy(&importer->arena, name, strlen(name));
    if (!copy)
        return importer_no_memory(importer);
    if (!importer_grow(importer, (void **)&importer->coordinates, &importer->coordinate_capacity,
                       importer->coordinate_count + 1, sizeof *importer->coordinates))
        return false;
    importer->coordinates[importer->coordinate_count++] =
        (struct named_transform){copy, *transform};
    return true;
}

const struct transform *state_find_coordinates(const struct importer *importer, const char *name)
{
    for (size_t i = importer->coordinate_count; i-- > 0;)
        if (strcmp(importer->coordinates[i].name, name) == 0)
            return &importer->coordinates[i].transform;
    return NULL;
}

/* --- objects
 * -------------------------------------------------------------------------------------- */

bool state_begin_object(struct importer *importer, const char *name, const struct origin *origin,
                        int width)
{
    if (importer->current_object) {
        importer_error(importer, origin, width, "objects can't be defined in objects");
        importer->stopped = true;
        return false;
    }
    char *copy = arena_copy(&importer->arena, name, strlen(name));
    const char *group = scene_text_name(&importer->scene, name);
    if (!copy || !group || !text_buffer_open(&importer->scene.group))
        return importer_no_memory(importer);
    if (!importer_grow(importer, (void **)&importer->objects, &importer->object_capacity,
                       importer->object_count + 1, sizeof *importer->objects) ||
        !state_push(importer, MARK_OBJECT, origin, width))
        return false;
    if (importer->state.area_light)
        importer_warn(importer, origin, width, "lights in objects are left out, as pbrt does");
    importer->state.area_light = NULL;
    importer->current_object = &importer->objects[importer->object_count++];
    *importer->current_object = (struct object_definition){copy, group, 0};
    return true;
}

bool state_end_object(struct importer *importer, const struct origin *origin, int width)
{
    struct object_definition *object = importer->current_object;
    if (!state_pop(importer, MARK_OBJECT, origin, width))
        return false;
    char *text = text_buffer_close(&importer->scene.group);
    if (!text)
        return importer_no_memory(importer);
    if (object->shapes > 0) {
        fputs("  ", importer->scene.groups.stream);
        put_text(importer->scene.groups.stream, object->group);
        fprintf(importer->scene.groups.stream, ":\n%s", text);
    }
    free(text);
    importer->current_object = NULL;
    return true;
}

/* Groups hold shapes as the scene has them, mirrored or not: their instances are placed by M ctm
 * M^-1. */
void state_add_instance(struct importer *importer, const char *name, const struct origin *origin,
                        int width)
{
    struct transform placement, mirror = transform_scale(1, 1, importer->mirror);
    const struct object_definition *object = NULL;
    if (importer->current_object) {
        importer_error(importer, origin, width, "ObjectInstance can't stand in an object");
        return;
    }
    for (size_t i = importer->object_count; i-- > 0 && !object;)
        if (strcmp(importer->objects[i].name, name) == 0)
            object = &importer->objects[i];
    if (!object) {
        importer_error(importer, origin, width, "there is no object '%.100s'", name);
        return;
    }
    if (object->shapes == 0 ||
        !importer_placement(importer, &importer->state.ctm, origin, width, &placement))
        return;
    placement = transform_compose(&placement, &mirror);
    fputs("  - instance: {of: ", importer->scene.objects.stream);
    put_text(importer->scene.objects.stream, object->group);
    put_placement(importer->scene.objects.stream, &placement);
    fputs("}\n", importer->scene.objects.stream);
}
