/* direct.h: direct light: what the light sources give to points, with shadow rays. */
#ifndef PIPELINE_DIRECT_H
#define PIPELINE_DIRECT_H

#include "film/gbuffer.h"
#include "trace/trace.h"

/* Irradiance (W/m^2) of n points with normals from all lights. `coherence`: whether the
 * points are neighbours. Any thread. */
void direct_irradiance(const struct scene *scene, const struct trace *trace,
                       enum coherence coherence, const ps_vec3 *positions, const ps_vec3 *normals,
                       size_t n, ps_rgb *irradiance);

/* Fills the direct irradiance of tile `tile`. */
void direct_light_tile(const struct scene *scene, const struct trace *trace,
                       struct gbuffer *gbuffer, uint32_t tile);

#endif
