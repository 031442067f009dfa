/* microfacet.h: reflection by rough surfaces: the GGX distribution of facets.
 *
 * Walter et al. 2007 with Smith's height-correlated shadowing (Heitz 2014); directions are drawn
 * from the facets that the eye sees (Heitz 2018). Light that bounces between facets is lost to that
 * model, at roughness 1 nearly half of it; Turquin's factor (2019) gives it back, so that a white
 * metal reflects all light at any roughness:
 *
 *     f = f_single * (1 + F0 * (1 - E(o)) / E(o)),
 *
 * with E(o) the single-bounce albedo of perfectly reflecting facets towards o. The factor depends
 * on the direction to the eye alone, which makes f not quite symmetric: light paths must use the
 * direction that they leave in, as psplat's do.
 *
 * Directions are unit vectors in a frame whose z is the normal, on its side. Roughness is 0..1; the
 * distribution's alpha is its square.
 */
#ifndef SCENE_MICROFACET_H
#define SCENE_MICROFACET_H

#include <psplat/math.h>
#include <stdbool.h>

/* Smoother surfaces count as mirrors. */
#define MICROFACET_SMOOTHEST 0.02f

#define MICROFACET_TABLE_SIZE 32

/* Albedo of the single-bounce model over cosine and roughness, where reflectance at normal
 * incidence is F0: F0 * scale + bias (Karis 2013). */
struct microfacet_table {
    bool is_known[MICROFACET_TABLE_SIZE];                      /* whether that row is filled */
    float scale[MICROFACET_TABLE_SIZE][MICROFACET_TABLE_SIZE]; /* [roughness][cosine] */
    float bias[MICROFACET_TABLE_SIZE][MICROFACET_TABLE_SIZE];
};

/* Fills the rows that roughnesses from `least` to `most` are looked up in, but for those that are
 * known, by quadrature: two milliseconds each. Other roughnesses may not be looked up. The table
 * begins with all 0. */
void microfacet_tabulate(struct microfacet_table *table, float least, float most);

/* The share of light from all around that is reflected to the cosine `out`. */
ps_rgb microfacet_albedo(const struct microfacet_table *table, ps_rgb f0, float roughness,
                         float out);

/* Turquin's factor for the cosine to the eye. */
ps_rgb microfacet_compensation(const struct microfacet_table *table, ps_rgb f0, float roughness,
                               float eye);

/* A direction of incidence for the outgoing direction `out`, by the density below. */
ps_vec3 microfacet_sample(float roughness, ps_vec3 out, float u1, float u2);

/* Density of microfacet_sample by solid angle. */
float microfacet_pdf(float roughness, ps_vec3 out, ps_vec3 in);

/* f_single * cosine of `in`. */
ps_rgb microfacet_reflect(float roughness, ps_rgb f0, ps_vec3 out, ps_vec3 in);

/* microfacet_reflect / microfacet_pdf, without dividing small numbers. */
ps_rgb microfacet_weight(float roughness, ps_rgb f0, ps_vec3 out, ps_vec3 in);

#endif
