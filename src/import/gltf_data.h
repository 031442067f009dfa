/* gltf_data.h: the numbers of a glTF file: buffers, views of them, accessors.
 *
 * assimp reads most of them. Read here is what it takes for something else: integers that stand for
 * fractions (KHR_mesh_quantization), views that are compressed (EXT_meshopt_compression), and what
 * instances are placed by.
 */
#ifndef IMPORT_GLTF_DATA_H
#define IMPORT_GLTF_DATA_H

#include "import/gltf.h"
#include <stdint.h>

enum gltf_component {
    GLTF_BYTE = 5120,
    GLTF_UNSIGNED_BYTE,
    GLTF_SHORT,
    GLTF_UNSIGNED_SHORT,
    GLTF_UNSIGNED_INT = 5125,
    GLTF_FLOAT
};

/* All elements are within the bytes, which are the file's own, or unpacked into its arena. Where
 * the file names no view, all are one of zeros, of any count. */
struct gltf_accessor {
    const unsigned char *bytes;
    size_t count, stride; /* 0: all elements are the same */
    unsigned components;  /* 1 to 4 */
    enum gltf_component type;
    bool normalized;
};

/* PS_ERROR_INVALID where it is not within its view, has no elements or matrices for elements, or is
 * sparse. */
ps_result gltf_accessor_open(struct gltf *gltf, size_t index, struct gltf_accessor *accessor,
                             struct error *error);

/* As a float; integers that are normalized lie in -1..1. */
float gltf_accessor_value(const struct gltf_accessor *accessor, size_t element, unsigned component);

/* PS_ERROR_INVALID, with what is wrong. */
ps_result gltf_refuse(struct error *error, const char *what);

/* A number of at most four bytes. */
uint32_t gltf_little_endian(const void *source, size_t size);

/* Room in the arena for what is unpacked, of which there is at most GLTF_EXPANSION times what the
 * files hold. PS_ERROR_INVALID or _MEMORY. */
#define GLTF_EXPANSION 64
ps_result gltf_take_room(struct gltf *gltf, size_t bytes, void **room, struct error *error);

/* Unpacks the view if it is compressed; no-op if not. */
ps_result gltf_unpack_view(struct gltf *gltf, size_t index, struct error *error);

/* --- gltf_container.c
 * ------------------------------------------------------------------------------ */

/* Where the JSON lies in a binary file. PS_ERROR_INVALID where it is none, or cut short. */
ps_result gltf_find_json(const struct mesh_file *file, struct json_text *text, struct error *error);

/* Writes the tree into the file, in the place of the text `old`. */
ps_result gltf_rewrite(struct gltf *gltf, const struct json_text *old, struct error *error);

/* --- meshopt.c
 * ----------------------------------------------------------------------------------- */

/* Whether this build can. */
bool meshopt_is_built(void);

/* Unpacks `source` as the extension's members say into `count` elements of `stride` bytes, which
 * may be 0 or too many. PS_ERROR_INVALID or _MEMORY. */
ps_result meshopt_unpack(struct gltf *gltf, const struct json *extension,
                         const struct gltf_bytes *source, struct gltf_bytes *unpacked,
                         struct error *error);

#endif
