/* material_glossiness.c: KHR_materials_pbrSpecularGlossiness, which files made before 2021 have.
 *
 * A coat that reflects specularFactor at normal incidence over diffuseFactor; its roughness is
 * 1 - glossiness. The texture of both has the one in its colours and the other in alpha.
 */
#include "import/material_gltf.h"

static double read_alpha(const struct json *glossiness)
{
    const struct json *alpha = json_element(json_member(glossiness, "diffuseFactor"), 3);
    double value = alpha && alpha->kind == JSON_NUMBER ? alpha->number : 1;
    return fmin(fmax(value, 0), 1);
}

static ps_result read_diffuse(struct mesh_job *job, const struct aiMaterial *source,
                              const struct json *extras, const struct json *glossiness,
                              const char *name, struct material_description *material)
{
    const struct mesh_texture_use use = {aiTextureType_DIFFUSE, CHANNEL_RGB, ENCODING_AUTO,
                                         json_member(glossiness, "diffuseTexture")};
    ps_rgb color = mesh_json_color(glossiness, "diffuseFactor", mesh_grey(1));
    material->color = mesh_pigment(mesh_reflectance(job, color, name));
    if (!use.info) /* assimp's would be that of the other way */
        return mesh_gltf_opacity(job, source, (struct mesh_texture_use){.type = aiTextureType_NONE},
                                 extras, read_alpha(glossiness), material);
    ps_result result = mesh_pigment_texture(job, source, use, &material->color);
    return result == PS_OK
               ? mesh_gltf_opacity(job, source, use, extras, read_alpha(glossiness), material)
               : result;
}

static ps_result read_coat(struct mesh_job *job, const struct aiMaterial *source,
                           const struct json *glossiness, const char *name,
                           struct material_description *material)
{
    struct mesh_texture_use use = {aiTextureType_SPECULAR, CHANNEL_RGB, ENCODING_AUTO,
                                   json_member(glossiness, "specularGlossinessTexture")};
    double factor = fmin(fmax(json_number(glossiness, "glossinessFactor", 1), 0), 1);
    ps_rgb specular = mesh_json_color(glossiness, "specularFactor", mesh_grey(1));
    material->kind = MATERIAL_GLOSSY;
    material->specular = mesh_pigment(mesh_reflectance(job, specular, name));
    material->roughness = mesh_pigment(mesh_grey(1 - factor));
    struct pigment_description rough = mesh_pigment(mesh_grey(factor));
    rough.complement = true;
    if (!use.info)
        return PS_OK;
    ps_result result = mesh_pigment_texture(job, source, use, &material->specular);
    use.channel = CHANNEL_A;
    if (result == PS_OK)
        result = mesh_pigment_texture(job, source, use, &rough);
    if (result == PS_OK && rough.kind == PIGMENT_IMAGE)
        material->roughness = rough;
    return result;
}

ps_result mesh_material_read_glossiness(struct mesh_job *job, const struct aiMaterial *source,
                                        const struct json *extras,
                                        const struct material_description *surface,
                                        const char *name, size_t *index)
{
    const struct json *glossiness =
        mesh_gltf_extension(extras, "KHR_materials_pbrSpecularGlossiness");
    struct material_description material = *surface;
    ps_result result = read_diffuse(job, source, extras, glossiness, name, &material);
    if (result == PS_OK && !job->request->diffuse_only)
        result = read_coat(job, source, glossiness, name, &material);
    return result == PS_OK ? mesh_material_add(job, &material, name, NULL, index) : result;
}
