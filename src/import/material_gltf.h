/* material_gltf.h: what glTF's two ways to state a surface share. */
#ifndef IMPORT_MATERIAL_GLTF_H
#define IMPORT_MATERIAL_GLTF_H

#include "import/material.h"
#include <float.h>

/* Three numbers, none below 0; `fallback` where there are no such. */
ps_rgb mesh_json_color(const struct json *object, const char *name, ps_rgb fallback);

/* Of a material, or NULL. */
const struct json *mesh_gltf_extension(const struct json *extras, const char *name);

/* Fills the opacity by alphaMode: `alpha` times that of the base colour's texture, whose use is
 * given. */
ps_result mesh_gltf_opacity(struct mesh_job *job, const struct aiMaterial *source,
                            struct mesh_texture_use use, const struct json *extras, double alpha,
                            struct material_description *material);

/* material_glossiness.c: adds the material by KHR_materials_pbrSpecularGlossiness; `surface` has
 * what is common. */
ps_result mesh_material_read_glossiness(struct mesh_job *job, const struct aiMaterial *source,
                                        const struct json *extras,
                                        const struct material_description *surface,
                                        const char *name, size_t *index);

#endif
