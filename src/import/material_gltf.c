/* material_gltf.c: metalness and roughness, as glTF 2 (and newer MTL, FBX) has them.
 *
 * A metal of the base colour from metalness 1 on, the base colour under a coat that reflects 4 %
 * (or what KHR_materials_ior and KHR_materials_specular say) at 0, and between them a mix by
 * weight, which a texture may vary; transmission of a half and more makes glass. roughness is
 * squared into GGX's alpha there as here. Emission is radiance as it stands, times
 * KHR_materials_emissive_strength: Blender writes its own strengths there, not candelas.
 * KHR_materials_unlit: a black surface that emits the base colour.
 * KHR_materials_pbrSpecularGlossiness: material_glossiness.c.
 */
#include "import/material_gltf.h"

#include <string.h>

/* Of a factor on tilts of normals: more would bend them no further. */
#define LARGEST_TILT 1000.0

struct pbr {
    ps_rgb base, coat; /* reflectances; the coat's at normal incidence */
    double alpha, metalness, roughness, ior, transmission;
};

static double clamp_unit(double value)
{
    return fmin(fmax(value, 0), 1);
}

static double read_alpha(const struct aiMaterial *source)
{
    struct aiColor4D color;
    if (aiGetMaterialColor(source, AI_MATKEY_BASE_COLOR, &color) != aiReturn_SUCCESS ||
        !isfinite(color.a))
        return clamp_unit(mesh_material_number(source, "$mat.opacity", 1));
    return clamp_unit(color.a);
}

ps_rgb mesh_json_color(const struct json *object, const char *name, ps_rgb fallback)
{
    const struct json *array = json_member(object, name);
    float parts[3];
    for (size_t i = 0; i < 3; i++) {
        const struct json *number = json_element(array, i);
        if (!number || number->kind != JSON_NUMBER || !isfinite(number->number))
            return fallback;
        parts[i] = (float)fmin(fmax(number->number, 0), FLT_MAX);
    }
    return (ps_rgb){parts[0], parts[1], parts[2]};
}

const struct json *mesh_gltf_extension(const struct json *extras, const char *name)
{
    return json_member(json_member(extras, "extensions"), name);
}

/* What is reflected at normal incidence: by the index, times KHR_materials_specular. */
static ps_rgb read_coat(const struct json *extras, double ior)
{
    const struct json *specular = mesh_gltf_extension(extras, "KHR_materials_specular");
    double root = (ior - 1) / (ior + 1), reflectance = root * root;
    double factor = clamp_unit(json_number(specular, "specularFactor", 1));
    ps_rgb color = ps_rgb_scale(mesh_json_color(specular, "specularColorFactor", mesh_grey(1)),
                                (float)reflectance);
    return ps_rgb_scale((ps_rgb){fminf(color.r, 1), fminf(color.g, 1), fminf(color.b, 1)},
                        (float)factor);
}

static struct pbr read_pbr(struct mesh_job *job, const struct aiMaterial *source,
                           const struct json *extras, const char *name)
{
    ps_rgb diffuse = mesh_material_color(source, "$clr.diffuse", mesh_grey(1));
    const double metalness = job->gltf.root ? 1 : 0;
    double ior = mesh_material_number(source, "$mat.refracti", 1.5);
    return (struct pbr){
        .base = mesh_reflectance(job, mesh_material_color(source, "$clr.base", diffuse), name),
        .coat = read_coat(extras, ior),
        .alpha = read_alpha(source),
        .metalness = clamp_unit(mesh_material_number(source, "$mat.metallicFactor", metalness)),
        .roughness = clamp_unit(mesh_material_number(source, "$mat.roughnessFactor", 1)),
        .ior = ior,
        .transmission = mesh_material_number(source, "$mat.transmission.factor", 0),
    };
}

/* --- surface
 * -------------------------------------------------------------------------------------- */

static bool has_alpha_mode(const struct json *extras, const char *mode)
{
    const struct json *member = json_member(extras, "alphaMode");
    return member && member->kind == JSON_STRING && json_is(&member->text, mode);
}

/* Our surfaces are there from an opacity of 1/2 on, glTF's masks from their cutoff on. */
ps_result mesh_gltf_opacity(struct mesh_job *job, const struct aiMaterial *source,
                            struct mesh_texture_use use, const struct json *extras, double alpha,
                            struct material_description *material)
{
    bool is_mask = has_alpha_mode(extras, "MASK");
    double cutoff = json_number(extras, "alphaCutoff", 0.5);
    if (extras && !is_mask && !has_alpha_mode(extras, "BLEND"))
        return PS_OK;
    double factor = is_mask && cutoff > 0 ? 0.5 / cutoff : is_mask ? 1e6 : 1;
    use.channel = CHANNEL_A;
    material->opacity = mesh_pigment(mesh_grey(alpha * factor));
    material->opacity.vertex_colors = true; /* where there are some */
    material->blended = !is_mask;
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
    const struct mesh_texture_use use = {aiTextureType_EMISSIVE, CHANNEL_RGB, ENCODING_AUTO,
                                         json_member(extras, "emissiveTexture")};
    const struct json *extension = mesh_gltf_extension(extras, "KHR_materials_emissive_strength");
    double strength = fmax(0, json_number(extension, "emissiveStrength", 1));
    ps_rgb color = mesh_material_color(source, "$clr.emissive", mesh_grey(0));
    material->emission = mesh_pigment(ps_rgb_scale(color, (float)strength));
    material->emission_both = is_double_sided(extras);
    if (ps_rgb_maximum(color) <= 0 && extras)
        return PS_OK;
    return mesh_pigment_texture(job, source, use, &material->emission);
}

static ps_result read_surface(struct mesh_job *job, const struct aiMaterial *source,
                              const struct json *extras, struct material_description *material)
{
    const struct json *info = json_member(extras, "normalTexture");
    const struct mesh_texture_use normal = {aiTextureType_NORMALS, CHANNEL_RGB, ENCODING_LINEAR,
                                            info};
    ps_result result = read_emission(job, source, extras, material);
    double scale = fmin(fmax(json_number(info, "scale", 1), -LARGEST_TILT), LARGEST_TILT);
    material->normal_map = mesh_pigment(mesh_grey(scale));
    return result == PS_OK ? mesh_pigment_texture(job, source, normal, &material->normal_map)
                           : result;
}

static struct mesh_texture_use use_of_base(const struct aiMaterial *source,
                                           const struct json *metallic)
{
    bool has_base = mesh_texture_is_named(source, aiTextureType_BASE_COLOR);
    return (struct mesh_texture_use){has_base ? aiTextureType_BASE_COLOR : aiTextureType_DIFFUSE,
                                     CHANNEL_RGB, ENCODING_AUTO,
                                     json_member(metallic, "baseColorTexture")};
}

static ps_result read_base(struct mesh_job *job, const struct aiMaterial *source,
                           const struct json *extras, const struct pbr *pbr,
                           struct material_description *material)
{
    struct mesh_texture_use base = use_of_base(source, json_member(extras, "pbrMetallicRoughness"));
    material->color = mesh_pigment(pbr->base);
    ps_result result = mesh_pigment_texture(job, source, base, &material->color);
    return result == PS_OK ? mesh_gltf_opacity(job, source, base, extras, pbr->alpha, material)
                           : result;
}

/* --- kinds
 * ---------------------------------------------------------------------------------------- */

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
    if (pbr->roughness > 0)
        mesh_material_omit(job, "the roughness of the glass", name);
    return mesh_material_add(job, material, name, NULL, index);
}

/* The base colour is shown as it is, and lights what is around as all that shines does. */
static ps_result add_unlit(struct mesh_job *job, const struct json *extras,
                           struct material_description *material, const char *name, size_t *index)
{
    material->emission = material->color;
    material->emission.vertex_colors = true; /* where there are some */
    material->emission_both = is_double_sided(extras);
    material->color = mesh_pigment(mesh_grey(0));
    return mesh_material_add(job, material, name, NULL, index);
}

static struct mesh_texture_use use_of_metal(const struct mesh_job *job, const struct json *extras,
                                            enum aiTextureType type, enum texture_channel channel)
{
    const struct json *metallic = json_member(extras, "pbrMetallicRoughness");
    return (struct mesh_texture_use){type, job->gltf.root ? channel : CHANNEL_RGB, ENCODING_LINEAR,
                                     json_member(metallic, "metallicRoughnessTexture")};
}

/* A metal and a coated surface that differ in nothing else. */
static ps_result add_opaque(struct mesh_job *job, const struct aiMaterial *source,
                            const struct json *extras, const struct pbr *pbr,
                            const struct material_description *surface, const char *name,
                            size_t *index)
{
    struct material_description metal = *surface, coated = *surface;
    struct pigment_description share = mesh_pigment(mesh_grey(pbr->metalness));
    double metalness = pbr->metalness;
    metal.kind = MATERIAL_METAL;
    coated.kind = MATERIAL_GLOSSY;
    coated.specular = mesh_pigment(pbr->coat);
    if (metalness > 0 && mesh_texture_is_named(source, aiTextureType_METALNESS)) {
        ps_result result = mesh_pigment_texture(
            job, source, use_of_metal(job, extras, aiTextureType_METALNESS, CHANNEL_B), &share);
        if (result != PS_OK)
            return result;
        if (share.kind != PIGMENT_IMAGE)
            metalness = 0; /* a picture that is missing: most of such things are no metal */
    }
    const struct mesh_share shares[2] = {{&metal, metalness, "metal"},
                                         {&coated, 1 - metalness, "coated"}};
    if (share.kind == PIGMENT_IMAGE)
        return mesh_material_add_mix(job, shares, &share, name, index);
    if (metalness <= 0 || metalness >= 1)
        return mesh_material_add(job, metalness >= 1 ? &metal : &coated, name, NULL, index);
    return mesh_material_add_mix(job, shares, NULL, name, index);
}

static ps_result add_kind(struct mesh_job *job, const struct aiMaterial *source,
                          const struct json *extras, const struct pbr *pbr,
                          struct material_description *material, const char *name, size_t *index)
{
    if (mesh_gltf_extension(extras, "KHR_materials_unlit"))
        return add_unlit(job, extras, material, name, index);
    if (pbr->transmission >= 0.5)
        return add_glass(job, source, pbr, material, name, index);
    if (job->request->diffuse_only)
        return mesh_material_add(job, material, name, NULL, index);
    material->roughness = mesh_pigment(mesh_grey(pbr->roughness));
    ps_result result = mesh_pigment_texture(
        job, source, use_of_metal(job, extras, aiTextureType_DIFFUSE_ROUGHNESS, CHANNEL_G),
        &material->roughness);
    return result == PS_OK ? add_opaque(job, source, extras, pbr, material, name, index) : result;
}

/* --- what is left out
 * ----------------------------------------------------------------------------- */

/* By the factors by which they count: without them, or with 0, there is nothing to leave out. */
static const struct {
    const char *extension, *member;
    const char *what;
} left_out[] = {
    {"KHR_materials_clearcoat", "clearcoatFactor", "the clearcoat"},
    {"KHR_materials_sheen", "sheenColorFactor", "the sheen"},
    {"KHR_materials_anisotropy", "anisotropyStrength", "the anisotropy"},
    {"KHR_materials_iridescence", "iridescenceFactor", "the iridescence"},
    {"KHR_materials_dispersion", "dispersion", "the dispersion"},
    {"KHR_materials_diffuse_transmission", "diffuseTransmissionFactor", "the diffuse transmission"},
    {"KHR_materials_specular", "specularTexture", "the texture of the specular factor"},
    {"KHR_materials_specular", "specularColorTexture", "the texture of the specular colour"},
    {"KHR_materials_transmission", "transmissionTexture", "the texture of the transmission"},
};

/* A number, or one of an array, that is not 0; or a texture. */
static bool counts(const struct json *value)
{
    if (!value || value->kind == JSON_NUMBER)
        return value && value->number != 0;
    for (size_t i = 0; value->kind == JSON_ARRAY && i < value->count; i++)
        if (counts(json_element(value, i)))
            return true;
    return value->kind == JSON_OBJECT;
}

static void omit_rest(struct mesh_job *job, const struct aiMaterial *source,
                      const struct json *extras, const struct pbr *pbr, const char *name)
{
    for (size_t i = 0; i < sizeof left_out / sizeof left_out[0]; i++) {
        const struct json *extension = mesh_gltf_extension(extras, left_out[i].extension);
        if (counts(json_member(extension, left_out[i].member)))
            mesh_material_omit(job, left_out[i].what, name);
    }
    if (pbr->transmission > 0 && pbr->transmission < 0.5)
        mesh_material_omit(job, "the transmission, which is below 1/2,", name);
    if (extras)
        return;
    if (mesh_material_number(source, "$mat.clearcoat.factor", 0) > 0)
        mesh_material_omit(job, "the clearcoat", name);
    if (ps_rgb_maximum(mesh_material_color(source, "$clr.sheen.factor", mesh_grey(0))) > 0)
        mesh_material_omit(job, "the sheen", name);
}

ps_result mesh_material_read_gltf(struct mesh_job *job, const struct aiMaterial *source,
                                  const struct json *extras, const char *name, size_t *index)
{
    struct pbr pbr = read_pbr(job, source, extras, name);
    struct material_description material = mesh_material_white(job->request->origin);
    omit_rest(job, source, extras, &pbr, name);
    ps_result result = read_surface(job, source, extras, &material);
    if (result == PS_OK && mesh_gltf_extension(extras, "KHR_materials_pbrSpecularGlossiness"))
        return mesh_material_read_glossiness(job, source, extras, &material, name, index);
    if (result == PS_OK)
        result = read_base(job, source, extras, &pbr, &material);
    return result == PS_OK ? add_kind(job, source, extras, &pbr, &material, name, index) : result;
}
