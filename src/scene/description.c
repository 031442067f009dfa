/* description.c: frees a scene description, also one that was filled in part. */
#include "scene/description.h"

#include <stdlib.h>

void strategy_choice_release(struct strategy_choice *choice)
{
    for (size_t i = 0; i < choice->parameter_count; i++) {
        free(choice->parameters[i].key);
        free(choice->parameters[i].value);
    }
    free(choice->parameters);
    free(choice->name);
    *choice = (struct strategy_choice){0};
}

static void release_objects(struct scene_description *description)
{
    for (size_t i = 0; i < description->object_count; i++) {
        free(description->objects[i].vertices);
        free(description->objects[i].triangles);
    }
    free(description->objects);
}

void scene_description_release(struct scene_description *description)
{
    for (size_t i = 0; i < description->material_count; i++)
        free(description->materials[i].name);
    free(description->materials);
    free(description->lights);
    release_objects(description);
    for (size_t i = 0; i < STRATEGY_KINDS; i++)
        strategy_choice_release(&description->render.strategies[i]);
    for (size_t i = 0; i < description->file_count; i++)
        free(description->files[i]);
    free(description->files);
    free(description->path);
    *description = (struct scene_description){0};
}
