/* bsdf_lobes.h: what a surface point scatters by, for the files that work with a material's BSDF
 * (bsdf_lobes.c, bsdf.c).
 *
 * A material is a sum of components (material.h). Light goes on by the diffuse lobe of all of them
 * together, or by the other lobe of one. Colours and numbers are looked up where the hit is, over
 * what its ray cone covers.
 */
#ifndef SCENE_BSDF_LOBES_H
#define SCENE_BSDF_LOBES_H

#include "scene/material.h"
#include "scene/ray_cone.h"

/* Grazing directions, where cosines divide. */
#define BSDF_LEAST_COSINE 1e-4f

#define BSDF_MOST_LOBES (1 + MATERIAL_MOST_COMPONENTS)

/* A surface point seen from a direction: what is needed of it more than once. */
struct bsdf_view {
    const struct material *material;
    const struct microfacet_table *table;
    const ps_hit *hit;
    ps_vec3 out;    /* unit, back along the ray */
    float cosine;   /* of `out` to the shading normal, > 0 */
    ps_rgb diffuse; /* bsdf_diffuse_albedo() towards that */
};

/* Of a hit whose albedo is still that of the surface. */
static inline struct bsdf_view bsdf_view_of(const struct material *material,
                                            const struct microfacet_table *table, const ps_hit *hit,
                                            ps_vec3 ray_direction)
{
    ps_vec3 out = ps_scale(ray_direction, -1.0f);
    float cosine = fmaxf(ps_dot(out, hit->normal), BSDF_LEAST_COSINE);
    return (struct bsdf_view){material, table, hit, out, cosine, hit->albedo};
}

static inline ps_rgb bsdf_color(const struct pigment *pigment, const ps_hit *hit)
{
    return pigment_filter(pigment, hit->texture_point, hit->uv, ray_cone_log_width(hit));
}

static inline float bsdf_number(const struct pigment *pigment, const ps_hit *hit)
{
    return pigment_mean(bsdf_color(pigment, hit));
}

static inline float bsdf_roughness(const struct component *component, const ps_hit *hit)
{
    return bsdf_number(&component->roughness, hit);
}

/* The component's part of the material. */
static inline float bsdf_share(const struct component *component, const struct bsdf_view *view)
{
    if (component->sharing == SHARE_CONSTANT)
        return component->share;
    float first = bsdf_number(&view->material->mixing, view->hit);
    return component->share * (component->sharing == SHARE_FIRST ? first : 1.0f - first);
}

static inline bool bsdf_is_smooth(float roughness)
{
    return roughness < MICROFACET_SMOOTHEST;
}

/* The share of the light from all around that the component's reflector sends to `cosine`. */
ps_rgb bsdf_reflector_albedo(const struct component *component, const struct bsdf_view *view,
                             float cosine);

/* The diffuse albedo of all components towards `cosine`. It looks up colours and patterns: where
 * view->diffuse is the same, it costs nothing. */
ps_rgb bsdf_diffuse_albedo(const struct bsdf_view *view, float cosine);

/* A way in which light may go on: the other lobe of a component, or the diffuse one of all, which
 * is a single one so that what ends there may count the whole albedo. */
struct bsdf_lobe {
    const struct component *component; /* NULL: diffuse */
    float probability;
};

/* The surface's lobes with their probabilities, by albedo; returns how many. */
size_t bsdf_list_lobes(const struct bsdf_view *view, struct bsdf_lobe lobes[BSDF_MOST_LOBES]);

#endif
