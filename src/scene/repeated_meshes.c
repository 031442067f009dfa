/* repeated_meshes.c: which meshes repeat, and their groups.
 *
 * An object can be an instance where its material looks the same in the mesh's own space as in the
 * scene's: patterns and heights of bump maps are of the scene, and normal maps keep their angles
 * where the placement does.
 */
#include "scene/repeated_meshes.h"

#include <stdlib.h>

enum space { ANY_SPACE, SIMILAR_SPACE, SCENE_SPACE }; /* where a material can be looked up */

struct repetition {
    size_t *copies;     /* of each mesh, that can be instances */
    size_t *groups;     /* of each mesh, or NO_INDEX */
    enum space *spaces; /* of each material */
};

static enum space space_of(struct material_description *material)
{
    struct pigment_description *pigments[MATERIAL_PIGMENTS];
    material_pigments(material, pigments);
    for (size_t i = 0; i < MATERIAL_PIGMENTS; i++)
        if (pigments[i]->kind != PIGMENT_COLOR && pigments[i]->kind != PIGMENT_IMAGE)
            return SCENE_SPACE;
    if (material->bump.kind != PIGMENT_COLOR)
        return SCENE_SPACE;
    return material->normal_map.kind == PIGMENT_COLOR ? ANY_SPACE : SIMILAR_SPACE;
}

static enum space space_of_mix(const struct material_description *mix, enum space own,
                               const enum space *spaces)
{
    for (size_t i = 0; i < mix->component_count; i++)
        if (spaces[mix->components[i]] > own)
            own = spaces[mix->components[i]];
    return own;
}

/* Mixes of mixes stand in any order. */
static void find_spaces(const struct scene_description *description, enum space *spaces)
{
    for (size_t i = 0; i < description->material_count; i++)
        spaces[i] = space_of(&description->materials[i]);
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t i = 0; i < description->material_count; i++) {
            enum space before = spaces[i];
            spaces[i] = space_of_mix(&description->materials[i], before, spaces);
            changed |= spaces[i] != before;
        }
    }
}

static bool can_be_instance(const struct repetition *repetition,
                            const struct object_description *object)
{
    if (object->kind != OBJECT_MESH || object->material == NO_INDEX)
        return false;
    enum space space = repetition->spaces[object->material];
    return space == ANY_SPACE ||
           (space == SIMILAR_SPACE && affine_is_similarity(&object->placement));
}

static void count_copies(const struct scene_description *description,
                         const struct repetition *repetition)
{
    for (size_t i = 0; i < description->object_count; i++) {
        const struct object_description *object = &description->objects[i];
        if (can_be_instance(repetition, object))
            repetition->copies[object->mesh]++;
    }
}

static bool repeats(const struct scene_description *description,
                    const struct repetition *repetition, size_t mesh)
{
    size_t copies = repetition->copies[mesh];
    return copies > 1 &&
           copies > REPEATED_TRIANGLES / (description->meshes[mesh].triangle_count + 1);
}

static bool add_group(struct scene_description *description,
                      const struct object_description *object, size_t *index)
{
    struct group_description *groups =
        realloc(description->groups, (description->group_count + 1) * sizeof *groups);
    if (!groups)
        return false;
    description->groups = groups;
    struct object_description *member = malloc(sizeof *member);
    if (!member)
        return false;
    *member = *object;
    member->placement = (struct affine)AFFINE_IDENTITY;
    member->hidden = member->front_only = false; /* each instance says it for itself */
    *index = description->group_count++;
    groups[*index] = (struct group_description){.name = NULL, .objects = member, .object_count = 1};
    return true;
}

static bool make_instances(struct scene_description *description,
                           const struct repetition *repetition)
{
    for (size_t i = 0; i < description->object_count; i++) {
        struct object_description *object = &description->objects[i];
        if (!can_be_instance(repetition, object) || !repeats(description, repetition, object->mesh))
            continue;
        size_t *group = &repetition->groups[object->mesh];
        if (*group == NO_INDEX && !add_group(description, object, group))
            return false;
        object->kind = OBJECT_INSTANCE;
        object->group = *group;
        object->mesh = NO_INDEX;
    }
    return true;
}

bool scene_description_share_meshes(struct scene_description *description)
{
    size_t meshes = description->mesh_count;
    struct repetition repetition = {
        .copies = calloc(meshes + 1, sizeof *repetition.copies),
        .groups = malloc((meshes + 1) * sizeof *repetition.groups),
        .spaces = calloc(description->material_count + 1, sizeof *repetition.spaces),
    };
    bool good = repetition.copies && repetition.groups && repetition.spaces;
    for (size_t i = 0; good && i < meshes; i++)
        repetition.groups[i] = NO_INDEX;
    if (good) {
        find_spaces(description, repetition.spaces);
        count_copies(description, &repetition);
        good = make_instances(description, &repetition);
    }
    free(repetition.copies);
    free(repetition.groups);
    free(repetition.spaces);
    return good;
}
