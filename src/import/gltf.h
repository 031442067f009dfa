/* gltf.h: a glTF 2 file's JSON, for what assimp does not give.
 *
 * Cameras and lights are read from it since assimp gives a light or camera that several nodes share
 * to one of them only, and a field of view that is wrong for wide pictures; emission strength since
 * assimp does not know it. What psplat does not use (skins, animations, morph targets, further sets
 * of colours and texture coordinates) or reads itself is hidden from assimp, which is given a JSON
 * that is written anew from the tree; what assimp cannot read of buffers and textures is changed
 * there (gltf_unpack.c). The tree stays the file's.
 */
#ifndef IMPORT_GLTF_H
#define IMPORT_GLTF_H

#include "base/json_reader.h"
#include "import/files.h"

#define GLTF_DEPTH 256

/* What the nodes of a file place, primitive by primitive, with all instances; as many as a scene
 * has. */
#define MESH_OBJECTS 1000000

struct gltf_bytes {
    const unsigned char *bytes;
    size_t length;
};

struct gltf {
    struct arena arena;
    struct mesh_file *file;
    struct mesh_files *files;
    bool binary;
    struct json *root;          /* refers to a copy of the file's text in the arena */
    struct gltf_bytes *buffers; /* those that were read */
    struct gltf_bytes *views;   /* those that were packed, once they are unpacked */
    size_t buffer_count, view_count, accessor_count;
    size_t unpacked;           /* bytes of views and accessors so far */
    size_t placed;             /* objects so far, and those of instances */
    const struct json **nodes; /* of the scene, each before its children, as assimp keeps them */
    size_t node_count;
    const struct json **materials; /* in the order in which assimp meets them */
    size_t material_count;
    const struct json **primitives; /* of meshes, in the order in which assimp meets them */
    size_t primitive_count;
    bool single_root;      /* else assimp puts a node above all */
    size_t triangle_count; /* of all meshes, each once */
    bool draco;            /* some are compressed by it */
    /* Of some, normals or texture coordinates are, which are hidden from assimp. */
    bool draco_integers;
};

/* Reads the file's JSON, and changes the file into what assimp is to read. PS_ERROR_INVALID, _IO or
 * _MEMORY with a message; released in any case, before `files`. */
ps_result gltf_open(struct gltf *gltf, struct mesh_file *file, struct mesh_files *files,
                    bool binary, struct error *error);
void gltf_release(struct gltf *gltf);

/* The primitive of which assimp made its mesh of that index, of `mesh_count`; NULL where they are
 * not as many. */
const struct json *gltf_primitive(const struct gltf *gltf, size_t index, size_t mesh_count);

/* Whether a primitive is compressed by KHR_draco_mesh_compression, which assimp unpacks. */
bool gltf_is_draco(const struct json *primitive);

/* The buffer inside of a binary file; false where there is none. */
bool gltf_binary_chunk(const struct gltf *gltf, struct gltf_bytes *bytes);

/* gltf_unpack.c: changes the tree for assimp, and adds a file with the numbers that it then
 * names. */
ps_result gltf_unpack(struct gltf *gltf, struct error *error);

/* Whether the colours of a primitive have an alpha. */
bool gltf_has_alpha(const struct gltf *gltf, const struct json *primitive);

#endif
