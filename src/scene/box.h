/* box.h: boxes along the axes, around points. */
#ifndef SCENE_BOX_H
#define SCENE_BOX_H

#include "scene/affine.h"

struct box {
    ps_vec3 low, high;
};

/* The box around nothing, which grows. */
#define BOX_EMPTY                                                                                  \
    {                                                                                              \
        {INFINITY, INFINITY, INFINITY},                                                            \
        {                                                                                          \
            -INFINITY, -INFINITY, -INFINITY                                                        \
        }                                                                                          \
    }

static inline bool box_is_empty(const struct box *box)
{
    return !(box->low.x <= box->high.x);
}

/* Corner 0..7: bit 0 chooses the side in x, bit 1 in y, bit 2 in z. */
static inline ps_vec3 box_corner(const struct box *box, unsigned i)
{
    return (ps_vec3){i & 1 ? box->high.x : box->low.x, i & 2 ? box->high.y : box->low.y,
                     i & 4 ? box->high.z : box->low.z};
}

static inline ps_vec3 box_center(const struct box *box)
{
    return ps_scale(ps_add(box->low, box->high), 0.5f);
}

/* Comparisons, since fminf is a call; a coordinate that is no number is passed over by both. */
static inline void box_add_point(struct box *box, ps_vec3 p)
{
    box->low.x = p.x < box->low.x ? p.x : box->low.x;
    box->low.y = p.y < box->low.y ? p.y : box->low.y;
    box->low.z = p.z < box->low.z ? p.z : box->low.z;
    box->high.x = p.x > box->high.x ? p.x : box->high.x;
    box->high.y = p.y > box->high.y ? p.y : box->high.y;
    box->high.z = p.z > box->high.z ? p.z : box->high.z;
}

static inline void box_add_box(struct box *box, const struct box *other)
{
    if (box_is_empty(other))
        return;
    box_add_point(box, other->low);
    box_add_point(box, other->high);
}

/* The box around the other's image. */
static inline void box_add_placed(struct box *box, const struct box *other,
                                  const struct affine *placement)
{
    for (unsigned i = 0; i < 8 && !box_is_empty(other); i++)
        box_add_point(box, affine_point(placement, box_corner(other, i)));
}

#endif
