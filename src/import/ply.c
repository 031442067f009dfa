#include "import/ply.h"

#include "base/parallel.h"
#include "import/obj.h"
#include "import/ply_data.h"
#include "import/ply_text.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- outline
 * --------------------------------------------------------------------------------------- */

static void copy_comments(const struct mesh_file *file, size_t length, FILE *stream)
{
    const char *at = file->bytes, *end = at + length;
    struct text_line line, rest;
    while (text_next_line(&at, end, &line))
        if (text_line_starts(&line, "comment", &rest))
            fprintf(stream, "%.*s\n", (int)(line.end - line.start), line.start);
}

/* With texture coordinates where the file has some: they tell what a texture is laid by. */
static void write_outline(const struct ply *ply, const struct mesh_file *file,
                          const struct ply_header *header, FILE *stream)
{
    static const char *const corners[] = {"0 0 0", "1 0 0", "0 1 0"};
    fputs("ply\nformat ascii 1.0\n", stream);
    copy_comments(file, header->data, stream);
    fputs("element vertex 3\nproperty float x\nproperty float y\nproperty float z\n", stream);
    if (ply->uv)
        fputs("property float u\nproperty float v\n", stream);
    fputs("element face 1\nproperty list uchar int vertex_indices\nend_header\n", stream);
    for (int i = 0; i < 3; i++)
        fprintf(stream, "%s%s\n", corners[i], ply->uv ? " 0 0" : "");
    fputs("3 0 1 2\n", stream);
}

static ps_result make_outline(struct ply *ply, const struct mesh_file *file,
                              const struct ply_header *header, struct error *error)
{
    FILE *stream = open_memstream(&ply->outline.bytes, &ply->outline.length);
    ply->outline.path = file->path;
    if (!stream)
        return error_memory(error, header->data, "a mesh file");
    write_outline(ply, file, header, stream);
    bool good = ferror(stream) == 0;
    good &= fclose(stream) == 0;
    return good ? PS_OK : error_memory(error, header->data, "a mesh file");
}

/* --- the file
 * -------------------------------------------------------------------------------------- */

static bool cut(const struct ply *ply, struct obj_polygon *polygons, size_t count)
{
    const struct obj_text text = {
        .places = ply->vertices,
        .place_count = ply->vertex_count,
        .triangles = ply->triangles,
        .triangle_count = ply->triangle_count,
        .polygons = polygons,
        .polygon_count = count,
    };
    return obj_cut_polygons(&text);
}

static ps_result read_data(struct ply *ply, const struct mesh_file *file,
                           const struct ply_header *header, struct error *error)
{
    struct workers *workers;
    struct obj_polygon *polygons = NULL;
    size_t polygon_count = 0;
    ps_result result = mesh_file_workers(file, &workers, error);
    if (result != PS_OK)
        return result;
    struct mesh_file packed = {.bytes = NULL};
    const struct mesh_file *data = file;
    struct ply_header of_data = *header;
    if (header->is_text) {
        result = ply_text_pack(file, header, workers, &packed, error);
        data = &packed;
        of_data.data = 0;
    }
    if (result == PS_OK)
        result = ply_data_read(data, &of_data, workers, ply, &polygons, &polygon_count, error);
    free(packed.bytes);
    workers_destroy(workers);
    if (result == PS_OK && !cut(ply, polygons, polygon_count))
        result = error_memory(error, file->length, "a mesh file");
    free(polygons);
    return result;
}

ps_result ply_open(struct ply *ply, const struct mesh_file *file, struct error *error)
{
    struct ply_header header;
    *ply = (struct ply){.is_read = false};
    if (!ply_header_ends(file))
        return error_set(error, PS_ERROR_INVALID, "%s: the header has no end_header", file->path);
    if (!ply_header_read(file, &header))
        return PS_OK;
    ps_result result = read_data(ply, file, &header, error);
    if (result == PS_OK)
        result = make_outline(ply, file, &header, error);
    ply->is_read = result == PS_OK;
    return result;
}

void ply_release(struct ply *ply)
{
    free(ply->vertices);
    free(ply->normals);
    free(ply->uv);
    free(ply->colors);
    free(ply->triangles);
    free(ply->outline.bytes);
    *ply = (struct ply){.is_read = false};
}
