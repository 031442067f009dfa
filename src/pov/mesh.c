/* mesh.c: reads triangles and meshes of them; see object.h and the reference of POV-Ray 3.7,
 * "Mesh". */
#include "pov/expression.h"
#include "pov/object.h"
#include "pov/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- single triangles
 * ------------------------------------------------------------------------------- */

static void read_uv(struct pov_reader *reader, double uv[3][2])
{
    for (int k = 0; k < 3; k++) {
        struct vector a = pov_read_vector(reader);
        uv[k][0] = a.x;
        uv[k][1] = a.y;
        pov_skip_comma(reader);
    }
}

/* The corners, behind "triangle {" */
static struct pov_corner *read_corners(struct pov_reader *reader, bool smooth,
                                       struct pov_corner corners[3])
{
    for (int k = 0; k < 3; k++) {
        corners[k] = (struct pov_corner){.point = pov_read_vector(reader)};
        pov_skip_comma(reader);
        if (smooth) {
            corners[k].normal = pov_read_vector(reader);
            pov_skip_comma(reader);
        }
    }
    return corners;
}

void pov_read_triangle(struct pov_reader *reader, struct pov_object *object, bool smooth)
{
    struct pov_surface surface = {.reader = reader, .has_normals = smooth};
    struct pov_corner corners[3];
    pov_surface_triangle(&surface, read_corners(reader, smooth, corners));
    pov_surface_finish(&surface, object);
}

/* "mesh { triangle {...} ... }": what one triangle lacks, all lack. */
void pov_read_mesh(struct pov_reader *reader, struct pov_object *object)
{
    struct pov_surface surface = {.reader = reader, .has_normals = true};
    struct pov_token token;
    double uv[3][2];
    while (token = pov_next(reader),
           pov_is_word(&token, POV_triangle) || pov_is_word(&token, POV_smooth_triangle)) {
        struct pov_corner corners[3];
        bool smooth = token.word == POV_smooth_triangle;
        surface.has_normals = surface.has_normals && smooth;
        pov_expect(reader, '{');
        read_corners(reader, smooth, corners);
        for (struct pov_token part = pov_next(reader); !pov_is(&part, '}') && part.kind != POV_END;
             part = pov_next(reader))
            if (pov_is_word(&part, POV_uv_vectors)) {
                read_uv(reader, uv);
                surface.has_uv = true;
                for (int k = 0; k < 3; k++)
                    memcpy(corners[k].uv, uv[k], sizeof uv[k]);
            } else if (pov_is_word(&part, POV_texture)) {
                pov_warn(reader, &part, "mesh: textures of single triangles are left out");
                pov_skip_braces(reader);
            } else {
                pov_unexpected(reader, &part, "uv_vectors, texture or '}'");
            }
        pov_surface_triangle(&surface, corners);
    }
    pov_unread(reader, token);
    if (pov_accept_word(reader, POV_inside_vector))
        pov_read_vector(reader);
    pov_surface_finish(&surface, object);
}

/* --- mesh2
 * ------------------------------------------------------------------------------------------ */

struct lists {
    struct vector *points, *normals, *uv; /* in lists of their own */
    size_t point_count, normal_count, uv_count;
    struct vector *faces, *normal_faces, *uv_faces; /* three indices each */
    size_t face_count, normal_face_count, uv_face_count;
};

/* "{ n, <...>, ... }"; behind a face may stand up to three numbers of textures. NULL where there
 * are none. */
static struct vector *read_vectors(struct pov_reader *reader, bool are_faces, size_t *count)
{
    struct vector *list = NULL;
    size_t capacity = 0;
    struct pov_token token;
    *count = 0;
    pov_expect(reader, '{');
    pov_read_float(reader);
    while (token = pov_next(reader), !pov_is(&token, '}') && token.kind != POV_END) {
        if (pov_is(&token, ','))
            continue;
        pov_unread(reader, token);
        struct pov_number n = pov_read_number(reader);
        if (n.terms == 1 && are_faces)
            continue;
        if (*count == MESH_TRIANGLES_LIMIT || !pov_charge(reader, 1, sizeof *list) ||
            !pov_grow(reader, (void **)&list, &capacity, *count + 1, sizeof *list)) {
            pov_error(reader, &token, "mesh2: too many entries");
            break;
        }
        list[(*count)++] = pov_number_vector(&n);
    }
    return list;
}

static bool take(const struct vector *list, size_t count, double index, struct vector *value)
{
    if (!(index >= 0.0 && index < (double)count))
        return false;
    *value = list[(size_t)index];
    return true;
}

static double axis(struct vector a, int k)
{
    return k == 0 ? a.x : k == 1 ? a.y : a.z;
}

static void add_faces(struct pov_reader *reader, struct pov_object *object,
                      const struct lists *lists)
{
    struct pov_surface surface = {
        .reader = reader, .has_normals = lists->normal_count > 0, .has_uv = lists->uv_count > 0};
    const struct vector *normal_faces = lists->normal_faces ? lists->normal_faces : lists->faces;
    const struct vector *uv_faces = lists->uv_faces ? lists->uv_faces : lists->faces;
    size_t normal_faces_count = lists->normal_faces ? lists->normal_face_count : lists->face_count,
           uv_faces_count = lists->uv_faces ? lists->uv_face_count : lists->face_count;
    bool good = (!surface.has_normals || normal_faces_count >= lists->face_count) &&
                (!surface.has_uv || uv_faces_count >= lists->face_count);
    for (size_t i = 0; i < lists->face_count && good && !reader->stopped; i++) {
        struct pov_corner corners[3] = {{{0, 0, 0}, {0, 0, 0}, {0, 0}}};
        for (int k = 0; k < 3 && good; k++) {
            struct vector uv = {0, 0, 0};
            good = take(lists->points, lists->point_count, axis(lists->faces[i], k),
                        &corners[k].point);
            if (surface.has_normals)
                good = good && take(lists->normals, lists->normal_count, axis(normal_faces[i], k),
                                    &corners[k].normal);
            if (surface.has_uv)
                good = good && take(lists->uv, lists->uv_count, axis(uv_faces[i], k), &uv);
            corners[k].uv[0] = uv.x;
            corners[k].uv[1] = uv.y;
        }
        if (good)
            pov_surface_triangle(&surface, corners);
    }
    if (!good)
        pov_error(reader, &object->token, "mesh2: an index lies outside of its list");
    pov_surface_finish(&surface, object);
}

static void skip_textures(struct pov_reader *reader, const struct pov_token *token)
{
    pov_warn(reader, token, "mesh2: texture_list is left out");
    pov_skip_braces(reader);
}

void pov_read_mesh2(struct pov_reader *reader, struct pov_object *object)
{
    struct lists lists = {0};
    const struct {
        uint32_t word;
        struct vector **list;
        size_t *count;
    } sections[] = {
        {POV_vertex_vectors, &lists.points, &lists.point_count},
        {POV_normal_vectors, &lists.normals, &lists.normal_count},
        {POV_uv_vectors, &lists.uv, &lists.uv_count},
        {POV_face_indices, &lists.faces, &lists.face_count},
        {POV_normal_indices, &lists.normal_faces, &lists.normal_face_count},
        {POV_uv_indices, &lists.uv_faces, &lists.uv_face_count},
    };
    bool found = true;
    while (found && !reader->stopped) {
        struct pov_token token = pov_next(reader);
        found = false;
        for (size_t i = 0; i < sizeof sections / sizeof sections[0] && !found; i++)
            if (token.kind == POV_WORD && token.word == sections[i].word) {
                free(*sections[i].list);
                *sections[i].list =
                    read_vectors(reader, token.word == POV_face_indices, sections[i].count);
                found = true;
            }
        if (!found && pov_is_word(&token, POV_texture_list)) {
            skip_textures(reader, &token);
            found = true;
        } else if (!found && pov_is_word(&token, POV_inside_vector)) {
            pov_read_vector(reader);
            found = true;
        } else if (!found) {
            pov_unread(reader, token);
        }
    }
    if (!reader->stopped)
        add_faces(reader, object, &lists);
    for (size_t i = 0; i < sizeof sections / sizeof sections[0]; i++)
        free(*sections[i].list);
}
