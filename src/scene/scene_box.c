#include "scene/scene_box.h"

/* How far a floor may be from level, and things below it, of the box's diagonal. */
#define FLOOR_TOLERANCE 1e-3f

struct box scene_box_of_shapes(const struct scene *scene, size_t first, size_t count)
{
    struct box box = BOX_EMPTY;
    for (size_t i = first; i < first + count; i++)
        box_add_box(&box, &scene->shapes[i].box);
    return box;
}

static struct box box_of_instance(const struct scene_description *description,
                                  const struct scene *scene,
                                  const struct object_description *object,
                                  const struct instance *instance)
{
    const struct group_description *group = &description->groups[object->group];
    struct box inside = BOX_EMPTY, box = BOX_EMPTY;
    for (size_t i = 0; i < group->object_count; i++)
        if (group->objects[i].kind != OBJECT_PLANE)
            box_add_box(&inside, &scene->shapes[instance->group->first_shape + i].box);
    box_add_placed(&box, &inside, &instance->placement);
    return box;
}

/* The world's shapes are in the order of the objects, and so are the instances. */
void scene_each_box(const struct scene_description *description, const struct scene *scene,
                    void (*each)(void *user, const struct object_description *object,
                                 const struct box *box),
                    void *user)
{
    size_t shape = 0, instance = 0;
    for (size_t i = 0; i < description->object_count; i++) {
        const struct object_description *object = &description->objects[i];
        struct box box =
            object->kind == OBJECT_INSTANCE
                ? box_of_instance(description, scene, object, &scene->instances[instance++])
                : scene_box_of_shapes(scene, shape++, 1);
        each(user, object, &box);
    }
}

static void add_bounded(void *user, const struct object_description *object, const struct box *box)
{
    if (!object_is_endless(object))
        box_add_box(user, box);
}

struct box scene_box(const struct scene_description *description, const struct scene *scene)
{
    struct box box = BOX_EMPTY;
    scene_each_box(description, scene, add_bounded, &box);
    return box;
}

/* --- what is worth a look
 * ------------------------------------------------------------------------- */

/* From the lowest to the highest point along a unit vector. */
struct range {
    float low, high;
};

static struct range range_along(const struct box *box, ps_vec3 axis)
{
    struct range range = {INFINITY, -INFINITY};
    for (unsigned i = 0; i < 8 && !box_is_empty(box); i++) {
        float height = ps_dot(box_corner(box, i), axis);
        range.low = fminf(range.low, height);
        range.high = fmaxf(range.high, height);
    }
    return range;
}

struct search {
    ps_vec3 up;
    struct box seen, all,
        solid; /* what is visible; of that, what is no plane; and what is no floor either */
    float lowest, tolerance;
};

static bool may_be_floor(const struct search *search, const struct object_description *object,
                         const struct box *box)
{
    struct range range = range_along(box, search->up);
    float diagonal = ps_length(ps_subtract(box->high, box->low));
    return (object->kind == OBJECT_QUAD || object->kind == OBJECT_DISC) &&
           range.high - range.low <= FLOOR_TOLERANCE * diagonal;
}

static void add_visible(void *user, const struct object_description *object, const struct box *box)
{
    struct search *search = user;
    if (object->hidden)
        return;
    box_add_box(&search->seen, box);
    if (object->kind == OBJECT_PLANE)
        return;
    box_add_box(&search->all, box);
    if (!may_be_floor(search, object, box))
        box_add_box(&search->solid, box);
}

/* Tables and lids: as level as floors, with something below them. */
static void add_raised(void *user, const struct object_description *object, const struct box *box)
{
    struct search *search = user;
    if (!object->hidden && may_be_floor(search, object, box) &&
        range_along(box, search->up).low > search->lowest + search->tolerance)
        box_add_box(&search->solid, box);
}

struct box scene_box_to_frame(const struct scene_description *description,
                              const struct scene *scene, ps_vec3 up)
{
    struct search search = {ps_normalize(up), BOX_EMPTY, BOX_EMPTY, BOX_EMPTY, 0, 0};
    scene_each_box(description, scene, add_visible, &search);
    if (box_is_empty(&search.solid))
        return box_is_empty(&search.all) ? search.seen : search.all;
    search.lowest = range_along(&search.all, search.up).low;
    search.tolerance =
        FLOOR_TOLERANCE * ps_length(ps_subtract(search.solid.high, search.solid.low));
    scene_each_box(description, scene, add_raised, &search);
    return search.solid;
}
