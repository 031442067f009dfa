/* csg.h: a solid by boolean operations as the tree of its parts, while its surface is made
 * (csg_tree.c, csg.c).
 *
 * In the space of the solid's object: before that one's own transforms, which its copies differ in.
 */
#ifndef POV_CSG_H
#define POV_CSG_H

#include "pov/polygons.h"
#include "pov/write.h"

enum csg_kind { CSG_LEAF, CSG_ALL, CSG_ANY };

struct csg_node {
    enum csg_kind kind;
    bool inverse;
    bool is_clip; /* cuts, but its surface is not seen */
    bool cuts;    /* it is convex, or a part of it is: others are as if they were not there */
    const struct pov_object *object;
    struct transform place; /* to the space of the solid */
    struct mesh mesh;       /* CSG_LEAF: in the space of the solid; owned */
    struct csg_convex convex;
    struct csg_node **children; /* owned, each too */
    size_t child_count;
};

/* One solid in work. */
struct csg_work {
    struct pov_writer *writer;
    const struct pov_object *object;
    struct csg_budget budget;
    size_t node_count;
    double tolerance;
    bool failed; /* it takes too much, or there is no memory: reported */
};

/* NULL: nothing, or reported. To be released. */
struct csg_node *csg_build(struct csg_work *work);
void csg_release(struct csg_node *node);

/* The solid is left out, with a warning. */
void csg_fail(struct csg_work *work, const char *why);
/* The same where its budget is spent; else there is no memory. */
void csg_stop(struct csg_work *work);

#endif
