/* room.h: whether a model is a room, and from where it is seen.
 *
 * A room has walls with a front inside, often without an outside. A camera before it sees their
 * backs, and no sky lights it.
 */
#ifndef MODEL_ROOM_H
#define MODEL_ROOM_H

#include "scene/box.h"
#include "scene/description.h"

/* Of what encloses no place only `is_room` counts. */
struct room {
    bool is_room;
    ps_vec3 location, look_at; /* of the camera: inside, or before a side that is open */
    double angle;              /* its horizontal field of view */
    ps_vec3 lamp;              /* below the ceiling */
    double lamp_radius;
};

/* Looks at what the fragment's objects show of their fronts; `box` is around them. */
struct room room_find(const struct scene_description *fragment, const struct box *box);

#endif
