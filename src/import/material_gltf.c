/* material_gltf.c: metalness and roughness, as glTF 2 (and newer MTL, FBX) has them.
 *
 * A metal of the base colour from metalness 1 on, the base colour under a coat that reflects 4 % (or
 * what KHR_materials_ior says) at 0, and between them a mix by weight; transmission of a half and
 * more makes glass. roughness is squared into GGX's alpha there as here. A texture of metalness is
 * not followed: weights are constants, and the files that have one are mostly not metal, so that
 * such a material is taken as coated. Emission is radiance as it stands, times
 * KHR_materials_emissive_strength: Blender writes its own strengths there, not candelas.
 */
#include "import/material.h"

#include <string.h>

struct pbr {
    ps_rgb base;
    double alpha, metalness, roughness, ior, transmission;
    bool varying_metalness;
};

static double clamp_unit(double value)
{
    return fmin(fmax(value, 0), 1);
}

static ps_rgb at_most_one(ps_rgb color)
{
    return (ps_rgb){fminf(color.r, 1), fminf(color.g, 1), fminf(color.b, 1)};
}

static double read_alpha(const struct aiMaterial *source)
{
    struct aiColor4D color;
    if (aiGetMaterialColor(source, AI_MATKEY_BASE_COLOR, &color) != aiReturn_SUCCESS ||
        !isfinite(color.a))
        return clamp_unit(mesh_material_number(source, "$mat.opacity", 1));
    return clamp_unit(color.a);
}

static struct pbr read_pbr(const struct mesh_job *job, const struct aiMaterial *source)
{
    ps_rgb diffuse = mesh_material_color(source, "$clr.diffuse", mesh_grey(1));
    const double metalness = job->gltf.root ? 1 : 0;
    return (struct pbr){
        .base = at_most_one(mesh_material_color(source, "$clr.base", diffuse)),
        .alpha = read_alpha(source),
        .metalness = clamp_unit(mesh_material_number(source, "$mat.metallicFactor", metalness)),
        .roughness = clamp_unit(mesh_material_number(source, "$mat.roughnessFactor", 1)),
        .ior = mesh_material_number(source, "$mat.refracti", 1.5),
        .transmission = mesh_material_number(source, "$mat.transmission.factor", 0),
        .varying_metalness = mesh_texture_is_named(source, aiTextureType_METALNESS),
    };
}

/* --- surface -------------------------------------------------------------------------------------- */

static bool has_alpha_mode(const struct json *extras, const char *mode)
{
    const struct json *member = json_member(extras, "alphaMode");
    return member && member->kind == JSON_STRING && json_is(&member->text, mode);
}

/* Our surfaces are there from an opacity of 1/2 on, glTF's masks from their cutoff on. */
static ps_result read_opacity(struct mesh_job *job, const struct aiMaterial *source,
                              const struct json *extras, const struct pbr *pbr,
                              struct material_description *material)
{
    const struct mesh_texture_use use = {aiTextureType_BASE_COLOR, CHANNEL_A, ENCODING_AUTO};
    bool is_mask = has_alpha_mode(extras, "MASK");
    double cutoff = json_number(extras, "alphaCutoff", 0.5);
    if (extras && !is_mask && !has_alpha_mode(extras, "BLEND"))
        return PS_OK;
    double factor = is_mask && cutoff > 0 ? 0.5 / cutoff : is_mask ? 1e6 : 1;
    material->opacity = mesh_pigment(mesh_grey(pbr->alpha * factor));
    return extras ? mesh_pigment_texture(job, source, use, &material->opacity) : PS_OK;
}

static bool is_double_sided(const struct json *extras)
{
    const struct json *member = json_member(extras, "doubleSided");
    return member && member->kind == JSON_BOOLEAN && json_is(&member->text, "true");
}

static ps_result read_emission(struct mesh_job *job, const struct aiMaterial *source,
                               const struct json *extras, struct material_description *material)
{
    const struct mesh_texture_use use = {aiTextureType_EMISSIVE, CHANNEL_RGB, ENCODING_AUTO};
    const struct json *extension =
        json_member(json_member(extras, "extensions"), "KHR_materials_emissive_strength");
    double strength = fmax(0, json_number(extension, "emissiveStrength", 1));
    ps_rgb color = mesh_material_color(source, "$clr.emissive", mesh_grey(0));
    material->emission = mesh_pigment(ps_rgb_scale(color, (float)strength));
    material->emission_both = is_double_sided(extras);
    if (ps_rgb_maximum(color) <= 0 && extras)
        return PS_OK;
    return mesh_pigment_texture(job, source, use, &material->emission);
}

static ps_result read_surface(struct mesh_job *job, const struct aiMaterial *source,
                              const struct json *extras, const struct pbr *pbr,
                              struct material_description *material)
{
    bool has_base = mesh_texture_is_named(source, aiTextureType_BASE_COLOR);
    const struct mesh_texture_use base = {
        has_base ? aiTextureType_BASE_COLOR : aiTextureType_DIFFUSE, CHANNEL_RGB, ENCODING_AUTO};
    const struct mesh_texture_use normal = {aiTextureType_NORMALS, CHANNEL_RGB, ENCODING_LINEAR};
    material->color = mesh_pigment(pbr->base);
    ps_result result = mesh_pigment_texture(job, source, base, &material->color);
    if (result == PS_OK)
        result = read_emission(job, source, extras, material);
    if (result == PS_OK)
        result = read_opacity(job, source, extras, pbr, material);
    if (result == PS_OK)
        result = mesh_texture_find(job, source, normal, &material->normal_map);
    return result;
}

/* --- kinds ---------------------------------------------------------------------------------------- */

static double reflectance_of(double ior)
{
    double ratio = (ior - 1) / (ior + 1);
    return ratio * ratio;
}

/* KHR_materials_volume: what is left of white light after a distance, in the file's units. */
static ps_rgb read_absorption(const struct mesh_job *job, const struct aiMaterial *source)
{
    double distance = mesh_material_number(source, "$mat.volume.attenuationDistance", 0);
    ps_rgb left = mesh_material_color(source, "$mat.volume.attenuationColor", mesh_grey(1));
    if (!(distance > 0))
        return mesh_grey(0);
    float factor = (float)(-1 / (distance * job->scale));
    return (ps_rgb){factor * logf(fminf(fmaxf(left.r, 1e-6f), 1)),
                    factor * logf(fminf(fmaxf(left.g, 1e-6f), 1)),
                    factor * logf(fminf(fmaxf(left.b, 1e-6f), 1))};
}

static ps_result add_glass(struct mesh_job *job, const struct aiMaterial *source,
                           const struct pbr *pbr, struct material_description *material,
                           const char *name, size_t *index)
{
    material->kind = MATERIAL_DIELECTRIC;
    material->ior = pbr->ior > 1 ? pbr->ior : 1.5;
    material->absorption = read_absorption(job, source);
    return mesh_material_add(job, material, name, NULL, index);
}

static ps_result read_roughness(struct mesh_job *job, const struct aiMaterial *source,
                                const struct pbr *pbr, struct material_description *material)
{
    const struct mesh_texture_use use = {aiTextureType_DIFFUSE_ROUGHNESS,
                                         job->gltf.root ? CHANNEL_G : CHANNEL_RGB, ENCODING_LINEAR};
    material->roughness = mesh_pigment(mesh_grey(pbr->roughness));
    return mesh_pigment_texture(job, source, use, &material->roughness);
}

static ps_result add_opaque(struct mesh_job *job, const struct pbr *pbr,
                            const struct material_description *surface, const char *name,
                            size_t *index)
{
    struct material_description metal = *surface, coated = *surface;
    double metalness = pbr->varying_metalness ? 0 : pbr->metalness;
    metal.kind = MATERIAL_METAL;
    coated.kind = MATERIAL_GLOSSY;
    coated.specular = mesh_pigment(mesh_grey(reflectance_of(pbr->ior)));
    if (pbr->varying_metalness && pbr->metalness > 0)
        mesh_note(job, "material %.100s is metal in places: taken as not metal", name);
    if (metalness <= 0 || metalness >= 1)
        return mesh_material_add(job, metalness >= 1 ? &metal : &coated, name, NULL, index);
    const struct mesh_share shares[2] = {{&metal, metalness, "metal"},
                                         {&coated, 1 - metalness, "coated"}};
    return mesh_material_add_mix(job, shares, name, index);
}

ps_result mesh_material_read_gltf(struct mesh_job *job, const struct aiMaterial *source,
                                  const struct json *extras, const char *name, size_t *index)
{
    struct pbr pbr = read_pbr(job, source);
    struct material_description material = mesh_material_white(job->request->origin);
    ps_result result = read_surface(job, source, extras, &pbr, &material);
    if (result == PS_OK && pbr.transmission >= 0.5)
        return add_glass(job, source, &pbr, &material, name, index);
    if (result == PS_OK && job->request->diffuse_only)
        return mesh_material_add(job, &material, name, NULL, index);
    if (result == PS_OK)
        result = read_roughness(job, source, &pbr, &material);
    return result == PS_OK ? add_opaque(job, &pbr, &material, name, index) : result;
}
