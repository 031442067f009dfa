/* material_kinds.h: what the kinds of materials have in common, and those that reflect or refract
 * like a mirror.
 *
 * A kind writes psd(5)'s key of it with the value.
 */
#ifndef PBRT_MATERIAL_KINDS_H
#define PBRT_MATERIAL_KINDS_H

#include "pbrt/material.h"
#include "pbrt/texture.h"

/* "KEY: PATTERN" */
void material_put_key(FILE *out, const char *key, const struct pattern *pattern, bool is_number);
/* Warns that what the scene has is replaced by the nearest. */
void material_nearest(struct importer *importer, const struct statement *statement,
                      const char *what);
/* A parameter within 0..1. */
struct pattern material_read_reflectance(struct importer *importer,
                                         const struct statement *statement, const char *name,
                                         const double otherwise[3]);
/* An index of refraction, "eta" or "index", which may be a spectrum; within 0.1..10. */
double material_index(struct importer *importer, const struct statement *statement,
                      double otherwise);
/* Of a border between 1 and the index, for light from straight ahead: ((index - 1) / (index +
 * 1))^2. */
double material_normal_reflectance(double index);

/* `prefix` stands before its parameters' names. */
void material_conductor(struct importer *importer, FILE *out, const struct statement *statement,
                        const char *prefix);
void material_coated_conductor(struct importer *importer, FILE *out,
                               const struct statement *statement);
void material_dielectric(struct importer *importer, FILE *out, const struct statement *statement);
void material_thin_dielectric(struct importer *importer, FILE *out,
                              const struct statement *statement);
void material_mirror(struct importer *importer, FILE *out, const struct statement *statement);

#endif
