/* material.h: how surfaces reflect, transmit and emit.
 *
 * A material is a sum of components, each with a share; a component has up to two lobes:
 *
 *     diffuse     Lambert
 *     reflector   a mirror, or GGX microfacets (metal)
 *     glossy      such a reflector as a coat over Lambert
 *     dielectric  the smooth surface of glass or water: mirrors and refracts
 *
 * What a coat reflects, its base does not get: the base's albedo is what users state times 1 -
 * E(o), with E(o) the coat's albedo towards the eye. (A symmetric model would also darken by the
 * direction of incidence. Then reflected light would no longer be albedo / pi * irradiance, which
 * splatting rests on; this one never gives an eye more light than there is.)
 *
 * A path that meets a surface follows one lobe, chosen by albedo.
 *
 * Opacity: below 1/2 there is no surface. A blended material rather has holes finer than anything,
 * whose share of the area is 1 - opacity: each ray decides whether it meets the surface by a number
 * of its own, a hash of where it hits (stochastic transparency, Enderton et al. 2010, with the hash
 * of Wyman and McGuire 2017, "Hashed alpha testing"). Hence the same ray always finds the same, and
 * means over rays and passes are those of the opacity; but two rays to one point, whose hits differ
 * in the last bits, need not agree. Where light is stored with the surface, as photons are, and
 * looked up by a ray that met it as well, the opacity counts twice (psd(5), MESH FILES, names the
 * estimators).
 */
#ifndef SCENE_MATERIAL_H
#define SCENE_MATERIAL_H

#include "base/error.h"
#include "scene/microfacet.h"
#include "scene/pigment.h"
#include "scene/shape.h"

enum component_kind {
    COMPONENT_DIFFUSE,
    COMPONENT_REFLECTOR,
    COMPONENT_GLOSSY,
    COMPONENT_DIELECTRIC
};

/* What hits' texture_point holds: the point in the shape's space, or what the mesh has for each
 * vertex. */
enum material_lookup { LOOKUP_POINT, LOOKUP_COLORS, LOOKUP_SECOND_UV };

/* What is looked up as its mean over ray cones (ray_cone.h), whose widths are kept in the
 * coordinates of that. Nothing of a material with holes, whose colour must not mix in. */
enum material_filter { FILTER_NOTHING, FILTER_IMAGES, FILTER_PATTERNS };

enum component_sharing {
    SHARE_CONSTANT,
    SHARE_FIRST, /* times the material's mixing */
    SHARE_SECOND /* times 1 - mixing */
};

struct component {
    enum component_kind kind;
    float share;
    enum component_sharing sharing;
    struct pigment diffuse; /* diffuse, glossy: reflectance */
    /* Reflector, glossy: reflectance at normal incidence; dielectric: tint of what passes. */
    struct pigment specular;
    struct pigment roughness; /* reflector, glossy */
    bool constant;            /* reflector: as much at every angle */
    float ior;                /* dielectric */
    ps_rgb absorption;        /* dielectric: per scene unit */
};

#define MATERIAL_MOST_COMPONENTS 8

struct material {
    struct component components[MATERIAL_MOST_COMPONENTS];
    uint32_t component_count;
    bool specular; /* has other components than COMPONENT_DIFFUSE */
    bool emissive;
    bool emission_both; /* else from the front only */
    bool has_opacity;
    bool blended;
    bool has_bump;
    bool has_normal_map;
    enum material_lookup lookup;
    enum material_filter filter;
    struct pigment emission; /* radiance */
    struct pigment opacity;
    struct pigment bump;       /* height, scene units */
    struct pigment normal_map; /* its red is a factor on tilts */
    struct pigment mixing;
};

/* Builds material `index`; mixes are resolved. Textures are borrowed. PS_ERROR_INVALID where a mix
 * has too many components. */
ps_result material_create(const struct scene_description *description, size_t index,
                          const struct texture *textures, struct material *material,
                          struct error *error);

/* Fills what its rough reflectors look up. */
void material_tabulate(const struct material *material, struct microfacet_table *table);

/* The black surface of a light. */
void material_create_lamp(ps_rgb radiance, bool both_sides, struct material *material);

/* The texture_point of a point of a mesh; `patterns` is the point in the shape's space. */
ps_vec3 material_texture_point(const struct material *material, const struct shape *shape,
                               const struct shape_point *point, ps_vec3 patterns);

/* Where opacity is looked up: of materials that look up colours, the point is three times their
 * alpha. */
struct opacity_place {
    ps_vec3 texture_point;
    float uv[2];
};
struct opacity_place material_opacity_place(const struct material *material,
                                            const struct shape *shape,
                                            const struct shape_point *point, ps_vec3 patterns);

/* How much of the surface there is: 0 or 1, or any share where the material is blended. */
float material_coverage(const struct material *material, const struct opacity_place *place);

/* Diffuse reflectance of the surface towards the ray's origin. */
ps_rgb material_albedo(const struct material *material, const struct microfacet_table *table,
                       const ps_hit *hit, ps_vec3 ray_direction);

/* Share of the light from all around that the surface sends to the ray's origin, by all its lobes;
 * what glass lets through counts. */
ps_rgb material_reflectance(const struct material *material, const struct microfacet_table *table,
                            const ps_hit *hit, ps_vec3 ray_direction);

/* Radiance that the surface emits along the ray, towards its origin. */
ps_rgb material_emission(const struct material *material, const ps_hit *hit);

/* Whether it holds glass, which mirrors or lets through by chance. */
bool material_refracts(const struct material *material);

/* A camera path as one of `paths` of its pixel that have chosen alike so far, and whose numbers of
 * [0, 1) are as evenly spaced. */
struct stratum {
    float number;
    uint32_t paths;
};

/* See ps_host.sample_bsdf. `stratum`, if not NULL, chooses in place of sample[3] by what the
 * surface scatters, as long as there are several paths, of which whole numbers go each way; and
 * becomes that of the path that goes on. The pdf remains that of a path alone, by which light that
 * was asked is weighed against light that was hit (material_gloss). */
ps_bsdf_sample material_scatter(const struct material *material,
                                const struct microfacet_table *table, ps_direction direction,
                                const ps_ray *ray, const ps_hit *hit, const float sample[4],
                                struct stratum *stratum);

/* See ps_host.evaluate_bsdf. */
ps_bsdf_value material_evaluate(const struct material *material,
                                const struct microfacet_table *table, ps_direction direction,
                                const ps_ray *ray, const ps_hit *hit, ps_vec3 away);

/* See ps_hit.roughness. */
float material_roughness(const struct material *material, const ps_hit *hit);

/* Radiance towards the ray's origin by its rough reflectors for irradiance 1 across the beam that
 * comes from unit direction `in`: f * cosine, weighed against material_scatter's sampling for a
 * light whose own sampling has density `light_pdf` (0: scattering could not find it; power
 * heuristic). */
ps_rgb material_gloss(const struct material *material, const struct microfacet_table *table,
                      const ps_ray *ray, const ps_hit *hit, ps_vec3 in, float light_pdf);

#endif
