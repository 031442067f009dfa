/* shadow_maps.h: which surfaces a light reaches, by depth maps instead of shadow rays.
 *
 * Williams 1978, "Casting curved shadows on curved surfaces", with percentage-closer filtering
 * (Reeves, Salesin and Cook 1987, "Rendering antialiased shadows with depth maps"). Points and
 * spotlights have maps in perspective, suns without an angle one in parallel that holds the scene.
 * A light that has a size is not seen from one place: a map would give it hard shadows, so it has
 * none.
 */
#ifndef DIRECT_SHADOW_MAPS_H
#define DIRECT_SHADOW_MAPS_H

#include "base/parallel.h"
#include "trace/trace.h"

struct shadow_maps;

/* Traces maps of `side` pixels along each side, for all lights of the scene that can have them, on
 * that many threads; they do not depend on these. The scene must outlive them. PS_ERROR_MEMORY,
 * with a message; else to be destroyed. */
ps_result shadow_maps_create(const struct scene *scene, const struct trace *trace, uint32_t side,
                             struct workers *workers, struct shadow_maps **maps,
                             struct error *error);
void shadow_maps_destroy(struct shadow_maps *maps); /* or NULL */

size_t shadow_maps_bytes(const struct shadow_maps *maps);

/* Whether maps tell what this light of the scene reaches. */
bool shadow_maps_hold(const struct shadow_maps *maps, size_t light);

/* The share, 0..1, of such a light that reaches a point whose unit normal faces it. Any thread. */
float shadow_maps_lit(const struct shadow_maps *maps, size_t light, ps_vec3 point, ps_vec3 normal);

#endif
