#include "scene/material.h"

#include <assert.h>

/* --- construction
 * ------------------------------------------------------------------------------ */

/* What a component is of its material. */
struct portion {
    float share;
    enum component_sharing sharing;
};

/* What light is multiplied by, or another number of 0..1. */
static struct pigment reflectance_create(const struct pigment_description *description,
                                         const struct texture *textures)
{
    struct pigment pigment = pigment_create(description, textures);
    pigment.bounded = true;
    return pigment;
}

static struct component component_create(const struct material_description *description,
                                         struct portion portion, const struct texture *textures)
{
    struct component component = {
        .kind = COMPONENT_REFLECTOR,
        .share = portion.share,
        .sharing = portion.sharing,
        .specular = reflectance_create(&description->color, textures),
        .roughness = reflectance_create(&description->roughness, textures),
    };
    switch (description->kind) {
    case MATERIAL_DIFFUSE:
        component.kind = COMPONENT_DIFFUSE;
        component.diffuse = component.specular;
        break;
    case MATERIAL_MIRROR:
        component.constant = true;
        break;
    case MATERIAL_GLOSSY:
        component.kind = COMPONENT_GLOSSY;
        component.diffuse = component.specular;
        component.specular = reflectance_create(&description->specular, textures);
        break;
    case MATERIAL_DIELECTRIC:
        component.kind = COMPONENT_DIELECTRIC;
        component.ior = (float)description->ior;
        component.absorption = description->absorption;
        break;
    case MATERIAL_METAL:
    case MATERIAL_MIX:
        break;
    }
    return component;
}

/* Of the i-th part of a mix. */
static struct portion portion_of(const struct material_description *mix, size_t i,
                                 struct portion whole)
{
    if (!mix->varying)
        return (struct portion){whole.share * (float)mix->weights[i], whole.sharing};
    assert(mix->component_count == 2 && whole.sharing == SHARE_CONSTANT);
    return (struct portion){whole.share, i == 0 ? SHARE_FIRST : SHARE_SECOND};
}

/* Adds the components of a material, which may be a mix of others. */
static ps_result add_components(const struct scene_description *description, size_t index,
                                struct portion portion, const struct texture *textures,
                                struct material *material, struct error *error)
{
    const struct material_description *from = &description->materials[index];
    for (size_t i = 0; from->kind == MATERIAL_MIX && i < from->component_count; i++) {
        ps_result result = add_components(description, from->components[i],
                                          portion_of(from, i, portion), textures, material, error);
        if (result != PS_OK)
            return result;
    }
    if (from->kind == MATERIAL_MIX)
        return PS_OK;
    if (material->component_count == MATERIAL_MOST_COMPONENTS)
        return error_set(error, PS_ERROR_INVALID, "a mix of more than %d materials",
                         MATERIAL_MOST_COMPONENTS);
    struct component component = component_create(from, portion, textures);
    material->specular = material->specular || component.kind != COMPONENT_DIFFUSE;
    material->components[material->component_count++] = component;
    return PS_OK;
}

static bool is_black(const struct pigment_description *pigment)
{
    const ps_rgb *colors = pigment->colors;
    bool two = pigment->kind != PIGMENT_COLOR && pigment->kind != PIGMENT_IMAGE;
    return !(ps_rgb_maximum(colors[0]) > 0.0f) && !(two && ps_rgb_maximum(colors[1]) > 0.0f);
}

static bool has_opacity(const struct material_description *from)
{
    return from->opacity.kind != PIGMENT_COLOR || from->opacity.vertex_colors ||
           from->opacity.colors[0].r < (from->blended ? 1.0f : 0.5f);
}

/* What the pigments of the material, and of those that it is mixed of, want to be looked up by. A
 * mesh file's materials never want both, nor have they patterns. */
static enum material_lookup lookup_of(const struct scene_description *description, size_t index)
{
    struct material_description *from = &description->materials[index];
    struct pigment_description *pigments[MATERIAL_PIGMENTS];
    enum material_lookup lookup = LOOKUP_POINT;
    material_pigments(from, pigments);
    for (size_t i = 0; i < MATERIAL_PIGMENTS; i++) {
        if (pigments[i]->kind == PIGMENT_IMAGE && pigments[i]->uv_set == 1)
            lookup = LOOKUP_SECOND_UV;
        else if (pigments[i]->vertex_colors)
            return LOOKUP_COLORS;
    }
    for (size_t i = 0; i < from->component_count && lookup == LOOKUP_POINT; i++)
        lookup = lookup_of(description, from->components[i]);
    return lookup;
}

/* Of a material, and of those that it is mixed of. Where there are both, patterns are looked up at
 * points; so are those of bumps, which shade a surface that would be smooth in the mean. */
static enum material_filter filter_of(const struct scene_description *description, size_t index)
{
    struct material_description *from = &description->materials[index];
    struct pigment_description *pigments[MATERIAL_PIGMENTS];
    enum material_filter filter = FILTER_NOTHING;
    material_pigments(from, pigments);
    for (size_t i = 0; i < MATERIAL_PIGMENTS; i++) {
        if (pigments[i]->kind == PIGMENT_IMAGE)
            return FILTER_IMAGES;
        if (pigments[i]->kind != PIGMENT_COLOR && pigments[i] != &from->bump)
            filter = FILTER_PATTERNS;
    }
    for (size_t i = 0; i < from->component_count && filter != FILTER_IMAGES; i++) {
        enum material_filter of_part = filter_of(description, from->components[i]);
        filter = of_part != FILTER_NOTHING ? of_part : filter;
    }
    return filter;
}

/* For patterns of materials whose cones have their widths in other coordinates: as points. */
static void forget_cone(struct pigment *pigment)
{
    if (pigment->kind != PIGMENT_IMAGE)
        pigment->log_scale = -INFINITY;
}

static void forget_cones_of_patterns(struct material *material)
{
    forget_cone(&material->mixing);
    for (uint32_t i = 0; i < material->component_count; i++) {
        forget_cone(&material->components[i].diffuse);
        forget_cone(&material->components[i].specular);
        forget_cone(&material->components[i].roughness);
    }
}

ps_result material_create(const struct scene_description *description, size_t index,
                          const struct texture *textures, struct material *material,
                          struct error *error)
{
    const struct material_description *from = &description->materials[index];
    *material = (struct material){
        .emissive = !is_black(&from->emission),
        .emission_both = from->emission_both,
        .has_opacity = has_opacity(from),
        .blended = from->blended,
        .has_bump = from->bump.kind != PIGMENT_COLOR,
        .has_normal_map = from->normal_map.kind == PIGMENT_IMAGE,
        .lookup = lookup_of(description, index),
        .filter = has_opacity(from) ? FILTER_NOTHING : filter_of(description, index),
        .emission = pigment_create(&from->emission, textures),
        .opacity = pigment_create(&from->opacity, textures),
        .bump = pigment_create(&from->bump, textures),
        .normal_map = pigment_create(&from->normal_map, textures),
        .mixing = reflectance_create(&from->share, textures),
    };
    ps_result result = add_components(description, index, (struct portion){1.0f, SHARE_CONSTANT},
                                      textures, material, error);
    if (material->filter == FILTER_IMAGES)
        forget_cones_of_patterns(material);
    return result;
}

void material_create_lamp(ps_rgb radiance, bool both_sides, struct material *material)
{
    struct pigment_description emission = {.kind = PIGMENT_COLOR, .colors = {radiance}};
    *material = (struct material){
        .emissive = true,
        .emission_both = both_sides,
        .emission = pigment_create(&emission, NULL),
    };
}

ps_vec3 material_texture_point(const struct material *material, const struct shape *shape,
                               const struct shape_point *point, ps_vec3 patterns)
{
    float values[4] = {0};
    switch (material->lookup) {
    case LOOKUP_COLORS:
        shape_mesh_color(shape, point, values);
        break;
    case LOOKUP_SECOND_UV:
        shape_mesh_uv((const float(*)[2])shape->second_uv, point, values);
        break;
    case LOOKUP_POINT:
        return patterns;
    }
    return (ps_vec3){values[0], values[1], values[2]};
}

struct opacity_place material_opacity_place(const struct material *material,
                                            const struct shape *shape,
                                            const struct shape_point *point, ps_vec3 patterns)
{
    struct opacity_place place;
    shape_mesh_uv((const float(*)[2])shape->uv, point, place.uv);
    if (material->lookup == LOOKUP_COLORS) {
        float rgba[4];
        shape_mesh_color(shape, point, rgba);
        place.texture_point = (ps_vec3){rgba[3], rgba[3], rgba[3]};
    } else {
        place.texture_point = material_texture_point(material, shape, point, patterns);
    }
    return place;
}

float material_coverage(const struct material *material, const struct opacity_place *place)
{
    if (!material->has_opacity)
        return 1.0f;
    float opacity = pigment_number(&material->opacity, place->texture_point, place->uv);
    if (!material->blended)
        return opacity >= 0.5f ? 1.0f : 0.0f;
    return fminf(fmaxf(opacity, 0.0f), 1.0f);
}
