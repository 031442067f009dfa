/* bsdf_lobes.c: albedos of a material's components, and the choice among its lobes. */
#include "scene/bsdf_lobes.h"

#include "scene/fresnel.h"

ps_rgb bsdf_reflector_albedo(const struct component *component, const struct bsdf_view *view,
                             float cosine)
{
    ps_rgb f0 = bsdf_color(&component->specular, view->hit);
    float roughness = bsdf_roughness(component, view->hit);
    if (component->constant)
        return f0;
    if (bsdf_is_smooth(roughness))
        return fresnel_schlick(f0, cosine);
    return microfacet_albedo(view->table, f0, roughness, cosine);
}

static ps_rgb complement(ps_rgb a)
{
    return (ps_rgb){ps_max(1.0f - a.r, 0.0f), ps_max(1.0f - a.g, 0.0f), ps_max(1.0f - a.b, 0.0f)};
}

/* The component's diffuse albedo towards `cosine`, with its share. */
static ps_rgb diffuse_albedo(const struct component *component, const struct bsdf_view *view,
                             float cosine)
{
    if (component->kind != COMPONENT_DIFFUSE && component->kind != COMPONENT_GLOSSY)
        return (ps_rgb){0, 0, 0};
    ps_rgb albedo =
        ps_rgb_scale(bsdf_color(&component->diffuse, view->hit), bsdf_share(component, view));
    if (component->kind == COMPONENT_DIFFUSE)
        return albedo;
    return ps_rgb_multiply(albedo, complement(bsdf_reflector_albedo(component, view, cosine)));
}

ps_rgb bsdf_diffuse_albedo(const struct bsdf_view *view, float cosine)
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
    struct bsdf_view view = bsdf_view_of(material, table, hit, ray_direction);
    return bsdf_diffuse_albedo(&view, view.cosine);
}

/* The albedo of the component's other lobe towards `cosine`, with its share. */
static ps_rgb specular_albedo(const struct component *component, const struct bsdf_view *view,
                              float cosine)
{
    if (component->kind == COMPONENT_DIFFUSE)
        return (ps_rgb){0, 0, 0};
    ps_rgb albedo = component->kind == COMPONENT_DIELECTRIC
                        ? (ps_rgb){1, 1, 1}
                        : bsdf_reflector_albedo(component, view, cosine);
    return ps_rgb_scale(albedo, bsdf_share(component, view));
}

ps_rgb material_reflectance(const struct material *material, const struct microfacet_table *table,
                            const ps_hit *hit, ps_vec3 ray_direction)
{
    struct bsdf_view view = bsdf_view_of(material, table, hit, ray_direction);
    ps_rgb sum = view.diffuse;
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

static size_t add_lobe(struct bsdf_lobe *lobes, size_t count, const struct component *component,
                       float albedo)
{
    if (!(albedo > 0.0f))
        return count;
    lobes[count] = (struct bsdf_lobe){component, albedo};
    return count + 1;
}

size_t bsdf_list_lobes(const struct bsdf_view *view, struct bsdf_lobe lobes[BSDF_MOST_LOBES])
{
    float sum = 0.0f;
    size_t count = add_lobe(lobes, 0, NULL, ps_rgb_maximum(view->diffuse));
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

void material_tabulate(const struct material *material, struct microfacet_table *table)
{
    for (uint32_t i = 0; i < material->component_count; i++) {
        const struct component *component = &material->components[i];
        bool reflects =
            component->kind == COMPONENT_REFLECTOR || component->kind == COMPONENT_GLOSSY;
        if (!reflects || component->constant)
            continue;
        float roughness = pigment_mean(component->roughness.colors[0]);
        if (!pigment_is_constant(&component->roughness))
            microfacet_tabulate(table, 0.0f, 1.0f);
        else if (!bsdf_is_smooth(roughness))
            microfacet_tabulate(table, roughness, roughness);
    }
}

bool material_refracts(const struct material *material)
{
    bool found = false;
    for (uint32_t i = 0; i < material->component_count; i++)
        found |= material->components[i].kind == COMPONENT_DIELECTRIC;
    return found;
}

float material_roughness(const struct material *material, const ps_hit *hit)
{
    float least = 1.0f;
    for (uint32_t i = 0; i < material->component_count; i++) {
        const struct component *component = &material->components[i];
        if (component->kind == COMPONENT_DIFFUSE)
            continue;
        bool mirrors = component->kind == COMPONENT_DIELECTRIC || component->constant;
        least = ps_min(least, mirrors ? 0.0f : bsdf_roughness(component, hit));
    }
    return bsdf_is_smooth(least) ? 0.0f : least;
}
