/* material_mtl.c: Wavefront's MTL, and what other formats say in its words.
 *
 * Kd diffuse, Ks specular, Ns the exponent of Phong's lobe, Ni index of refraction, d opacity, Tf
 * what passes, Ke emission, illum which of them count:
 *
 *     4, 6, 7, 9                       glass of index Ni that lets Tf pass from one side to the
 *                                      other
 *     3, 5, 8                          a mirror of reflectance Ks, over Kd where that is not black
 *     2 (and other formats' specular)  Kd under a coat that reflects Ks at normal incidence
 *     0, 1                             Kd
 *
 * The coat's roughness is that of the GGX lobe as wide as Phong's: alpha = sqrt(2 / (Ns + 2))
 * (Walter et al. 2007, "Microfacet models for refraction", for Beckmann; near enough for GGX), and
 * roughness = sqrt(alpha). Colours are linear, or codes of sRGB where the scene says so: MTL does
 * not say. Ke is radiance, and linear in any case.
 */
#include "image/tonemap.h"
#include "import/material.h"

#include <string.h>

/* Below this, beside a mirror, Kd is the "almost black" that exporters like, and counts as
 * black. */
#define ALMOST_BLACK 0.02f

struct mtl {
    ps_rgb diffuse, specular, emission, filter;
    double exponent, ior, opacity;
    int illumination;
};

/* --- reading
 * -------------------------------------------------------------------------------------- */

/* Formats other than OBJ have no illum: gloss counts where there is some. */
static int read_illumination(const struct mesh_job *job, const struct aiMaterial *source,
                             const struct mtl *mtl)
{
    if (job->format == FORMAT_OBJ)
        return (int)mesh_material_number(source, "$mat.illum", 1);
    return mtl->exponent > 0 ? 2 : 1;
}

static ps_rgb read_reflectance(const struct mesh_job *job, const struct aiMaterial *source,
                               const char *key, double fallback)
{
    ps_rgb color = mesh_material_color(source, key, mesh_grey(fallback));
    if (job->request->srgb_colors)
        color =
            (ps_rgb){(float)tonemap_linear((double)color.r), (float)tonemap_linear((double)color.g),
                     (float)tonemap_linear((double)color.b)};
    return color;
}

static struct mtl read_mtl(const struct mesh_job *job, const struct aiMaterial *source)
{
    struct mtl mtl = {
        .diffuse = read_reflectance(job, source, "$clr.diffuse", 0.6),
        .specular = read_reflectance(job, source, "$clr.specular", 0),
        .emission = mesh_material_color(source, "$clr.emissive", mesh_grey(0)),
        .filter = read_reflectance(job, source, "$clr.transparent", 1),
        .exponent = fmax(0, mesh_material_number(source, "$mat.shininess", 0)),
        .ior = mesh_material_number(source, "$mat.refracti", 1),
        .opacity = mesh_material_number(source, "$mat.opacity", 1),
    };
    mtl.illumination = read_illumination(job, source, &mtl);
    return mtl;
}

static bool is_black(ps_rgb color)
{
    return ps_rgb_maximum(color) <= 0;
}

static bool is_filter(ps_rgb color)
{
    return !is_black(color) && (color.r < 1 || color.g < 1 || color.b < 1);
}

/* Where illum does not say (assimp then gives 1), a filter with an index makes glass. */
static bool is_glass(const struct mesh_job *job, const struct mtl *mtl)
{
    int i = mtl->illumination;
    return i == 4 || i == 6 || i == 7 || i == 9 ||
           (job->format == FORMAT_OBJ && i <= 1 && mtl->ior > 1 && is_filter(mtl->filter));
}

static bool is_mirror(const struct mtl *mtl)
{
    int i = mtl->illumination;
    return (i == 3 || i == 5 || i == 8) && !is_black(mtl->specular);
}

static double roughness_of(double exponent)
{
    return sqrt(sqrt(2 / (exponent + 2)));
}

/* --- textures
 * ------------------------------------------------------------------------------------- */

/* A picture beside a black factor is meant to be seen. */
static ps_result add_picture(struct mesh_job *job, const struct aiMaterial *source,
                             struct mesh_texture_use use, struct pigment_description *pigment)
{
    struct pigment_description image = *pigment;
    if (is_black(image.colors[0]))
        image.colors[0] = mesh_grey(1);
    ps_result result = mesh_pigment_texture(job, source, use, &image);
    if (result == PS_OK && image.kind == PIGMENT_IMAGE)
        *pigment = image;
    return result;
}

/* A picture that is also the colour's is meant by its alpha. */
static ps_result read_opacity(struct mesh_job *job, const struct aiMaterial *source,
                              const struct mtl *mtl, struct material_description *material)
{
    struct aiString color, opacity;
    struct mesh_texture_use use = {aiTextureType_OPACITY, CHANNEL_RGB, ENCODING_LINEAR, NULL};
    material->blended = true;
    material->opacity = mesh_pigment(mesh_grey(fmin(fmax(mtl->opacity, 0), 1)));
    if (aiGetMaterialString(source, AI_MATKEY_TEXTURE_DIFFUSE(0), &color) == aiReturn_SUCCESS &&
        aiGetMaterialString(source, AI_MATKEY_TEXTURE_OPACITY(0), &opacity) == aiReturn_SUCCESS &&
        color.length == opacity.length && strncmp(color.data, opacity.data, color.length) == 0)
        use.channel = CHANNEL_A;
    return add_picture(job, source, use, &material->opacity);
}

static ps_result read_bump(struct mesh_job *job, const struct aiMaterial *source,
                           struct material_description *material)
{
    struct mesh_texture_use height = {aiTextureType_HEIGHT, CHANNEL_RGB, ENCODING_LINEAR, NULL};
    struct mesh_texture_use normal = {aiTextureType_NORMALS, CHANNEL_RGB, ENCODING_LINEAR, NULL};
    float factor = 1;
    unsigned count = 1;
    if (aiGetMaterialFloatArray(source, "$tex.bumpmult", aiTextureType_HEIGHT, 0, &factor,
                                &count) != aiReturn_SUCCESS ||
        !isfinite(factor))
        factor = 1;
    struct pigment_description bump =
        mesh_pigment(mesh_grey(factor * job->scale * job->request->bump_scale));
    ps_result result = PS_OK;
    if (job->request->bump_scale > 0)
        result = mesh_pigment_texture(job, source, height, &bump);
    if (result == PS_OK && bump.kind == PIGMENT_IMAGE)
        material->bump = bump;
    if (result == PS_OK)
        result = mesh_pigment_texture(job, source, normal, &material->normal_map);
    return result;
}

/* What every kind has but its reflection. */
static ps_result read_surface(struct mesh_job *job, const struct aiMaterial *source,
                              const struct mtl *mtl, struct material_description *material,
                              const char *name)
{
    const struct mesh_texture_use diffuse = {aiTextureType_DIFFUSE, CHANNEL_RGB, ENCODING_AUTO,
                                             NULL};
    const struct mesh_texture_use emission = {aiTextureType_EMISSIVE, CHANNEL_RGB, ENCODING_AUTO,
                                              NULL};
    material->color = mesh_pigment(mesh_reflectance(job, mtl->diffuse, name));
    material->emission = mesh_pigment(mtl->emission);
    ps_result result = add_picture(job, source, diffuse, &material->color);
    if (result == PS_OK)
        result = add_picture(job, source, emission, &material->emission);
    if (result == PS_OK && !is_glass(job, mtl))
        result = read_opacity(job, source, mtl, material);
    if (result == PS_OK)
        result = read_bump(job, source, material);
    return result;
}

/* --- kinds
 * ---------------------------------------------------------------------------------------- */

/* A ray passes two surfaces from one side to the other. */
static ps_result add_glass(struct mesh_job *job, const struct mtl *mtl,
                           struct material_description *material, const char *name, size_t *index)
{
    ps_rgb filter = mesh_reflectance(job, mtl->filter, name);
    material->kind = MATERIAL_DIELECTRIC;
    material->color = mesh_pigment((ps_rgb){sqrtf(filter.r), sqrtf(filter.g), sqrtf(filter.b)});
    material->ior = mtl->ior > 1 ? mtl->ior : 1.5;
    return mesh_material_add(job, material, name, NULL, index);
}

/* The mirror takes its Ks of the light and the diffuse part its Kd; where both ask for more than
 * there is, each gets its share. */
static ps_result add_mirror(struct mesh_job *job, const struct mtl *mtl,
                            const struct material_description *diffuse, const char *name,
                            size_t *index)
{
    struct material_description mirror = *diffuse, below = *diffuse;
    ps_rgb specular = mesh_reflectance(job, mtl->specular, name);
    float mirrored = ps_rgb_maximum(specular), scattered = ps_rgb_maximum(diffuse->color.colors[0]);
    mirror.kind = MATERIAL_MIRROR;
    mirror.color = mesh_pigment(specular);
    if (scattered <= ALMOST_BLACK)
        return mesh_material_add(job, &mirror, name, NULL, index);
    float sum = fmaxf(1, mirrored + scattered);
    mirror.color.colors[0] = ps_rgb_scale(specular, 1 / mirrored);
    below.color.colors[0] = ps_rgb_scale(below.color.colors[0], 1 / scattered);
    const struct mesh_share shares[2] = {{&mirror, mirrored / sum, "mirror"},
                                         {&below, scattered / sum, "diffuse"}};
    return mesh_material_add_mix(job, shares, NULL, name, index);
}

static ps_result make_glossy(struct mesh_job *job, const struct aiMaterial *source,
                             const struct mtl *mtl, struct material_description *material,
                             const char *name)
{
    const struct mesh_texture_use use = {aiTextureType_SPECULAR, CHANNEL_RGB, ENCODING_AUTO, NULL};
    material->kind = MATERIAL_GLOSSY;
    material->specular = mesh_pigment(mesh_reflectance(job, mtl->specular, name));
    material->roughness = mesh_pigment(mesh_grey(roughness_of(mtl->exponent)));
    return mesh_pigment_texture(job, source, use, &material->specular);
}

ps_result mesh_material_read_mtl(struct mesh_job *job, const struct aiMaterial *source,
                                 const char *name, size_t *index)
{
    struct mtl mtl = read_mtl(job, source);
    struct material_description material = mesh_material_white(job->request->origin);
    ps_result result = read_surface(job, source, &mtl, &material, name);
    if (result != PS_OK)
        return result;
    if (is_glass(job, &mtl))
        return add_glass(job, &mtl, &material, name, index);
    if (is_mirror(&mtl))
        return add_mirror(job, &mtl, &material, name, index);
    if (mtl.illumination >= 2 && !is_black(mtl.specular) && !job->request->diffuse_only)
        result = make_glossy(job, source, &mtl, &material, name);
    return result == PS_OK ? mesh_material_add(job, &material, name, NULL, index) : result;
}
