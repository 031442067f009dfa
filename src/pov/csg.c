/* csg.c: intersections, differences and clipped_by as meshes; see write.h.
 *
 * The surface of a solid by boolean operations is made of the surfaces of its parts, each as far as
 * it lies inside (union: outside) of the other parts (A. Requicha and H. Voelcker, "Boolean
 * operations in solid modeling", 1985). The parts that cut are convex, as spheres, boxes,
 * cylinders, cones and planes are: their faces' planes cut the polygons of the others. A part that
 * is not convex is cut, but cuts nothing, with a warning; the face of a plane that such a part
 * ought to bound is left out. No library does that in plain C; the solids of scenes by hand are
 * small.
 */
#include "pov/csg.h"

#define MOST_STEPS_OF_SOLID ((size_t)2000000000) /* planes times corners */
#define TOLERANCE 1e-9                           /* of the solid's size */

/* --- cutting
 * -------------------------------------------------------------------------------------- */

static void append(struct csg_work *work, const struct csg_polygons *from, struct csg_polygons *to)
{
    for (size_t i = 0; i < from->count && to && !work->failed; i++)
        if (!csg_polygons_add(to, from->vertices + from->list[i].start, from->list[i].count))
            csg_stop(work);
}

/* Adds to `inside` and `outside` what of the polygons is so of the node. */
static void cut(struct csg_work *work, const struct csg_node *node,
                const struct csg_polygons *polygons, struct csg_polygons *inside,
                struct csg_polygons *outside)
{
    if (node->inverse) {
        struct csg_polygons *swapped = inside;
        inside = outside;
        outside = swapped;
    }
    if (work->failed)
        return;
    if (node->kind == CSG_LEAF) {
        if (!csg_cut(polygons, &node->convex, work->tolerance, inside, outside, &work->budget))
            csg_stop(work);
        return;
    }
    struct csg_polygons rest = {.budget = &work->budget}, next = rest;
    append(work, polygons, &rest);
    for (size_t i = 0; i < node->child_count && !work->failed; i++) {
        if (!node->children[i]->cuts)
            continue;
        csg_polygons_clear(&next);
        cut(work, node->children[i], &rest, node->kind == CSG_ALL ? &next : inside,
            node->kind == CSG_ALL ? outside : &next);
        struct csg_polygons swapped = rest;
        rest = next;
        next = swapped;
    }
    append(work, &rest, node->kind == CSG_ALL ? inside : outside);
    csg_polygons_release(&rest);
    csg_polygons_release(&next);
}

static void add_triangles(struct csg_work *work, const struct csg_node *leaf,
                          struct csg_polygons *to)
{
    const struct mesh *mesh = &leaf->mesh;
    for (size_t i = 0; i < mesh->triangle_count && !work->failed; i++) {
        struct csg_vertex corners[3] = {{{0, 0, 0}, {0, 0, 0}}};
        for (int k = 0; k < 3; k++) {
            corners[k].point = mesh->points[mesh->triangles[i][k]];
            if (mesh->normals)
                corners[k].normal = mesh->normals[mesh->triangles[i][k]];
        }
        if (!csg_polygons_add(to, corners, 3))
            csg_stop(work);
    }
}

/* --- what is left
 * ----------------------------------------------------------------------------------- */

/* The way from the root to a node. */
struct path {
    const struct path *up; /* NULL: the node is the root */
    const struct csg_node *node;
    size_t child; /* which child of the one above it is */
};

/* The objects on the way, but for the root's: its copies differ. A node that clips is of the same
 * object as that below. */
static void find_way(struct pov_reader *reader, const struct path *path, struct pov_piece *piece)
{
    const struct pov_object **way = NULL;
    size_t count = 0;
    for (const struct path *at = path; at->up; at = at->up)
        count += at->node->object != at->up->node->object;
    way = pov_allocate(reader, count, sizeof *way);
    piece->way = way;
    piece->way_length = count;
    for (const struct path *at = path; at->up && way; at = at->up)
        if (at->node->object != at->up->node->object)
            way[--count] = at->node->object;
}

static void make_mesh(const struct csg_polygons *polygons, struct mesh *mesh)
{
    size_t made = 0;
    for (size_t i = 0; i < polygons->vertex_count; i++) {
        mesh->points[i] = polygons->vertices[i].point;
        if (mesh->normals)
            mesh->normals[i] = polygons->vertices[i].normal;
    }
    for (size_t i = 0; i < polygons->count; i++)
        for (size_t k = 1; k + 1 < polygons->list[i].count; k++, made++) {
            uint32_t start = (uint32_t)polygons->list[i].start, at = start + (uint32_t)k;
            mesh->triangles[made][0] = start;
            mesh->triangles[made][1] = at;
            mesh->triangles[made][2] = at + 1;
        }
}

/* Triangles of what is left of a leaf's surface, turned over where it bounds a hole. */
static void add_piece(struct csg_work *work, struct pov_solid *solid, const struct path *path,
                      const struct csg_polygons *polygons, bool turned)
{
    struct pov_reader *reader = work->writer->reader;
    struct mesh mesh;
    size_t triangles = polygons->vertex_count - 2 * polygons->count;
    if (polygons->count == 0)
        return;
    if (triangles > MESH_TRIANGLES_LIMIT) {
        csg_fail(work, "it has too many triangles");
        return;
    }
    if (!mesh_allocate(&mesh, polygons->vertex_count, path->node->mesh.normals != NULL, false,
                       triangles)) {
        csg_stop(work);
        return;
    }
    make_mesh(polygons, &mesh);
    if (turned)
        mesh_reverse(&mesh);
    struct pov_piece piece = {.part = path->node->object, .mesh = pov_keep_mesh(reader, &mesh)};
    find_way(reader, path, &piece);
    if (pov_grow(reader, (void **)&solid->pieces, &solid->capacity, solid->piece_count + 1,
                 sizeof piece))
        solid->pieces[solid->piece_count++] = piece;
    work->failed = work->failed || reader->stopped;
}

/* Whether a part that is not convex, and so cuts nothing, bounds what the path leads to. */
static bool is_bounded_in_vain(const struct path *path)
{
    bool bounded = false;
    for (; path->up; path = path->up) {
        const struct csg_node *node = path->up->node;
        for (size_t i = 0; i < node->child_count && node->kind == CSG_ALL; i++)
            bounded |= i != path->child && !node->children[i]->cuts && !node->children[i]->inverse;
    }
    return bounded;
}

/* Whether polygons of a plane reach a corner of the mesh that stands for it, which lies far
 * away. */
static bool reach_end(const struct csg_polygons *polygons, const struct mesh *plane)
{
    bool reach = false;
    for (size_t i = 0; i < polygons->vertex_count; i++)
        for (size_t k = 0; k < plane->vertex_count; k++) {
            struct vector off = vector_subtract(polygons->vertices[i].point, plane->points[k]);
            reach |= vector_length(off) <= TOLERANCE * vector_length(plane->points[k]);
        }
    return reach;
}

static void add_surface(struct csg_work *work, struct pov_solid *solid, const struct path *path)
{
    const struct csg_node *leaf = path->node;
    struct csg_polygons kept = {.budget = &work->budget}, next = kept;
    bool turned = leaf->inverse && path->up;
    add_triangles(work, leaf, &kept);
    for (const struct path *at = path; at->up; at = at->up) {
        const struct csg_node *node = at->up->node;
        for (size_t i = 0; i < node->child_count && !work->failed; i++) {
            if (i == at->child || !node->children[i]->cuts)
                continue;
            csg_polygons_clear(&next);
            cut(work, node->children[i], &kept, node->kind == CSG_ALL ? &next : NULL,
                node->kind == CSG_ALL ? NULL : &next);
            struct csg_polygons swapped = kept;
            kept = next;
            next = swapped;
        }
        turned = turned != (node->inverse && at->up->up);
    }
    bool is_plane = leaf->object->shape == POV_SHAPE_PLANE;
    if (!work->failed && is_plane && is_bounded_in_vain(path) && reach_end(&kept, &leaf->mesh))
        pov_warn_at(work->writer->reader, leaf->object->file, &leaf->object->token,
                    "the face by which plane ends a part that is not convex is left out");
    else if (!work->failed)
        add_piece(work, solid, path, &kept, turned);
    csg_polygons_release(&kept);
    csg_polygons_release(&next);
}

static void add_node(struct csg_work *work, struct pov_solid *solid, const struct path *path)
{
    const struct csg_node *node = path->node;
    if (work->failed || node->is_clip)
        return;
    if (node->kind == CSG_LEAF)
        add_surface(work, solid, path);
    for (size_t i = 0; i < node->child_count; i++)
        add_node(work, solid, &(struct path){path, node->children[i], i});
}

static double size_of(const struct csg_node *node)
{
    double size = node->kind == CSG_LEAF && node->convex.radius < INFINITY
                      ? node->convex.radius + vector_length(node->convex.center)
                      : 0.0;
    for (size_t i = 0; i < node->child_count; i++)
        size = fmax(size, size_of(node->children[i]));
    return size;
}

void pov_make_solid(struct pov_writer *writer, struct pov_solid *solid)
{
    size_t left = writer->cutting_left,
           most = left < MOST_STEPS_OF_SOLID ? left : MOST_STEPS_OF_SOLID;
    struct csg_work work = {.writer = writer, .object = solid->object};
    work.budget = (struct csg_budget){.steps = most, .bytes = pov_memory_left(writer->reader)};
    struct csg_node *root = csg_build(&work);
    if (root && !work.failed) {
        work.tolerance = TOLERANCE * fmax(size_of(root), 1e-6);
        add_node(&work, solid, &(struct path){NULL, root, 0});
    }
    writer->cutting_left -= most - work.budget.steps;
    if (work.failed) /* whole, or not at all */
        solid->piece_count = 0;
    csg_release(root);
}
