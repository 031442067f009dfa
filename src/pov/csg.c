/* csg.c: intersections, differences and clipped_by as meshes; see write.h.
 *
 * The surface of a solid by boolean operations is made of the surfaces of its parts, each as far as it lies inside
 * (union: outside) of the other parts (A. Requicha and H. Voelcker, "Boolean operations in solid modeling", 1985). The
 * parts that cut are convex, as spheres, boxes, cylinders, cones and planes are: their faces' planes cut the polygons
 * of the others. A part that is not convex is cut, but cuts nothing, with a warning; the face of a plane that such a part
 * ought to bound is left out. No library does that in plain C; the solids of scenes by hand are small.
 */
#include "pov/polygons.h"
#include "pov/write.h"

#include <stdlib.h>
#include <string.h>

#define DEEPEST 100
#define MOST_NODES_OF_SOLID 10000
#define MOST_STEPS ((size_t)2000000000) /* planes times corners, of one solid */
#define MOST_CHECKED ((size_t)4000000)  /* planes times points, to see whether a mesh is convex */
#define TOLERANCE 1e-9                  /* of the solid's size */

enum kind { LEAF, ALL, ANY };

struct node {
    enum kind kind;
    bool inverse;
    bool is_clip; /* cuts, but its surface is not seen */
    bool cuts;    /* it is convex, or a part of it is: others are as if they were not there */
    const struct pov_object *object;
    struct pov_above look;
    struct mesh mesh; /* LEAF: in POV-Ray's world; owned */
    struct csg_convex convex;
    struct node **children; /* owned, each too */
    size_t child_count;
};

struct solid {
    struct pov_writer *writer;
    const struct pov_object *object;
    size_t node_count, steps;
    double tolerance;
    bool failed; /* it is too large, or there is no memory: reported */
};

static void release(struct node *node)
{
    if (!node)
        return;
    for (size_t i = 0; i < node->child_count; i++)
        release(node->children[i]);
    free(node->children);
    free(node->convex.planes);
    mesh_release(&node->mesh);
    free(node);
}

static void fail(struct solid *solid, const char *why)
{
    if (!solid->failed)
        pov_warn_at(solid->writer->reader, solid->object->file, &solid->object->token,
                    "an intersection or difference is left out: %s", why);
    solid->failed = true;
}

static void no_memory(struct solid *solid)
{
    pov_no_memory(solid->writer->reader);
    solid->failed = true;
}

/* --- leaves --------------------------------------------------------------------------------------- */

static bool is_same_plane(const struct csg_plane *a, const struct csg_plane *b, double size)
{
    return vector_length(vector_subtract(a->normal, b->normal)) < 1e-7 &&
           fabs(a->distance - b->distance) < 1e-7 * size;
}

/* The planes of the faces, without those that follow another in the same plane. */
static bool find_planes(struct node *node)
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
        n = (struct vector){n.x / length, n.y / length, n.z / length};
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

static void find_sphere(struct node *node)
{
    const struct mesh *mesh = &node->mesh;
    struct vector sum = {0, 0, 0};
    double count = (double)mesh->vertex_count;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        sum = (struct vector){sum.x + mesh->points[i].x, sum.y + mesh->points[i].y,
                              sum.z + mesh->points[i].z};
    node->convex.center = (struct vector){sum.x / count, sum.y / count, sum.z / count};
    for (size_t i = 0; i < mesh->vertex_count; i++)
        node->convex.radius =
            fmax(node->convex.radius,
                 vector_length(vector_subtract(mesh->points[i], node->convex.center)));
}

static bool is_convex(const struct node *node)
{
    const struct csg_convex *convex = &node->convex;
    double tolerance = 1e-6 * convex->radius;
    if (convex->plane_count < 4 || convex->plane_count > MOST_CHECKED / node->mesh.vertex_count)
        return false;
    for (size_t i = 0; i < convex->plane_count; i++)
        for (size_t k = 0; k < node->mesh.vertex_count; k++)
            if (vector_dot(convex->planes[i].normal, node->mesh.points[k]) -
                    convex->planes[i].distance >
                tolerance)
                return false;
    return true;
}

/* To POV-Ray's world, fronts outwards also where the transform mirrors. */
static void place(struct node *node)
{
    const struct transform *map = &node->look.place;
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

static void make_leaf(struct solid *solid, struct node *node)
{
    struct pov_writer *writer = solid->writer;
    struct transform unused;
    const struct pov_object *object = node->object;
    bool is_plane = object->shape == POV_SHAPE_PLANE;
    if (!pov_placement(writer, object, &node->look.place, &unused) || !pov_has_extent(object))
        return;
    if (object->shape == POV_SHAPE_MESH && !copy_mesh(object->mesh, &node->mesh))
        pov_no_memory(writer->reader);
    else if (object->shape != POV_SHAPE_MESH)
        pov_tessellate(writer, object, &node->mesh);
    if (writer->reader->stopped) {
        solid->failed = true;
        return;
    }
    if (node->mesh.vertex_count > 0) {
        place(node);
        find_sphere(node);
        if (!find_planes(node)) {
            no_memory(solid);
            return;
        }
        node->cuts = is_plane ? node->convex.plane_count == 1 : is_convex(node);
    }
    if (is_plane)
        node->convex.radius = INFINITY;
    if (!node->cuts)
        pov_warn_at(
            writer->reader, object->file, &object->token,
            "%s in an intersection or difference is cut, but cuts nothing: it is not convex",
            pov_text(writer->reader, object->token.word));
}

/* --- the tree ------------------------------------------------------------------------------------- */

static struct node *build(struct solid *solid, const struct pov_object *object,
                          const struct pov_above *above, int depth);

static void add_child(struct solid *solid, struct node *node, struct node *child)
{
    size_t size = (node->child_count + 1) * sizeof *node->children;
    struct node **grown = child ? realloc(node->children, size) : NULL;
    if (!grown) {
        if (child)
            no_memory(solid);
        release(child);
        return;
    }
    node->children = grown;
    node->children[node->child_count++] = child;
    node->cuts = node->cuts || child->cuts;
}

static struct node *new_node(struct solid *solid, enum kind kind, const struct pov_object *object)
{
    struct node *node = NULL;
    if (++solid->node_count > MOST_NODES_OF_SOLID)
        fail(solid, "it has more than 10000 parts");
    else if (node = calloc(1, sizeof *node), !node)
        no_memory(solid);
    if (node) {
        node->kind = kind;
        node->object = object;
    }
    return node;
}

static void mark_clip(struct node *node)
{
    node->is_clip = true;
    for (size_t i = 0; i < node->child_count; i++)
        mark_clip(node->children[i]);
}

/* The object itself, without its clips. */
static struct node *build_object(struct solid *solid, const struct pov_object *object,
                                 const struct pov_above *look, int depth)
{
    enum kind kind = object->shape == POV_SHAPE_UNION          ? ANY
                     : object->shape == POV_SHAPE_INTERSECTION ? ALL
                                                               : LEAF;
    struct node *node = new_node(solid, kind, object);
    if (!node)
        return NULL;
    node->inverse = object->inverse;
    node->look = *look;
    if (kind == LEAF)
        make_leaf(solid, node);
    for (size_t i = 0; i < object->child_count && kind != LEAF && !solid->failed; i++) {
        struct node *child = build(solid, object->children[i], look, depth + 1);
        if (child)
            add_child(solid, node, child);
    }
    return node;
}

/* NULL: nothing, or reported. */
static struct node *build(struct solid *solid, const struct pov_object *object,
                          const struct pov_above *above, int depth)
{
    struct pov_above look = pov_below(object, above);
    if (depth > DEEPEST)
        fail(solid, "its parts are in each other more than 100 deep");
    if (depth > 0)
        pov_warn_of_object(solid->writer, object);
    if (solid->failed || object->shape == POV_SHAPE_NOTHING)
        return NULL;
    if (object->shape == POV_SHAPE_LIGHT || object->shape == POV_SHAPE_HEIGHT_FIELD) {
        pov_warn_at(solid->writer->reader, object->file, &object->token,
                    "%s in an intersection or difference is left out",
                    pov_text(solid->writer->reader, object->token.word));
        return NULL;
    }
    struct node *node = build_object(solid, object, &look, depth);
    if (!node || object->clip_count == 0)
        return node;
    struct node *clipped = new_node(solid, ALL, object);
    if (!clipped) {
        release(node);
        return NULL;
    }
    clipped->inverse = node->inverse;
    node->inverse = false;
    add_child(solid, clipped, node);
    /* Clips move with the object. */
    struct pov_above moved = {.place = look.place, .texture_place = transform_identity};
    for (size_t i = 0; i < object->clip_count && !solid->failed; i++) {
        struct node *clip = build(solid, object->clips[i], &moved, depth + 1);
        if (clip) {
            mark_clip(clip);
            add_child(solid, clipped, clip);
        }
    }
    return clipped;
}

/* --- cutting -------------------------------------------------------------------------------------- */

static void append(struct solid *solid, const struct csg_polygons *from, struct csg_polygons *to)
{
    for (size_t i = 0; i < from->count && to && !solid->failed; i++)
        if (!csg_polygons_add(to, from->vertices + from->list[i].start, from->list[i].count))
            no_memory(solid);
}

/* Adds to `inside` and `outside` what of the polygons is so of the node. */
static void cut(struct solid *solid, const struct node *node, const struct csg_polygons *polygons,
                struct csg_polygons *inside, struct csg_polygons *outside)
{
    if (node->inverse) {
        struct csg_polygons *swapped = inside;
        inside = outside;
        outside = swapped;
    }
    if (solid->steps > MOST_STEPS)
        fail(solid, "its parts cut each other too often");
    if (solid->failed)
        return;
    if (node->kind == LEAF) {
        if (!csg_cut(polygons, &node->convex, solid->tolerance, inside, outside, &solid->steps))
            no_memory(solid);
        return;
    }
    struct csg_polygons rest = {0}, next = {0};
    append(solid, polygons, &rest);
    for (size_t i = 0; i < node->child_count && !solid->failed; i++) {
        if (!node->children[i]->cuts)
            continue;
        csg_polygons_clear(&next);
        cut(solid, node->children[i], &rest, node->kind == ALL ? &next : inside,
            node->kind == ALL ? outside : &next);
        struct csg_polygons swapped = rest;
        rest = next;
        next = swapped;
    }
    append(solid, &rest, node->kind == ALL ? inside : outside);
    csg_polygons_release(&rest);
    csg_polygons_release(&next);
}

static void add_triangles(struct solid *solid, const struct node *leaf, struct csg_polygons *to)
{
    const struct mesh *mesh = &leaf->mesh;
    for (size_t i = 0; i < mesh->triangle_count && !solid->failed; i++) {
        struct csg_vertex corners[3] = {{{0, 0, 0}, {0, 0, 0}}};
        for (int k = 0; k < 3; k++) {
            corners[k].point = mesh->points[mesh->triangles[i][k]];
            if (mesh->normals)
                corners[k].normal = mesh->normals[mesh->triangles[i][k]];
        }
        if (!csg_polygons_add(to, corners, 3))
            no_memory(solid);
    }
}

/* --- writing -------------------------------------------------------------------------------------- */

/* Triangles of what is left of a leaf's surface, turned over where it bounds a hole. */
static void write_leaf(struct solid *solid, const struct node *leaf,
                       const struct csg_polygons *polygons, bool turned)
{
    struct mesh mesh;
    size_t triangles = polygons->vertex_count - 2 * polygons->count, made = 0;
    if (polygons->count == 0)
        return;
    if (triangles > MESH_TRIANGLES_LIMIT) {
        fail(solid, "it has too many triangles");
        return;
    }
    if (!mesh_allocate(&mesh, polygons->vertex_count, leaf->mesh.normals != NULL, false,
                       triangles)) {
        no_memory(solid);
        return;
    }
    for (size_t i = 0; i < polygons->vertex_count; i++) {
        mesh.points[i] = polygons->vertices[i].point;
        if (mesh.normals)
            mesh.normals[i] = polygons->vertices[i].normal;
    }
    for (size_t i = 0; i < polygons->count; i++)
        for (size_t k = 1; k + 1 < polygons->list[i].count; k++, made++) {
            uint32_t start = (uint32_t)polygons->list[i].start, at = start + (uint32_t)k;
            mesh.triangles[made][0] = start;
            mesh.triangles[made][1] = at;
            mesh.triangles[made][2] = at + 1;
        }
    if (turned)
        mesh_reverse(&mesh);
    pov_write_mesh(solid->writer, leaf->object, &mesh, &transform_identity, &leaf->look);
    mesh_release(&mesh);
}

/* The way from the root to a leaf. */
struct path {
    const struct path *up;
    const struct node *node;
    size_t child; /* which of its children is on the way */
};

/* Whether a part that is not convex, and so cuts nothing, bounds what the path leads to. */
static bool is_bounded_in_vain(const struct path *path)
{
    bool bounded = false;
    for (; path; path = path->up)
        for (size_t i = 0; i < path->node->child_count && path->node->kind == ALL; i++) {
            const struct node *part = path->node->children[i];
            bounded |= i != path->child && !part->cuts && !part->inverse;
        }
    return bounded;
}

/* Whether polygons of a plane reach a corner of the mesh that stands for it, which lies far away. */
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

static void write_surface(struct solid *solid, const struct node *leaf, const struct path *path)
{
    struct csg_polygons kept = {0}, next = {0};
    bool turned = leaf->inverse && path != NULL;
    add_triangles(solid, leaf, &kept);
    for (const struct path *at = path; at; at = at->up) {
        const struct node *node = at->node;
        for (size_t i = 0; i < node->child_count && !solid->failed; i++) {
            if (i == at->child || !node->children[i]->cuts)
                continue;
            csg_polygons_clear(&next);
            cut(solid, node->children[i], &kept, node->kind == ALL ? &next : NULL,
                node->kind == ALL ? NULL : &next);
            struct csg_polygons swapped = kept;
            kept = next;
            next = swapped;
        }
        turned = turned != (node->inverse && at->up != NULL);
    }
    bool is_plane = leaf->object->shape == POV_SHAPE_PLANE;
    if (!solid->failed && is_plane && is_bounded_in_vain(path) && reach_end(&kept, &leaf->mesh))
        pov_warn_at(solid->writer->reader, leaf->object->file, &leaf->object->token,
                    "the face by which plane ends a part that is not convex is left out");
    else if (!solid->failed)
        write_leaf(solid, leaf, &kept, turned);
    csg_polygons_release(&kept);
    csg_polygons_release(&next);
}

static void write_node(struct solid *solid, const struct node *node, const struct path *path)
{
    if (solid->failed || node->is_clip)
        return;
    if (node->kind == LEAF)
        write_surface(solid, node, path);
    for (size_t i = 0; i < node->child_count; i++) {
        const struct path further = {path, node, i};
        write_node(solid, node->children[i], &further);
    }
}

static double size_of(const struct node *node)
{
    double size = node->kind == LEAF && node->convex.radius < INFINITY
                      ? node->convex.radius + vector_length(node->convex.center)
                      : 0.0;
    for (size_t i = 0; i < node->child_count; i++)
        size = fmax(size, size_of(node->children[i]));
    return size;
}

void pov_write_intersection(struct pov_writer *writer, const struct pov_object *object,
                            const struct pov_above *above)
{
    struct solid solid = {.writer = writer, .object = object};
    struct node *root = build(&solid, object, above, 0);
    if (root && !solid.failed) {
        solid.tolerance = TOLERANCE * fmax(size_of(root), 1e-6);
        write_node(&solid, root, NULL);
    }
    release(root);
}
