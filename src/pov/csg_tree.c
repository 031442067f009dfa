/* csg_tree.c: the parts of solids by boolean operations; see csg.h. */
#include "pov/csg.h"

#include <stdlib.h>
#include <string.h>

#define DEEPEST 100
#define MOST_NODES 10000
#define MOST_CHECKED ((size_t)4000000) /* planes times points, to see whether a mesh is convex */

void csg_release(struct csg_node *node)
{
    if (!node)
        return;
    for (size_t i = 0; i < node->child_count; i++)
        csg_release(node->children[i]);
    free(node->children);
    free(node->convex.planes);
    mesh_release(&node->mesh);
    free(node);
}

void csg_fail(struct csg_work *work, const char *why)
{
    if (!work->failed)
        pov_warn_at(work->writer->reader, work->object->file, &work->object->token,
                    "an intersection or difference is left out: %s", why);
    work->failed = true;
}

void csg_stop(struct csg_work *work)
{
    if (work->budget.spent)
        csg_fail(work, "its parts, or those of the scene's solids together, are too many, or cut "
                       "each other too often");
    else
        pov_no_memory(work->writer->reader);
    work->failed = true;
}

/* --- leaves
 * --------------------------------------------------------------------------------------- */

static bool is_same_plane(const struct csg_plane *a, const struct csg_plane *b, double size)
{
    return vector_length(vector_subtract(a->normal, b->normal)) < 1e-7 &&
           fabs(a->distance - b->distance) < 1e-7 * size;
}

/* The planes of the faces, without those that follow another in the same plane. */
static bool find_planes(struct csg_node *node)
{
    const struct mesh *mesh = &node->mesh;
    struct csg_convex *convex = &node->convex;
    convex->planes = calloc(mesh->triangle_count + 1, sizeof *convex->planes);
    for (size_t i = 0; i < mesh->triangle_count && convex->planes; i++) {
        const uint32_t *t = mesh->triangles[i];
        struct vector a = mesh->points[t[0]];
        struct vector n = vector_cross(vector_subtract(mesh->points[t[1]], a),
                                       vector_subtract(mesh->points[t[2]], a));
        double length = vector_length(n);
        if (!(length > 0.0))
            continue;
        n = vector_unit(n);
        struct csg_plane plane = {n, vector_dot(n, a)};
        size_t count = convex->plane_count, from = count > 3 ? count - 3 : 0;
        bool known = false;
        for (size_t k = from; k < count; k++)
            known = known || is_same_plane(&plane, &convex->planes[k], convex->radius);
        if (!known)
            convex->planes[convex->plane_count++] = plane;
    }
    return convex->planes != NULL;
}

static void find_sphere(struct csg_node *node)
{
    const struct mesh *mesh = &node->mesh;
    struct vector sum = {0, 0, 0};
    double count = (double)mesh->vertex_count;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        sum = vector_add(sum, mesh->points[i]);
    node->convex.center = vector_scale(sum, 1.0 / count);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        node->convex.radius =
            fmax(node->convex.radius,
                 vector_length(vector_subtract(mesh->points[i], node->convex.center)));
}

static bool is_convex(struct csg_work *work, const struct csg_node *node)
{
    const struct csg_convex *convex = &node->convex;
    double tolerance = 1e-6 * convex->radius;
    if (convex->plane_count < 4 || convex->plane_count > MOST_CHECKED / node->mesh.vertex_count)
        return false;
    if (!csg_take(&work->budget, convex->plane_count * node->mesh.vertex_count, 0))
        csg_stop(work);
    for (size_t i = 0; i < convex->plane_count && !work->failed; i++)
        for (size_t k = 0; k < node->mesh.vertex_count; k++)
            if (vector_dot(convex->planes[i].normal, node->mesh.points[k]) -
                    convex->planes[i].distance >
                tolerance)
                return false;
    return true;
}

/* To the space of the solid, fronts outwards also where the transform mirrors. */
static void place_mesh(struct csg_node *node)
{
    const struct transform *map = &node->place;
    for (size_t i = 0; i < node->mesh.vertex_count; i++) {
        node->mesh.points[i] = transform_point(map, node->mesh.points[i]);
        if (node->mesh.normals)
            node->mesh.normals[i] = transform_normal(map, node->mesh.normals[i]);
    }
    for (size_t i = 0; i < node->mesh.triangle_count && transform_determinant(map) < 0.0; i++) {
        uint32_t *t = node->mesh.triangles[i], swapped = t[1];
        t[1] = t[2];
        t[2] = swapped;
    }
}

static bool copy_mesh(const struct mesh *from, struct mesh *to)
{
    if (!mesh_allocate(to, from->vertex_count, from->normals != NULL, false, from->triangle_count))
        return false;
    memcpy(to->points, from->points, from->vertex_count * sizeof *from->points);
    if (from->normals)
        memcpy(to->normals, from->normals, from->vertex_count * sizeof *from->normals);
    memcpy(to->triangles, from->triangles, from->triangle_count * sizeof *from->triangles);
    return true;
}

static void make_leaf(struct csg_work *work, struct csg_node *node)
{
    struct pov_writer *writer = work->writer;
    const struct pov_object *object = node->object;
    bool is_plane = object->shape == POV_SHAPE_PLANE;
    struct transform unused;
    if (!pov_placement(writer, object, &node->place, &unused) || !pov_has_extent(object))
        return;
    if (object->shape == POV_SHAPE_MESH && !copy_mesh(object->mesh, &node->mesh))
        pov_no_memory(writer->reader);
    else if (object->shape != POV_SHAPE_MESH)
        pov_tessellate(writer, object, &node->mesh);
    if (writer->reader->stopped) {
        work->failed = true;
        return;
    }
    if (!csg_take(&work->budget, node->mesh.vertex_count,
                  node->mesh.vertex_count * (2 * sizeof(struct vector)) +
                      node->mesh.triangle_count * sizeof *node->mesh.triangles)) {
        csg_stop(work);
        return;
    }
    if (node->mesh.vertex_count > 0) {
        place_mesh(node);
        find_sphere(node);
        if (!find_planes(node)) {
            csg_stop(work);
            return;
        }
        node->cuts = is_plane ? node->convex.plane_count == 1 : is_convex(work, node);
    }
    if (is_plane)
        node->convex.radius = INFINITY;
    if (!node->cuts)
        pov_warn_at(
            writer->reader, object->file, &object->token,
            "%s in an intersection or difference is cut, but cuts nothing: it is not convex",
            pov_text(writer->reader, object->token.word));
}

/* --- the tree
 * ------------------------------------------------------------------------------------- */

static struct csg_node *build(struct csg_work *work, const struct pov_object *object,
                              const struct transform *place, int depth);

static void add_child(struct csg_work *work, struct csg_node *node, struct csg_node *child)
{
    size_t size = (node->child_count + 1) * sizeof *node->children;
    struct csg_node **grown = child ? realloc(node->children, size) : NULL;
    if (!grown) {
        if (child)
            csg_stop(work);
        csg_release(child);
        return;
    }
    node->children = grown;
    node->children[node->child_count++] = child;
    node->cuts = node->cuts || child->cuts;
}

static struct csg_node *new_node(struct csg_work *work, enum csg_kind kind,
                                 const struct pov_object *object)
{
    struct csg_node *node = NULL;
    if (++work->node_count > MOST_NODES)
        csg_fail(work, "it has more than 10000 parts");
    else if (node = calloc(1, sizeof *node), !node)
        csg_stop(work);
    if (node) {
        node->kind = kind;
        node->object = object;
    }
    return node;
}

static void mark_clip(struct csg_node *node)
{
    node->is_clip = true;
    for (size_t i = 0; i < node->child_count; i++)
        mark_clip(node->children[i]);
}

/* The object itself, without its clips. `place`: its own, in the space of the solid. */
static struct csg_node *build_object(struct csg_work *work, const struct pov_object *object,
                                     const struct transform *place, int depth)
{
    enum csg_kind kind = object->shape == POV_SHAPE_UNION          ? CSG_ANY
                         : object->shape == POV_SHAPE_INTERSECTION ? CSG_ALL
                                                                   : CSG_LEAF;
    struct csg_node *node = new_node(work, kind, object);
    if (!node)
        return NULL;
    node->inverse = object->inverse;
    node->place = *place;
    if (kind == CSG_LEAF)
        make_leaf(work, node);
    for (size_t i = 0; i < object->child_count && kind != CSG_LEAF && !work->failed; i++) {
        const struct pov_object *part = object->children[i];
        struct transform inner = transform_compose(place, &part->place);
        struct csg_node *child = build(work, part, &inner, depth + 1);
        if (child)
            add_child(work, node, child);
    }
    return node;
}

/* NULL: nothing, or reported. */
static struct csg_node *build(struct csg_work *work, const struct pov_object *object,
                              const struct transform *place, int depth)
{
    if (depth > DEEPEST)
        csg_fail(work, "its parts are in each other more than 100 deep");
    if (depth > 0)
        pov_warn_of_object(work->writer, object);
    if (work->failed || (object->shape == POV_SHAPE_NOTHING && !object->note.text))
        return NULL;
    bool is_field = object->shape == POV_SHAPE_HEIGHT_FIELD;
    if (object->shape == POV_SHAPE_LIGHT || is_field)
        pov_warn_at(work->writer->reader, object->file, &object->token,
                    "%s in an intersection or difference is left out",
                    pov_text(work->writer->reader, object->token.word));
    if (object->shape == POV_SHAPE_LIGHT)
        return NULL;
    if (object->shape == POV_SHAPE_NOTHING || is_field) { /* it has no surface, and cuts nothing */
        struct csg_node *missing = new_node(work, CSG_LEAF, object);
        if (missing)
            missing->inverse = object->inverse;
        return missing;
    }
    struct csg_node *node = build_object(work, object, place, depth);
    if (!node || object->clip_count == 0)
        return node;
    struct csg_node *clipped = new_node(work, CSG_ALL, object);
    if (!clipped) {
        csg_release(node);
        return NULL;
    }
    clipped->inverse = node->inverse;
    node->inverse = false;
    add_child(work, clipped, node);
    /* Clips move with the object. */
    for (size_t i = 0; i < object->clip_count && !work->failed; i++) {
        struct transform inner = transform_compose(place, &object->clips[i]->place);
        struct csg_node *clip = build(work, object->clips[i], &inner, depth + 1);
        if (clip) {
            mark_clip(clip);
            add_child(work, clipped, clip);
        }
    }
    return clipped;
}

struct csg_node *csg_build(struct csg_work *work)
{
    return build(work, work->object, &transform_identity, 0);
}
