/* subdivision.c: Loop subdivision (C. Loop, "Smooth subdivision surfaces based on triangles",
 * 1987), with the weights of Pharr, Jakob and Humphreys, "Physically based rendering", on
 * subdivision surfaces.
 *
 * A vertex of valence n moves to (1 - n b) p + b sum of its neighbours, with b = 3/16 for n = 3 and
 * else 3/(8 n); on a border to 3/4 p + 1/8 of the two along it. An edge gets a vertex at 3/8 of its
 * ends and 1/8 of the two corners across, on a border at its middle. In the end vertices move to
 * their limits, by g = 1/(n + 3/(8 b)) in place of b, 1/5 on a border, and have the normal S x T of
 * the tangents S = sum of cos(2 pi j/n) p_j, T the same of sines, over the ring of neighbours.
 * Rings are walked clockwise, as pbrt does, whose normals so are on the backs of its triangles.
 *
 * Edges are found by sorting: the order of the vertices is that of the input, whatever the machine.
 */
#include "pbrt/shape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_TRIANGLES ((size_t)1 << 22)
#define PI 3.14159265358979323846

/* One side of a triangle, from corner k to the next. */
struct side {
    uint32_t low, high; /* its vertices */
    uint32_t triangle, k;
};

struct edge {
    uint32_t ends[2], across[2]; /* vertices; across: of a border the same twice */
    bool is_border;
};

struct edges {
    struct side *sides; /* sorted */
    struct edge *edges;
    uint32_t (*of_triangle)[3]; /* edge of each side */
    size_t count;
};

static void release_edges(struct edges *edges)
{
    free(edges->sides);
    free(edges->edges);
    free(edges->of_triangle);
    *edges = (struct edges){0};
}

static int compare_sides(const void *a, const void *b)
{
    const struct side *x = a, *y = b;
    if (x->low != y->low)
        return x->low < y->low ? -1 : 1;
    if (x->high != y->high)
        return x->high < y->high ? -1 : 1;
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

static void collect_sides(const struct mesh *mesh, struct side *sides)
{
    for (size_t i = 0; i < mesh->triangle_count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t a = mesh->triangles[i][k], b = mesh->triangles[i][(k + 1) % 3];
            sides[3 * i + k] = (struct side){a < b ? a : b, a < b ? b : a, (uint32_t)i, k};
        }
    qsort(sides, 3 * mesh->triangle_count, sizeof *sides, compare_sides);
}

/* False: reported. Where an edge has not two triangles, it counts as a border. */
static bool find_edges(struct importer *importer, const struct mesh *mesh, struct edges *edges)
{
    size_t side_count = 3 * mesh->triangle_count;
    *edges = (struct edges){.sides = malloc((side_count + 1) * sizeof *edges->sides),
                            .edges = malloc((side_count + 1) * sizeof *edges->edges),
                            .of_triangle =
                                malloc((mesh->triangle_count + 1) * sizeof *edges->of_triangle)};
    if (!edges->sides || !edges->edges || !edges->of_triangle) {
        release_edges(edges);
        return importer_no_memory(importer);
    }
    collect_sides(mesh, edges->sides);
    for (size_t i = 0, next; i < side_count; i = next) {
        const struct side *first = &edges->sides[i];
        struct edge edge = {.ends = {first->low, first->high}};
        for (next = i; next < side_count && edges->sides[next].low == first->low &&
                       edges->sides[next].high == first->high;
             next++) {
            const struct side *side = &edges->sides[next];
            edges->of_triangle[side->triangle][side->k] = (uint32_t)edges->count;
            edge.across[next == i ? 0 : 1] = mesh->triangles[side->triangle][(side->k + 2) % 3];
        }
        edge.is_border = next - i != 2;
        edges->edges[edges->count++] = edge;
    }
    return true;
}

static void add_scaled(struct vector *sum, double s, struct vector p)
{
    *sum = (struct vector){sum->x + s * p.x, sum->y + s * p.y, sum->z + s * p.z};
}

/* What surrounds a vertex. */
struct surroundings {
    struct vector sum, border_sum;
    unsigned valence, border_valence;
};

static double limit_weight(unsigned valence, bool limit)
{
    double b = valence == 3 ? 3.0 / 16.0 : 3.0 / (8.0 * valence);
    return limit ? 1.0 / (valence + 3.0 / (8.0 * b)) : b;
}

/* Moves the mesh's own vertices, to their next places or their limits. False: reported. */
static bool move_vertices(struct importer *importer, const struct mesh *mesh,
                          const struct edges *edges, bool limit, struct vector *moved)
{
    struct surroundings *all = calloc(mesh->vertex_count + 1, sizeof *all);
    if (!all)
        return importer_no_memory(importer);
    for (size_t i = 0; i < edges->count; i++)
        for (int end = 0; end < 2; end++) {
            struct surroundings *around = &all[edges->edges[i].ends[end]];
            struct vector other = mesh->points[edges->edges[i].ends[1 - end]];
            add_scaled(&around->sum, 1.0, other);
            around->valence++;
            if (edges->edges[i].is_border) {
                add_scaled(&around->border_sum, 1.0, other);
                around->border_valence++;
            }
        }
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        const struct surroundings *around = &all[i];
        bool border = around->border_valence == 2;
        unsigned n = border ? 2 : around->valence;
        double weight = border ? (limit ? 1.0 / 5.0 : 1.0 / 8.0) : limit_weight(n, limit);
        moved[i] = (struct vector){0, 0, 0};
        /* Where no surface or several meet, the vertex stays. */
        bool stays = n == 0 || (!border && around->border_valence > 0);
        add_scaled(&moved[i], stays ? 1.0 : 1.0 - n * weight, mesh->points[i]);
        add_scaled(&moved[i], stays ? 0.0 : weight, border ? around->border_sum : around->sum);
    }
    free(all);
    return true;
}

static struct vector edge_point(const struct mesh *mesh, const struct edge *edge)
{
    double along = edge->is_border ? 1.0 / 2.0 : 3.0 / 8.0,
           across = edge->is_border ? 0.0 : 1.0 / 8.0;
    struct vector p = {0, 0, 0};
    for (int i = 0; i < 2; i++) {
        add_scaled(&p, along, mesh->points[edge->ends[i]]);
        add_scaled(&p, across, mesh->points[edge->across[edge->is_border ? 0 : i]]);
    }
    return p;
}

/* Each triangle becomes three at its corners and one between. False: reported. */
static bool divide(struct importer *importer, struct mesh *mesh)
{
    struct edges edges;
    struct mesh finer;
    if (!find_edges(importer, mesh, &edges))
        return false;
    size_t vertices = mesh->vertex_count + edges.count;
    bool good = mesh_allocate(&finer, vertices, false, false, 4 * mesh->triangle_count) ||
                importer_no_memory(importer);
    if (good && move_vertices(importer, mesh, &edges, false, finer.points)) {
        for (size_t i = 0; i < edges.count; i++)
            finer.points[mesh->vertex_count + i] = edge_point(mesh, &edges.edges[i]);
        for (size_t i = 0; i < mesh->triangle_count; i++) {
            const uint32_t *corners = mesh->triangles[i];
            uint32_t middles[3];
            for (int k = 0; k < 3; k++)
                middles[k] = (uint32_t)mesh->vertex_count + edges.of_triangle[i][k];
            for (int k = 0; k < 3; k++)
                memcpy(finer.triangles[4 * i + (size_t)k],
                       (const uint32_t[3]){corners[k], middles[k], middles[(k + 2) % 3]},
                       sizeof *finer.triangles);
            memcpy(finer.triangles[4 * i + 3], middles, sizeof middles);
        }
        mesh_release(mesh);
        *mesh = finer;
    } else if (good) {
        mesh_release(&finer);
        good = false;
    }
    release_edges(&edges);
    return good;
}

/* --- normals
 * -------------------------------------------------------------------------------------- */

#define LARGEST_RING 256

/* The triangles around each vertex: first[i] up to first[i + 1] of `corners`, three times the
 * triangle plus the corner. */
struct fans {
    uint32_t *first, *corners;
};

static bool find_fans(struct importer *importer, const struct mesh *mesh, struct fans *fans)
{
    *fans = (struct fans){calloc(mesh->vertex_count + 2, sizeof *fans->first),
                          malloc((3 * mesh->triangle_count + 1) * sizeof *fans->corners)};
    if (!fans->first || !fans->corners) {
        free(fans->first);
        free(fans->corners);
        return importer_no_memory(importer);
    }
    const uint32_t *all = &mesh->triangles[0][0];
    size_t count = 3 * mesh->triangle_count;
    for (size_t i = 0; i < count; i++)
        fans->first[all[i] + 2]++;
    for (size_t i = 2; i < mesh->vertex_count + 2; i++)
        fans->first[i] += fans->first[i - 1];
    for (size_t i = 0; i < count; i++)
        fans->corners[fans->first[all[i] + 1]++] = (uint32_t)i;
    return true;
}

/* The ring of an inner vertex, clockwise; 0: it has none. */
static size_t find_ring(const struct mesh *mesh, const uint32_t *corners, size_t count,
                        uint32_t *ring)
{
    if (count < 3 || count > LARGEST_RING)
        return 0;
    uint32_t start = mesh->triangles[corners[0] / 3][(corners[0] % 3 + 1) % 3], at = start;
    for (size_t length = 0; length < count; length++) {
        size_t i = 0;
        ring[length] = at;
        /* The triangle whose last corner is `at` lies clockwise of it. */
        while (i < count && mesh->triangles[corners[i] / 3][(corners[i] % 3 + 2) % 3] != at)
            i++;
        if (i == count)
            return 0;
        at = mesh->triangles[corners[i] / 3][(corners[i] % 3 + 1) % 3];
        if (at == start)
            return length + 1 == count ? count : 0;
    }
    return 0;
}

static struct vector ring_normal(const struct mesh *mesh, const uint32_t *ring, size_t count)
{
    struct vector s = {0, 0, 0}, t = {0, 0, 0};
    for (size_t j = 0; j < count; j++) {
        double angle = 2.0 * PI * (double)j / (double)count;
        add_scaled(&s, cos(angle), mesh->points[ring[j]]);
        add_scaled(&t, sin(angle), mesh->points[ring[j]]);
    }
    return vector_cross(s, t);
}

/* Of the triangles, by area, on the side of a ring's. */
static struct vector fan_normal(const struct mesh *mesh, const uint32_t *corners, size_t count)
{
    struct vector sum = {0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        const uint32_t *t = mesh->triangles[corners[i] / 3];
        struct vector a = mesh->points[t[0]];
        add_scaled(&sum, -1.0,
                   vector_cross(vector_subtract(mesh->points[t[1]], a),
                                vector_subtract(mesh->points[t[2]], a)));
    }
    return sum;
}

static bool add_normals(struct importer *importer, struct mesh *mesh)
{
    struct fans fans;
    mesh->normals = calloc(mesh->vertex_count + 1, sizeof *mesh->normals);
    if (!mesh->normals)
        return importer_no_memory(importer);
    if (!find_fans(importer, mesh, &fans))
        return false;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        const uint32_t *corners = fans.corners + fans.first[i];
        size_t count = fans.first[i + 1] - fans.first[i];
        uint32_t ring[LARGEST_RING];
        size_t length = find_ring(mesh, corners, count, ring);
        struct vector n =
            length ? ring_normal(mesh, ring, length) : fan_normal(mesh, corners, count);
        double size = vector_length(n);
        mesh->normals[i] = size > 0.0 ? (struct vector){n.x / size, n.y / size, n.z / size}
                                      : (struct vector){0, 0, 1}; /* in no triangle with an area */
    }
    free(fans.first);
    free(fans.corners);
    return true;
}

bool subdivision_refine(struct importer *importer, const struct statement *statement,
                        struct mesh *mesh, long levels)
{
    size_t most =
        importer->options->most_triangles ? importer->options->most_triangles : MOST_TRIANGLES;
    for (long level = 0; level < levels; level++) {
        if (mesh->triangle_count > most / 4) {
            importer_error(importer, &statement->origin, statement->width,
                           "Shape loopsubdiv: %ld levels make more than %zu triangles", levels,
                           most);
            return false;
        }
        if (!divide(importer, mesh))
            return false;
    }
    struct edges edges;
    if (!find_edges(importer, mesh, &edges))
        return false;
    struct vector *limits = malloc((mesh->vertex_count + 1) * sizeof *limits);
    bool good =
        limits ? move_vertices(importer, mesh, &edges, true, limits) : importer_no_memory(importer);
    release_edges(&edges);
    if (!good) {
        free(limits);
        return false;
    }
    free(mesh->points);
    mesh->points = limits;
    return add_normals(importer, mesh);
}
