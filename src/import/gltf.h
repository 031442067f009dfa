/* gltf.h: a glTF 2 file's JSON, for what assimp does not give.
 *
 * Cameras and lights are read from it since assimp gives a light or camera that several nodes share to
 * one of them only, and a field of view that is wrong for wide pictures; emission strength since assimp
 * does not know it. What psplat does not use (skins, animations, morph targets, further sets of colours
 * and texture coordinates) or reads itself is hidden from assimp by changing the first letter of its key in
 * the text.
 */
#ifndef IMPORT_GLTF_H
#define IMPORT_GLTF_H

#include "import/files.h"
#include "base/json_reader.h"

#define GLTF_DEPTH 256

struct gltf {
    struct arena arena;
    char *text; /* the JSON's first byte */
    struct json *root;
    const struct json **nodes; /* of the scene, each before its children, as assimp keeps them */
    size_t node_count;
    const struct json **materials; /* in the order in which assimp meets them */
    size_t material_count;
    const struct json **primitives; /* of meshes, in the order in which assimp meets them */
    size_t primitive_count;
    bool single_root;      /* else assimp puts a node above all */
    size_t triangle_count; /* of all meshes, each once */
    bool integer_uv;       /* some texture coordinates were integers, and are hidden */
};

/* Reads the file's JSON and changes its text. PS_ERROR_INVALID or _MEMORY with a message; released in any
 * case. */
ps_result gltf_open(struct gltf *gltf, struct mesh_file *file, bool binary, struct error *error);
void gltf_release(struct gltf *gltf);

/* The primitive of which assimp made its mesh of that index, of `mesh_count`; NULL where they are not as many. */
const struct json *gltf_primitive(const struct gltf *gltf, size_t index, size_t mesh_count);

/* Whether the colours of a primitive have an alpha. */
bool gltf_has_alpha(const struct gltf *gltf, const struct json *primitive);

#endif
