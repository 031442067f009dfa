/* ply_data.c: vertices have a size each, so that they are read in parallel. Faces are lists: one
 * walk finds where every so many of them start, and which triangles they are; then they are read in
 * parallel as well.
 */
#include "import/ply_data.h"

#include "base/parallel.h"
#include <stdlib.h>

#define PIECE ((uint64_t)1 << 16)                 /* vertices, faces */
#define MOST_ELEMENTS ((size_t)200 * 1000 * 1000) /* vertices, triangles */

/* Where faces start, and what comes before them. */
struct piece {
    const char *at;
    size_t triangles, polygons;
    bool is_wrong; /* a vertex is not there */
};

struct reading {
    const struct mesh_file *file;
    const struct ply_header *header;
    struct ply *ply;
    struct obj_polygon *polygons;
    size_t polygon_count;
    struct piece *pieces;
    size_t piece_count;
};

static size_t count_pieces(uint64_t elements)
{
    return (size_t)((elements + PIECE - 1) / PIECE);
}

/* --- vertices
 * -------------------------------------------------------------------------------------- */

/* A property, or nothing where it is not there. */
struct column {
    const struct ply_property *property;
    float scale;
};

struct columns {
    struct column place[3], normal[3], uv[2], color[4];
};

static void find_columns(const struct ply_element *vertices, enum ply_role first, int count,
                         struct column *columns)
{
    for (int i = 0; i < count; i++) {
        const struct ply_property *property = ply_property_of(vertices, (enum ply_role)(first + i));
        bool is_color = first == PLY_RED && property;
        float most = is_color && property->type == PLY_UCHAR    ? 255.0f
                     : is_color && property->type == PLY_USHORT ? 65535.0f
                                                                : 1.0f;
        columns[i] = (struct column){property, most};
    }
}

static float value_of(const struct reading *reading, const char *vertex,
                      const struct column *column)
{
    const struct ply_property *property = column->property;
    if (!property)
        return 1.0f; /* alpha */
    double number =
        ply_number(vertex + property->offset, property->type, reading->header->big_endian);
    return (float)number / column->scale;
}

static ps_vec3 vector_of(const struct reading *reading, const char *vertex,
                         const struct column columns[3])
{
    return (ps_vec3){value_of(reading, vertex, &columns[0]), value_of(reading, vertex, &columns[1]),
                     value_of(reading, vertex, &columns[2])};
}

static void read_vertices(void *user, uint64_t index, uint32_t worker)
{
    const struct reading *reading = user;
    const struct ply_element *vertices = &reading->header->vertices;
    const struct ply *ply = reading->ply;
    const char *data = reading->file->bytes + reading->header->data;
    uint64_t end = (index + 1) * PIECE < vertices->count ? (index + 1) * PIECE : vertices->count;
    struct columns columns;
    (void)worker;
    find_columns(vertices, PLY_X, 3, columns.place);
    find_columns(vertices, PLY_NX, 3, columns.normal);
    find_columns(vertices, PLY_U, 2, columns.uv);
    find_columns(vertices, PLY_RED, 4, columns.color);
    for (uint64_t i = index * PIECE; i < end; i++) {
        const char *vertex = data + i * vertices->size;
        ply->vertices[i] = vector_of(reading, vertex, columns.place);
        if (ply->normals)
            ply->normals[i] = vector_of(reading, vertex, columns.normal);
        for (int k = 0; ply->uv && k < 2; k++)
            ply->uv[i][k] = value_of(reading, vertex, &columns.uv[k]);
        for (int k = 0; ply->colors && k < 4; k++)
            ply->colors[i][k] = value_of(reading, vertex, &columns.color[k]);
    }
}

/* --- faces
 * ----------------------------------------------------------------------------------------- */

/* The list of a face, and how long it is; NULL where the data end before it does. `*at` moves
 * behind the face. */
static const char *next_face(const struct ply_header *header, const char **at, const char *end,
                             const struct ply_property **list, size_t *corners)
{
    const char *found = NULL;
    for (size_t i = 0; i < header->faces.property_count; i++) {
        const struct ply_property *property = &header->faces.properties[i];
        bool is_list = property->count_type != PLY_NO_TYPE;
        size_t size = ply_type_size(is_list ? property->count_type : property->type);
        if ((size_t)(end - *at) < size)
            return NULL;
        if (is_list) {
            double count = ply_number(*at, property->count_type, header->big_endian);
            *corners = count > 0 ? (size_t)count : 0;
            found = *at + size;
            *list = property;
            if ((size_t)(end - found) / ply_type_size(property->type) < *corners)
                return NULL;
            size += *corners * ply_type_size(property->type);
        }
        *at += size;
    }
    return found;
}

/* Finds the pieces. False: the data end too soon. */
static bool walk_faces(struct reading *reading)
{
    const struct ply_header *header = reading->header;
    const char *end = reading->file->bytes + reading->file->length;
    const char *at = reading->file->bytes + header->data +
                     (size_t)header->vertices.count * header->vertices.size;
    for (uint64_t i = 0; i < header->faces.count; i++) {
        const struct ply_property *list;
        size_t corners = 0;
        if (i % PIECE == 0)
            reading->pieces[i / PIECE] =
                (struct piece){at, reading->ply->triangle_count, reading->polygon_count, false};
        if (!next_face(header, &at, end, &list, &corners))
            return false;
        reading->ply->triangle_count += corners < 3 ? 0 : corners - 2;
        reading->polygon_count += corners > 3;
    }
    return true;
}

/* False: a vertex is not there. */
static bool read_index(const struct reading *reading, const char *list,
                       const struct ply_property *property, size_t corner, uint32_t *index)
{
    const struct ply_header *header = reading->header;
    double number = ply_number(list + corner * ply_type_size(property->type), property->type,
                               header->big_endian);
    bool is_there = number >= 0 && number < (double)header->vertices.count;
    *index = is_there ? (uint32_t)number : 0;
    return is_there;
}

/* Also of lines and points all vertices have to be there. */
static bool read_face(const struct reading *reading, const char *list,
                      const struct ply_property *property, size_t corners, size_t triangle)
{
    uint32_t first = 0, before = 0, index;
    bool good = true;
    for (size_t i = 0; i < corners; i++) {
        good &= read_index(reading, list, property, i, &index);
        if (i >= 2) {
            uint32_t *made = reading->ply->triangles[triangle + i - 2];
            made[0] = first;
            made[1] = before;
            made[2] = index;
        }
        first = i == 0 ? index : first;
        before = index;
    }
    return good;
}

static void read_faces(void *user, uint64_t number, uint32_t worker)
{
    struct reading *reading = user;
    struct piece *piece = &reading->pieces[number];
    const char *at = piece->at, *end = reading->file->bytes + reading->file->length;
    size_t triangle = piece->triangles, polygon = piece->polygons;
    uint64_t left = reading->header->faces.count - number * PIECE;
    (void)worker;
    for (uint64_t i = 0; i < PIECE && i < left; i++) {
        const struct ply_property *property = NULL;
        size_t corners = 0;
        const char *list = next_face(reading->header, &at, end, &property, &corners);
        piece->is_wrong |= !read_face(reading, list, property, corners, triangle);
        if (corners > 3)
            reading->polygons[polygon++] =
                (struct obj_polygon){(uint32_t)triangle, (uint32_t)corners};
        triangle += corners < 3 ? 0 : corners - 2;
    }
}

/* --- both
 * ------------------------------------------------------------------------------------------ */

static ps_result out_of_memory(const struct reading *reading, struct error *error)
{
    return error_memory(error, reading->file->length, "a mesh file");
}

static ps_result complain(const struct reading *reading, const char *what, struct error *error)
{
    return error_set(error, PS_ERROR_INVALID, "%s: %s", reading->file->path, what);
}

static bool allocate(struct reading *reading)
{
    const struct ply_element *vertices = &reading->header->vertices;
    struct ply *ply = reading->ply;
    size_t count = ply->vertex_count = (size_t)vertices->count;
    bool normals = ply_property_of(vertices, PLY_NX), uv = ply_property_of(vertices, PLY_U),
         colors = ply_property_of(vertices, PLY_RED);
    ply->vertices = malloc((count + 1) * sizeof *ply->vertices);
    ply->normals = normals ? malloc((count + 1) * sizeof *ply->normals) : NULL;
    ply->uv = uv ? malloc((count + 1) * sizeof *ply->uv) : NULL;
    ply->colors = colors ? malloc((count + 1) * sizeof *ply->colors) : NULL;
    ply->triangles = malloc((ply->triangle_count + 1) * sizeof *ply->triangles);
    reading->polygons = malloc((reading->polygon_count + 1) * sizeof *reading->polygons);
    return ply->vertices && (ply->normals || !normals) && (ply->uv || !uv) &&
           (ply->colors || !colors) && ply->triangles && reading->polygons;
}

static ps_result measure(struct reading *reading, struct error *error)
{
    const struct ply_header *header = reading->header;
    size_t left = reading->file->length - header->data;
    if (header->vertices.count > MOST_ELEMENTS)
        return complain(reading, "more than 200 million vertices or triangles", error);
    if (left / header->vertices.size < header->vertices.count)
        return complain(reading, "the file ends before its last vertex", error);
    if (header->faces.count > left)
        return complain(reading, "the file ends before its last face", error);
    reading->piece_count = count_pieces(header->faces.count);
    reading->pieces = malloc((reading->piece_count + 1) * sizeof *reading->pieces);
    if (!reading->pieces)
        return out_of_memory(reading, error);
    if (!walk_faces(reading))
        return complain(reading, "the file ends before its last face", error);
    if (reading->ply->triangle_count > MOST_ELEMENTS)
        return complain(reading, "more than 200 million vertices or triangles", error);
    return allocate(reading) ? PS_OK : out_of_memory(reading, error);
}

static ps_result read_all(struct reading *reading, struct workers *workers, struct error *error)
{
    parallel_for(workers, count_pieces(reading->header->vertices.count), read_vertices, reading);
    parallel_for(workers, reading->piece_count, read_faces, reading);
    for (size_t i = 0; i < reading->piece_count; i++)
        if (reading->pieces[i].is_wrong)
            return complain(reading, "a face has a vertex that the file lacks", error);
    return PS_OK;
}

ps_result ply_data_read(const struct mesh_file *file, const struct ply_header *header,
                        struct workers *workers, struct ply *ply, struct obj_polygon **polygons,
                        size_t *polygon_count, struct error *error)
{
    struct reading reading = {.file = file, .header = header, .ply = ply};
    ps_result result = measure(&reading, error);
    if (result == PS_OK)
        result = read_all(&reading, workers, error);
    free(reading.pieces);
    *polygons = reading.polygons;
    *polygon_count = reading.polygon_count;
    return result;
}
