/* ply.c: a mesh as a PLY file; see mesh.h. */
#include "writer/mesh.h"

#include <stdlib.h>
#include <string.h>

/* Little-endian, whatever the machine. */
static unsigned char *put_word(unsigned char *at, uint32_t word)
{
    for (int i = 0; i < 4; i++)
        *at++ = (unsigned char)(word >> (8 * i));
    return at;
}

static unsigned char *put_float(unsigned char *at, double value)
{
    float number = (float)value;
    uint32_t word;
    memcpy(&word, &number, sizeof word);
    return put_word(at, word);
}

static unsigned char *put_floats(unsigned char *at, struct vector value)
{
    return put_float(put_float(put_float(at, value.x), value.y), value.z);
}

void *mesh_to_ply(const struct mesh *mesh, size_t *size)
{
    static const char normals[] = "property float nx\nproperty float ny\nproperty float nz\n";
    static const char uv[] = "property float u\nproperty float v\n";
    char header[512];
    int length = snprintf(
        header, sizeof header,
        "ply\nformat binary_little_endian 1.0\nelement vertex %zu\nproperty float x\n"
        "property float y\nproperty float z\n%s%selement face %zu\n"
        "property list uchar int vertex_indices\nend_header\n",
        mesh->vertex_count, mesh->normals ? normals : "", mesh->uv ? uv : "", mesh->triangle_count);
    size_t floats = 3 + (mesh->normals ? 3u : 0u) + (mesh->uv ? 2u : 0u);
    *size = (size_t)length + mesh->vertex_count * floats * 4 + mesh->triangle_count * 13;
    unsigned char *bytes = malloc(*size), *at = bytes;
    if (!bytes)
        return NULL;
    memcpy(at, header, (size_t)length);
    at += length;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        at = put_floats(at, mesh->points[i]);
        if (mesh->normals)
            at = put_floats(at, mesh->normals[i]);
        if (mesh->uv)
            at = put_float(put_float(at, mesh->uv[i][0]), mesh->uv[i][1]);
    }
    /* assimp takes a line end in the first byte for the header's, and is off by it from there on:
     * the last bit of a float goes for that. */
    if (mesh->vertex_count > 0 && (bytes[length] == '\n' || bytes[length] == '\r'))
        bytes[length]++;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        *at++ = 3;
        for (int k = 0; k < 3; k++)
            at = put_word(at, mesh->triangles[i][k]);
    }
    return bytes;
}
