#include "scene/material.h"

#include "scene/fresnel.h"
#include "scene/heuristic.h"
#include "scene/ray_cone.h"
#include <assert.h>

/* Grazing directions, where cosines divide. */
#define SMALLEST_COSINE 1e-4f

#define MOST_LOBES (1 + MATERIAL_MOST_COMPONENTS)

/* --- construction ------------------------------------------------------------------------------ */

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

/* What the pigments of the material, and of those that it is mixed of, want to be looked up by. A mesh file's materials
 * never want both, nor have they patterns. */
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

/* Whether some pigment of the material, or of those that it is mixed of, is an image. */
static bool has_image(const struct scene_description *description, size_t index)
{
    struct material_description *from = &description->materials[index];
    struct pigment_description *pigments[MATERIAL_PIGMENTS];
    bool found = false;
    material_pigments(from, pigments);
    for (size_t i = 0; i < MATERIAL_PIGMENTS; i++)
        found = found || pigments[i]->kind == PIGMENT_IMAGE;
    for (size_t i = 0; i < from->component_count && !found; i++)
        found = has_image(description, from->components[i]);
    return found;
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
        .filters = has_image(description, index) && !has_opacity(from),
        .emission = pigment_create(&from->emission, textures),
        .opacity = pigment_create(&from->opacity, textures),
        .bump = pigment_create(&from->bump, textures),
        .normal_map = pigment_create(&from->normal_map, textures),
        .mixing = reflectance_create(&from->share, textures),
    };
    return add_components(description, index, (struct portion){1.0f, SHARE_CONSTANT}, textures,
                          material, error);
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

/* --- lobes --------------------------------------------------------------------------------------- */

/* A surface point seen from a direction: what is needed of it more than once. */
struct view {
    const struct material *material;
    const struct microfacet_table *table;
    const ps_hit *hit;
    ps_vec3 out;  /* unit, back along the ray */
    float cosine; /* of `out` to the shading normal, > 0 */
};

static struct view view_of(const struct material *material, const struct microfacet_table *table,
                           const ps_hit *hit, ps_vec3 ray_direction)
{
    ps_vec3 out = ps_scale(ray_direction, -1.0f);
    float cosine = fmaxf(ps_dot(out, hit->normal), SMALLEST_COSINE);
    return (struct view){material, table, hit, out, cosine};
}

static ps_rgb color_at(const struct pigment *pigment, const ps_hit *hit)
{
    return pigment_filter(pigment, hit->texture_point, hit->uv, ray_cone_log_width(hit));
}

static float number_at(const struct pigment *pigment, const ps_hit *hit)
{
    return pigment_mean(color_at(pigment, hit));
}

static float roughness_at(const struct component *component, const ps_hit *hit)
{
    return number_at(&component->roughness, hit);
}

/* The component's part of the material. */
static float share_at(const struct component *component, const struct view *view)
{
    if (component->sharing == SHARE_CONSTANT)
        return component->share;
    float first = number_at(&view->material->mixing, view->hit);
    return component->share * (component->sharing == SHARE_FIRST ? first : 1.0f - first);
}

static bool is_smooth(float roughness)
{
    return roughness < MICROFACET_SMOOTHEST;
}

/* The share of the light from all around that the component's reflector sends to `cosine`. */
static ps_rgb reflector_albedo(const struct component *component, const struct view *view,
                               float cosine)
{
    ps_rgb f0 = color_at(&component->specular, view->hit);
    float roughness = roughness_at(component, view->hit);
    if (component->constant)
        return f0;
    if (is_smooth(roughness))
        return fresnel_schlick(f0, cosine);
    return microfacet_albedo(view->table, f0, roughness, cosine);
}

static ps_rgb complement(ps_rgb a)
{
    return (ps_rgb){fmaxf(0.0f, 1.0f - a.r), fmaxf(0.0f, 1.0f - a.g), fmaxf(0.0f, 1.0f - a.b)};
}

/* The component's diffuse albedo towards `cosine`, with its share. */
static ps_rgb diffuse_albedo(const struct component *component, const struct view *view,
                             float cosine)
{
    if (component->kind != COMPONENT_DIFFUSE && component->kind != COMPONENT_GLOSSY)
        return (ps_rgb){0, 0, 0};
    ps_rgb albedo =
        ps_rgb_scale(color_at(&component->diffuse, view->hit), share_at(component, view));
    if (component->kind == COMPONENT_DIFFUSE)
        return albedo;
    return ps_rgb_multiply(albedo, complement(reflector_albedo(component, view, cosine)));
}

/* The diffuse albedo of all components towards `cosine`. */
static ps_rgb all_diffuse_albedo(const struct view *view, float cosine)
{
    const struct material *material = view->material;
    ps_rgb sum = {0, 0, 0};
    for (uint32_t i = 0; i < material->component_count; i++)
        sum = ps_rgb_add(sum, diffuse_albedo(&material->components[i], view, cosine));
    return sum;
}

ps_rgb material_albedo(const struct material *material, const struct microfacet_table *table,
                       const ps_hit *hit, ps_vec3 ray_direction)
{
    struct view view = view_of(material, table, hit, ray_direction);
    return all_diffuse_albedo(&view, view.cosine);
}

/* The albedo of the component's other lobe towards `cosine`, with its share. */
static ps_rgb specular_albedo(const struct component *component, const struct view *view,
                              float cosine)
{
    if (component->kind == COMPONENT_DIFFUSE)
        return (ps_rgb){0, 0, 0};
    ps_rgb albedo = component->kind == COMPONENT_DIELECTRIC
                        ? (ps_rgb){1, 1, 1}
                        : reflector_albedo(component, view, cosine);
    return ps_rgb_scale(albedo, share_at(component, view));
}

ps_rgb material_reflectance(const struct material *material, const struct microfacet_table *table,
                            const ps_hit *hit, ps_vec3 ray_direction)
{
    struct view view = view_of(material, table, hit, ray_direction);
    ps_rgb sum = all_diffuse_albedo(&view, view.cosine);
    for (uint32_t i = 0; i < material->component_count; i++)
        sum = ps_rgb_add(sum, specular_albedo(&material->components[i], &view, view.cosine));
    return sum;
}

ps_rgb material_emission(const struct material *material, const ps_hit *hit)
{
    if (!material->emissive || ((hit->flags & PS_HIT_BACK) && !material->emission_both))
        return (ps_rgb){0, 0, 0};
    return pigment_color(&material->emission, hit->texture_point, hit->uv);
}

/* A way in which light may go on: the other lobe of a component, or the diffuse one of all, which is
 * a single one so that what ends there may count the whole albedo. */
struct lobe {
    const struct component *component; /* NULL: diffuse */
    float probability;
};

static size_t add_lobe(struct lobe *lobes, size_t count, const struct component *component,
                       float albedo)
{
    if (!(albedo > 0.0f))
        return count;
    lobes[count] = (struct lobe){component, albedo};
    return count + 1;
}

/* The surface's lobes with their probabilities, by albedo. */
static size_t list_lobes(const struct view *view, struct lobe lobes[MOST_LOBES])
{
    float sum = 0.0f;
    size_t count = add_lobe(lobes, 0, NULL, ps_rgb_maximum(all_diffuse_albedo(view, view->cosine)));
    for (uint32_t i = 0; i < view->material->component_count; i++) {
        const struct component *component = &view->material->components[i];
        ps_rgb albedo = specular_albedo(component, view, view->cosine);
        count = add_lobe(lobes, count, component, ps_rgb_maximum(albedo));
    }
    for (size_t i = 0; i < count; i++)
        sum += lobes[i].probability;
    for (size_t i = 0; i < count; i++)
        lobes[i].probability /= sum;
    return count;
}

/* Chooses a lobe, and rescales the number so that it can be used again. */
static const struct lobe *choose_lobe(const struct lobe *lobes, size_t count, float *number)
{
    float left = *number;
    size_t i = 0;
    while (i + 1 < count && left >= lobes[i].probability)
        left -= lobes[i++].probability;
    *number = fminf(left / lobes[i].probability, 0x1.fffffep-1f);
    return &lobes[i];
}

bool material_refracts(const struct material *material)
{
    bool found = false;
    for (uint32_t i = 0; i < material->component_count; i++)
        found |= material->components[i].kind == COMPONENT_DIELECTRIC;
    return found;
}

/* --- scattering ------------------------------------------------------------------------------ */

static ps_vec3 to_frame(const ps_vec3 frame[3], ps_vec3 w)
{
    return (ps_vec3){ps_dot(w, frame[0]), ps_dot(w, frame[1]), ps_dot(w, frame[2])};
}

static ps_vec3 from_frame(const ps_vec3 frame[3], ps_vec3 w)
{
    return ps_add_scaled(ps_add_scaled(ps_scale(frame[0], w.x), w.y, frame[1]), w.z, frame[2]);
}

static void shading_frame(const ps_hit *hit, ps_vec3 frame[3])
{
    frame[2] = hit->normal;
    ps_frame(frame[2], &frame[0], &frame[1]);
}

static ps_bsdf_sample mirror(const struct lobe *lobe, const struct view *view)
{
    const struct component *component = lobe->component;
    ps_vec3 n = view->hit->normal;
    ps_rgb reflected = reflector_albedo(component, view, view->cosine);
    return (ps_bsdf_sample){
        .direction =
            ps_normalize(ps_add_scaled(ps_scale(view->out, -1.0f), 2.0f * ps_dot(view->out, n), n)),
        .weight = ps_rgb_scale(reflected, share_at(component, view)),
        .lobe = PS_SPECULAR,
    };
}

static ps_bsdf_sample reflect_roughly(const struct lobe *lobe, const struct view *view,
                                      ps_direction direction, const float sample[4])
{
    const struct component *component = lobe->component;
    float roughness = roughness_at(component, view->hit);
    ps_rgb f0 = color_at(&component->specular, view->hit);
    ps_vec3 frame[3];
    shading_frame(view->hit, frame);
    ps_vec3 out = to_frame(frame, view->out);
    out.z = fmaxf(out.z, SMALLEST_COSINE);
    ps_vec3 in = microfacet_sample(roughness, out, sample[0], sample[1]);
    float eye = direction == PS_FROM_CAMERA ? out.z : in.z;
    ps_rgb weight = ps_rgb_multiply(microfacet_weight(roughness, f0, out, in),
                                    microfacet_compensation(view->table, f0, roughness, eye));
    return (ps_bsdf_sample){
        .direction = ps_normalize(from_frame(frame, in)),
        .weight = ps_rgb_scale(weight, share_at(component, view)),
        .pdf = microfacet_pdf(roughness, out, in),
        .lobe = PS_GLOSSY,
    };
}

static ps_bsdf_sample scatter_diffusely(const struct view *view, ps_direction direction,
                                        const float sample[4])
{
    ps_vec3 n = view->hit->normal;
    ps_vec3 w = ps_cosine_direction(n, sample[0], sample[1]);
    float cosine = ps_dot(w, n);
    return (ps_bsdf_sample){
        .direction = w,
        .weight = all_diffuse_albedo(view, direction == PS_FROM_CAMERA ? view->cosine : cosine),
        .pdf = cosine / PS_PI,
        .lobe = PS_DIFFUSE,
    };
}

static ps_rgb transmittance(ps_rgb absorption, float distance)
{
    return (ps_rgb){expf(-absorption.r * distance), expf(-absorption.g * distance),
                    expf(-absorption.b * distance)};
}

/* Chance by which glass mirrors, of the share that it does. Of eight samples of a pixel, which are stratified, camera
 * paths send at least one either way, so that what is rare is seen in all pixels and not in some. Photons
 * keep their power. */
static float chance_to_mirror(float reflectance, ps_direction direction)
{
    const float least = 0.125f;
    if (direction == PS_FROM_LIGHT || reflectance <= 0.0f || reflectance >= 1.0f)
        return reflectance;
    return fminf(fmaxf(reflectance, least), 1.0f - least);
}

/* Mirrors or refracts, by chance. Radiance is squeezed into a smaller solid angle on the denser side;
 * power is not. */
static ps_bsdf_sample pass_surface(const struct lobe *lobe, const struct view *view,
                                   ps_direction direction, float number)
{
    const struct component *component = lobe->component;
    bool inside = view->hit->flags & PS_HIT_BACK;
    float eta = inside ? 1.0f / component->ior : component->ior;
    float far_cosine, reflectance = fresnel_dielectric(view->cosine, eta, &far_cosine);
    ps_vec3 n = view->hit->normal;
    ps_rgb weight = {component->share, component->share, component->share};
    if (inside)
        weight = ps_rgb_multiply(weight, transmittance(component->absorption, view->hit->distance));
    ps_bsdf_sample scattered = {.lobe = PS_SPECULAR, .weight = weight};
    float chance = chance_to_mirror(reflectance, direction);
    if (number < chance) {
        scattered.weight = ps_rgb_scale(weight, reflectance / chance);
        scattered.direction =
            ps_add_scaled(ps_scale(view->out, -1.0f), 2.0f * ps_dot(view->out, n), n);
    } else {
        weight = ps_rgb_scale(weight, (1.0f - reflectance) / (1.0f - chance));
        ps_vec3 along = ps_scale(view->out, -1.0f / eta);
        scattered.direction = ps_add_scaled(along, view->cosine / eta - far_cosine, n);
        scattered.weight = ps_rgb_multiply(weight, color_at(&component->specular, view->hit));
        if (direction == PS_FROM_CAMERA)
            scattered.weight = ps_rgb_scale(scattered.weight, 1.0f / (eta * eta));
    }
    scattered.direction = ps_normalize(scattered.direction);
    return scattered;
}

static ps_bsdf_sample follow_lobe(const struct lobe *lobe, const struct view *view,
                                  ps_direction direction, const float sample[4], float number)
{
    const struct component *component = lobe->component;
    if (!component)
        return scatter_diffusely(view, direction, sample);
    if (component->kind == COMPONENT_DIELECTRIC)
        return pass_surface(lobe, view, direction, number);
    if (component->constant || is_smooth(roughness_at(component, view->hit)))
        return mirror(lobe, view);
    return reflect_roughly(lobe, view, direction, sample);
}

/* What light paths lose or gain at smoothed and bent normals (Veach 1997, section 5.3): where they arrive, along
 * view->out, and where they leave along w. */
static float arrival_correction(const struct view *view)
{
    ps_vec3 shading = view->hit->normal, true_normal = view->hit->geometric_normal;
    if (ps_same(shading, true_normal))
        return 1.0f;
    float in = ps_dot(view->out, shading) / fmaxf(ps_dot(view->out, true_normal), SMALLEST_COSINE);
    return fmaxf(in, 0.0f);
}

static float shading_correction(const struct view *view, ps_vec3 w)
{
    ps_vec3 shading = view->hit->normal, true_normal = view->hit->geometric_normal;
    if (ps_same(shading, true_normal))
        return 1.0f;
    float away = fabsf(ps_dot(w, true_normal)) / fmaxf(fabsf(ps_dot(w, shading)), SMALLEST_COSINE);
    return arrival_correction(view) * away;
}

/* --- surfaces that are diffuse alone ---------------------------------------------------------------
 *
 * What arrives counts by the shading normal, and what leaves goes to all directions of the surface itself, whichever side of
 * its shading normal they are on. So camera paths draw by the shading normal, and light paths by the geometric one. */

static ps_bsdf_sample scatter_light_diffusely(const struct view *view, const float sample[4])
{
    ps_vec3 n = view->hit->geometric_normal;
    ps_vec3 w = ps_cosine_direction(n, sample[0], sample[1]);
    return (ps_bsdf_sample){
        .direction = w,
        .normal = n,
        .weight = ps_rgb_scale(all_diffuse_albedo(view, view->cosine), arrival_correction(view)),
        .probability = 1.0f,
        .pdf = ps_dot(w, n) / PS_PI,
        .lobe = PS_DIFFUSE,
    };
}

static ps_bsdf_value evaluate_diffuse(const struct view *view, ps_direction direction, ps_vec3 away)
{
    const ps_hit *hit = view->hit;
    ps_rgb albedo = all_diffuse_albedo(view, view->cosine);
    float shading = fmaxf(ps_dot(away, hit->normal), 0.0f) / PS_PI;
    float geometric = ps_dot(away, hit->geometric_normal) / PS_PI;
    float back_shading = fmaxf(ps_dot(view->out, hit->normal), 0.0f) / PS_PI;
    float back_geometric = ps_dot(view->out, hit->geometric_normal) / PS_PI;
    if (!(geometric > 0.0f))
        return (ps_bsdf_value){.pdf = 0.0f};
    if (direction == PS_FROM_CAMERA)
        return (ps_bsdf_value){ps_rgb_scale(albedo, shading), shading, back_geometric};
    return (ps_bsdf_value){ps_rgb_scale(albedo, geometric * arrival_correction(view)), geometric,
                           back_shading};
}

/* --- any surface ------------------------------------------------------------------------------- */

ps_bsdf_sample material_scatter(const struct material *material,
                                const struct microfacet_table *table, ps_direction direction,
                                const ps_ray *ray, const ps_hit *hit, const float sample[4])
{
    struct lobe lobes[MOST_LOBES];
    struct view view = view_of(material, table, hit, ray->direction);
    if (!material->specular && direction == PS_FROM_LIGHT)
        return scatter_light_diffusely(&view, sample);
    size_t count = list_lobes(&view, lobes);
    if (count == 0)
        return (ps_bsdf_sample){
            .direction = hit->normal, .normal = hit->normal, .probability = 1.0f};
    float number = sample[3];
    const struct lobe *lobe = choose_lobe(lobes, count, &number);
    ps_bsdf_sample scattered = follow_lobe(lobe, &view, direction, sample, number);
    scattered.probability = lobe->probability;
    scattered.pdf *= lobe->probability;
    float factor = 1.0f / lobe->probability;
    float side = ps_dot(scattered.direction, hit->geometric_normal);
    bool crosses = ps_dot(scattered.direction, hit->normal) < 0.0f;
    scattered.normal = crosses ? ps_scale(hit->geometric_normal, -1.0f) : hit->geometric_normal;
    if (crosses != (side < 0.0f)) /* a bent normal would send it through the surface */
        factor = 0.0f;
    else if (direction == PS_FROM_LIGHT)
        factor *= shading_correction(&view, scattered.direction);
    scattered.weight = ps_rgb_scale(scattered.weight, factor);
    return scattered;
}

/* The lobe's part of the value, with light that comes from `in` and leaves to `out`, or the other way round;
 * `eye`: the cosine of where it leaves to. Directions in the shading frame; `pdf` becomes the density by which
 * material_scatter draws `in`, given `out`. */
static ps_rgb evaluate_lobe(const struct lobe *lobe, const struct view *view, ps_vec3 out,
                            ps_vec3 in, float eye, float *pdf)
{
    const struct component *component = lobe->component;
    *pdf = 0.0f;
    if (!component) {
        *pdf = lobe->probability * in.z / PS_PI;
        return ps_rgb_scale(all_diffuse_albedo(view, eye), in.z / PS_PI);
    }
    float roughness =
        component->kind == COMPONENT_DIELECTRIC ? 0.0f : roughness_at(component, view->hit);
    if (component->constant || is_smooth(roughness))
        return (ps_rgb){0, 0, 0};
    ps_rgb f0 = color_at(&component->specular, view->hit);
    *pdf = lobe->probability * microfacet_pdf(roughness, out, in);
    return ps_rgb_scale(ps_rgb_multiply(microfacet_reflect(roughness, f0, out, in),
                                        microfacet_compensation(view->table, f0, roughness, eye)),
                        share_at(component, view));
}

/* All lobes; the ray leaves them along view->out, or comes from there. */
static ps_rgb evaluate_lobes(const struct view *view, ps_direction direction, ps_vec3 out,
                             ps_vec3 in, float *pdf)
{
    struct lobe lobes[MOST_LOBES];
    size_t count = list_lobes(view, lobes);
    ps_rgb sum = {0, 0, 0};
    *pdf = 0.0f;
    for (size_t i = 0; i < count; i++) {
        float own;
        float eye = direction == PS_FROM_CAMERA ? view->cosine : in.z;
        sum = ps_rgb_add(sum, evaluate_lobe(&lobes[i], view, out, in, eye, &own));
        *pdf += own;
    }
    return sum;
}

ps_bsdf_value material_evaluate(const struct material *material,
                                const struct microfacet_table *table, ps_direction direction,
                                const ps_ray *ray, const ps_hit *hit, ps_vec3 away)
{
    struct view view = view_of(material, table, hit, ray->direction);
    if (!material->specular)
        return evaluate_diffuse(&view, direction, away);
    struct view reverse = view_of(material, table, hit, ps_scale(away, -1.0f));
    ps_bsdf_value value = {.pdf = 0.0f};
    ps_vec3 frame[3];
    shading_frame(hit, frame);
    ps_vec3 out = to_frame(frame, view.out), in = to_frame(frame, away);
    if (!(in.z > 0.0f && ps_dot(away, hit->geometric_normal) > 0.0f))
        return value;
    out.z = fmaxf(out.z, SMALLEST_COSINE);
    value.value = evaluate_lobes(&view, direction, out, in, &value.pdf);
    evaluate_lobes(&reverse, direction, in, out, &value.reverse_pdf);
    if (direction == PS_FROM_LIGHT)
        value.value = ps_rgb_scale(value.value, shading_correction(&view, away));
    return value;
}

float material_roughness(const struct material *material, const ps_hit *hit)
{
    float least = 1.0f;
    for (uint32_t i = 0; i < material->component_count; i++) {
        const struct component *component = &material->components[i];
        if (component->kind == COMPONENT_DIFFUSE)
            continue;
        bool mirrors = component->kind == COMPONENT_DIELECTRIC || component->constant;
        least = fminf(least, mirrors ? 0.0f : roughness_at(component, hit));
    }
    return is_smooth(least) ? 0.0f : least;
}

ps_rgb material_gloss(const struct material *material, const struct microfacet_table *table,
                      const ps_ray *ray, const ps_hit *hit, ps_vec3 in, float light_pdf)
{
    struct lobe lobes[MOST_LOBES];
    struct view view = view_of(material, table, hit, ray->direction);
    size_t count = list_lobes(&view, lobes);
    ps_vec3 frame[3];
    shading_frame(hit, frame);
    ps_vec3 to_eye = to_frame(frame, view.out), to_light = to_frame(frame, in);
    to_eye.z = fmaxf(to_eye.z, SMALLEST_COSINE);
    ps_rgb sum = {0, 0, 0};
    if (!(to_light.z > 0.0f && ps_dot(in, hit->geometric_normal) > 0.0f))
        return sum;
    for (size_t i = 0; i < count; i++) {
        const struct component *component = lobes[i].component;
        if (!component || component->kind == COMPONENT_DIELECTRIC || component->constant)
            continue;
        float roughness = roughness_at(component, hit);
        if (is_smooth(roughness))
            continue;
        ps_rgb f0 = color_at(&component->specular, hit);
        ps_rgb reflected = ps_rgb_multiply(microfacet_reflect(roughness, f0, to_eye, to_light),
                                           microfacet_compensation(table, f0, roughness, to_eye.z));
        float own = lobes[i].probability * microfacet_pdf(roughness, to_eye, to_light);
        float share = power_heuristic(light_pdf, own);
        sum = ps_rgb_add(sum, ps_rgb_scale(reflected, share_at(component, &view) * share));
    }
    return sum;
}
