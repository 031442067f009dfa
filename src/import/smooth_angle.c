/* smooth_angle.c: normals for a mesh without any, by the angle at its edges.
 *
 * Two triangles that share an edge are one smooth surface there if their normals differ by at most
 * an angle. Around a vertex, the corners that such edges join get one normal: the mean of their
 * triangles' normals, weighted by the angles of the corners (Thuermer and Wuethrich 1998), so that
 * it does not depend on how a face was cut into triangles. Vertices belong together by their
 * places, since files repeat them for each face. An edge of one triangle, of more than two, or of
 * two that face different sides, is sharp.
 *
 * Not by assimp: it weighs all triangles alike, and looks at all pairs around a place.
 */
#include "import/geometry.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#define RADIANS (3.14159265358979323846 / 180.0)
#define SLACK 1e-6f /* rounding of the cosine */

struct place {
    float at[3];
    uint32_t vertex;
};

/* From a corner to the next one of its triangle, between two places. */
struct edge {
    uint32_t low, high;
    uint32_t corner; /* 3 for each triangle */
};

/* A vertex as the corners of one smooth surface have it. */
struct split {
    uint32_t vertex, root, corner;
};

struct smoothing {
    struct mesh_description *mesh;
    size_t corner_count;
    uint32_t *place_of; /* for each vertex */
    uint32_t *root;     /* for each corner: one that it is joined with, itself at the root */
    ps_vec3 *normals;   /* of triangles */
    ps_vec3 *sums;      /* for each corner that is a root */
};

static uint32_t vertex_of(const struct smoothing *s, uint32_t corner)
{
    return s->mesh->triangles[corner / 3][corner % 3];
}

static uint32_t next_corner(uint32_t corner)
{
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

static ps_vec3 point_of(const struct smoothing *s, uint32_t corner)
{
    return s->mesh->vertices[vertex_of(s, corner)];
}

/* --- what belongs together
 * ------------------------------------------------------------------------ */

static int compare_places(const void *a, const void *b)
{
    const struct place *p = a, *q = b;
    for (int i = 0; i < 3; i++)
        if (p->at[i] != q->at[i])
            return p->at[i] < q->at[i] ? -1 : 1;
    return p->vertex < q->vertex ? -1 : p->vertex > q->vertex;
}

static bool number_places(struct smoothing *s)
{
    size_t count = s->mesh->vertex_count;
    struct place *places = malloc(count * sizeof *places);
    uint32_t number = 0;
    if (!places)
        return false;
    for (size_t i = 0; i < count; i++) {
        ps_vec3 p = s->mesh->vertices[i];
        places[i] = (struct place){{p.x, p.y, p.z}, (uint32_t)i};
    }
    qsort(places, count, sizeof *places, compare_places);
    for (size_t i = 0; i < count; i++) {
        const float *at = places[i].at, *before = places[i > 0 ? i - 1 : 0].at;
        number += at[0] != before[0] || at[1] != before[1] || at[2] != before[2];
        s->place_of[places[i].vertex] = number;
    }
    free(places);
    return true;
}

static int compare_edges(const void *a, const void *b)
{
    const struct edge *p = a, *q = b;
    if (p->low != q->low)
        return p->low < q->low ? -1 : 1;
    if (p->high != q->high)
        return p->high < q->high ? -1 : 1;
    return p->corner < q->corner ? -1 : p->corner > q->corner;
}

static uint32_t find_root(struct smoothing *s, uint32_t corner)
{
    while (s->root[corner] != corner)
        corner = s->root[corner] = s->root[s->root[corner]];
    return corner;
}

static void join(struct smoothing *s, uint32_t a, uint32_t b)
{
    a = find_root(s, a);
    b = find_root(s, b);
    if (a < b)
        s->root[b] = a;
    else
        s->root[a] = b;
}

/* The two triangles of an edge, whose corners lie at its beginning as each of them runs. */
static void join_across(struct smoothing *s, uint32_t a, uint32_t b, float least)
{
    bool opposite = s->place_of[vertex_of(s, a)] != s->place_of[vertex_of(s, b)];
    if (!opposite || ps_dot(s->normals[a / 3], s->normals[b / 3]) < least)
        return;
    join(s, a, next_corner(b));
    join(s, next_corner(a), b);
}

static bool join_smooth_edges(struct smoothing *s, float least)
{
    struct edge *edges = malloc(s->corner_count * sizeof *edges);
    if (!edges)
        return false;
    for (uint32_t c = 0; c < s->corner_count; c++) {
        uint32_t from = s->place_of[vertex_of(s, c)];
        uint32_t to = s->place_of[vertex_of(s, next_corner(c))];
        edges[c] = (struct edge){from < to ? from : to, from < to ? to : from, c};
    }
    qsort(edges, s->corner_count, sizeof *edges, compare_edges);
    for (size_t i = 0, end; i < s->corner_count; i = end) {
        for (end = i + 1; end < s->corner_count && edges[end].low == edges[i].low &&
                          edges[end].high == edges[i].high;)
            end++;
        if (end - i == 2)
            join_across(s, edges[i].corner, edges[i + 1].corner, least);
    }
    free(edges);
    return true;
}

/* --- normals
 * -------------------------------------------------------------------------------------- */

static void find_triangle_normals(struct smoothing *s)
{
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        ps_vec3 a = point_of(s, 3 * t);
        s->normals[t] = ps_normalize(ps_cross(ps_subtract(point_of(s, 3 * t + 1), a),
                                              ps_subtract(point_of(s, 3 * t + 2), a)));
    }
}

static float angle_at(const struct smoothing *s, uint32_t corner)
{
    uint32_t next = next_corner(corner);
    ps_vec3 at = point_of(s, corner);
    ps_vec3 u = ps_normalize(ps_subtract(point_of(s, next), at));
    ps_vec3 v = ps_normalize(ps_subtract(point_of(s, next_corner(next)), at));
    return atan2f(ps_length(ps_cross(u, v)), ps_dot(u, v));
}

static void add_normals(struct smoothing *s)
{
    for (uint32_t c = 0; c < s->corner_count; c++) {
        ps_vec3 *sum = &s->sums[find_root(s, c)];
        *sum = ps_add(*sum, ps_scale(s->normals[c / 3], angle_at(s, c)));
    }
}

static int compare_splits(const void *a, const void *b)
{
    const struct split *p = a, *q = b;
    if (p->vertex != q->vertex)
        return p->vertex < q->vertex ? -1 : 1;
    if (p->root != q->root)
        return p->root < q->root ? -1 : 1;
    return p->corner < q->corner ? -1 : p->corner > q->corner;
}

/* One for each vertex that is to be, in the order of the old ones; triangles get their numbers.
 * NULL: out of memory. */
static struct split *split_vertices(struct smoothing *s, size_t *vertex_count)
{
    struct split *splits = malloc(s->corner_count * sizeof *splits);
    size_t count = 0;
    if (!splits)
        return NULL;
    for (uint32_t c = 0; c < s->corner_count; c++)
        splits[c] = (struct split){vertex_of(s, c), find_root(s, c), c};
    qsort(splits, s->corner_count, sizeof *splits, compare_splits);
    for (size_t i = 0; i < s->corner_count; i++) {
        uint32_t corner = splits[i].corner;
        if (count == 0 || splits[count - 1].vertex != splits[i].vertex ||
            splits[count - 1].root != splits[i].root)
            splits[count++] = splits[i];
        s->mesh->triangles[corner / 3][corner % 3] = (uint32_t)count - 1;
    }
    *vertex_count = count;
    return splits;
}

/* What the old vertices had, for the new ones, where they had it. False: out of memory. */
static bool spread(void **elements, size_t size, const struct split *splits, size_t count)
{
    if (!*elements)
        return true;
    char *spread = malloc((count + 1) * size);
    if (!spread)
        return false;
    for (size_t i = 0; i < count; i++)
        memcpy(spread + i * size, (const char *)*elements + splits[i].vertex * size, size);
    free(*elements);
    *elements = spread;
    return true;
}

static bool spread_all(struct mesh_description *mesh, const struct split *splits, size_t count)
{
    return spread((void **)&mesh->vertices, sizeof *mesh->vertices, splits, count) &&
           spread((void **)&mesh->uv, sizeof *mesh->uv, splits, count) &&
           spread((void **)&mesh->second_uv, sizeof *mesh->second_uv, splits, count) &&
           spread((void **)&mesh->colors, sizeof *mesh->colors, splits, count);
}

static bool take_normals(struct smoothing *s)
{
    struct mesh_description *mesh = s->mesh;
    size_t count;
    struct split *splits = split_vertices(s, &count);
    mesh->normals = splits ? malloc((count + 1) * sizeof *mesh->normals) : NULL;
    bool good = mesh->normals && spread_all(mesh, splits, count);
    for (size_t i = 0; good && i < count; i++)
        mesh->normals[i] = s->sums[splits[i].root];
    if (good)
        mesh->vertex_count = count;
    free(splits);
    return good;
}

static bool smooth(struct smoothing *s, float least)
{
    if (!s->place_of || !s->root || !s->normals || !s->sums || !number_places(s))
        return false;
    for (uint32_t c = 0; c < s->corner_count; c++)
        s->root[c] = c;
    find_triangle_normals(s);
    if (!join_smooth_edges(s, least))
        return false;
    add_normals(s);
    return take_normals(s);
}

ps_result mesh_smooth_by_angle(struct mesh_job *job, struct mesh_description *mesh, double degrees)
{
    size_t corners = 3 * mesh->triangle_count;
    struct smoothing s = {
        .mesh = mesh,
        .corner_count = corners,
        .place_of = malloc(mesh->vertex_count * sizeof *s.place_of),
        .root = malloc(corners * sizeof *s.root),
        .normals = malloc(mesh->triangle_count * sizeof *s.normals),
        .sums = calloc(corners, sizeof *s.sums),
    };
    assert(mesh->triangle_count > 0 && !mesh->normals);
    bool good = smooth(&s, (float)cos(degrees * RADIANS) - SLACK);
    free(s.place_of);
    free(s.root);
    free(s.normals);
    free(s.sums);
    return good ? PS_OK : mesh_out_of_memory(job, corners * sizeof(struct edge));
}
