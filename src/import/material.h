/* material.h: what the kinds of mesh materials share. */
#ifndef IMPORT_MATERIAL_H
#define IMPORT_MATERIAL_H

#include "import/job.h"
#include <assimp/material.h>

/* A material's parts may be up to two others. */
#define MESH_MATERIAL_PARTS 3

double mesh_material_number(const struct aiMaterial *source, const char *key, double fallback);

/* Never negative, NaN or infinite. */
ps_rgb mesh_material_color(const struct aiMaterial *source, const char *key, ps_rgb fallback);

/* What is common to all kinds; diffuse and white. */
struct material_description mesh_material_white(struct origin origin);

/* Adds it to the fragment, with a copy of the name and, if there is a part, ":PART". */
ps_result mesh_material_add(struct mesh_job *job, const struct material_description *material,
                            const char *name, const char *part, size_t *index);

/* Adds the two, and a mix of them that has the surface (emission, opacity, bump, normal map) of the
 * first. Where `varying` is not NULL it is the share of the first, and the weights do not count. */
struct mesh_share {
    const struct material_description *material;
    double weight;
    const char *part;
};
ps_result mesh_material_add_mix(struct mesh_job *job, const struct mesh_share shares[2],
                                const struct pigment_description *varying, const char *name,
                                size_t *index);

/* Counts a material that has something psplat has not: each such thing is noted once (steps.h).
 * `what` is a literal. */
void mesh_material_omit(struct mesh_job *job, const char *what, const char *name);

/* At most 1; the rest counts as left out. */
ps_rgb mesh_reflectance(struct mesh_job *job, ps_rgb color, const char *name);

/* material_mtl.c, material_gltf.c: adds the material and its parts. `extras` is its JSON,
 * or NULL. */
ps_result mesh_material_read_mtl(struct mesh_job *job, const struct aiMaterial *source,
                                 const char *name, size_t *index);
ps_result mesh_material_read_gltf(struct mesh_job *job, const struct aiMaterial *source,
                                  const struct json *extras, const char *name, size_t *index);

/* --- material_mesh.c: what the meshes of a material bring ------------------------------ */

/* The material takes the colours of its meshes' vertices; for NO_INDEX one that is white without
 * them is made. */
ps_result mesh_material_paint(struct mesh_job *job, size_t *index);

/* Whether some texture of the material is laid by the second set of coordinates. */
bool mesh_material_has_second_uv(const struct mesh_job *job, size_t index);

/* --- texture.c -------------------------------------------------------------------------- */

struct pigment_description mesh_pigment(ps_rgb color);

static inline ps_rgb mesh_grey(double value)
{
    return (ps_rgb){(float)value, (float)value, (float)value};
}

/* Makes `pigment` an image of the material's texture of that type, times the colour it has, and
 * leaves it as it is where there is no such texture, or its file is missing (which is counted). */
struct mesh_texture_use {
    enum aiTextureType type;
    enum texture_channel channel;
    enum texture_encoding encoding;
    const struct json *info; /* glTF's textureInfo, or NULL */
};
ps_result mesh_pigment_texture(struct mesh_job *job, const struct aiMaterial *source,
                               struct mesh_texture_use use, struct pigment_description *pigment);

/* Whether the material names one, there or not. */
bool mesh_texture_is_named(const struct aiMaterial *source, enum aiTextureType type);

/* --- texture_map.c ---------------------------------------------------------------------- */

/* Where on the surface the image lies: set of coordinates, and transform. */
void mesh_map_texture(struct mesh_job *job, const struct aiMaterial *source,
                      struct mesh_texture_use use, struct pigment_description *pigment);

#endif
