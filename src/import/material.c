/* material.c: which of assimp's materials count, and what all kinds share. */
#include "import/material.h"

#include "import/steps.h"
#include "import/text.h"
#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- reading
 * -------------------------------------------------------------------------------------- */

double mesh_material_number(const struct aiMaterial *source, const char *key, double fallback)
{
    float value;
    unsigned count = 1;
    if (aiGetMaterialFloatArray(source, key, 0, 0, &value, &count) != aiReturn_SUCCESS ||
        count != 1 || !isfinite(value))
        return fallback;
    return value;
}

static float sound(float value)
{
    return isfinite(value) && value > 0 ? value : 0;
}

ps_rgb mesh_material_color(const struct aiMaterial *source, const char *key, ps_rgb fallback)
{
    struct aiColor4D color;
    if (aiGetMaterialColor(source, key, 0, 0, &color) != aiReturn_SUCCESS)
        return fallback;
    return (ps_rgb){sound(color.r), sound(color.g), sound(color.b)};
}

/* --- writing
 * -------------------------------------------------------------------------------------- */

struct material_description mesh_material_white(struct origin origin)
{
    return (struct material_description){
        .kind = MATERIAL_DIFFUSE,
        .color = mesh_pigment(mesh_grey(1)),
        .specular = mesh_pigment(mesh_grey(0)),
        .roughness = mesh_pigment(mesh_grey(0)),
        .ior = 1.5,
        .emission = mesh_pigment(mesh_grey(0)),
        .opacity = mesh_pigment(mesh_grey(1)),
        .bump = mesh_pigment(mesh_grey(0)),
        .normal_map = mesh_pigment(mesh_grey(1)),
        .share = mesh_pigment(mesh_grey(1)),
        .origin = origin,
    };
}

struct material_description mesh_material_plain(struct origin origin)
{
    struct material_description plain = mesh_material_white(origin);
    plain.color = mesh_pigment(mesh_grey(MESH_PLAIN_REFLECTANCE));
    return plain;
}

static char *make_name(const char *name, const char *part)
{
    size_t size = strlen(name) + (part ? strlen(part) + 1 : 0) + 1;
    char *made = malloc(size);
    if (made)
        snprintf(made, size, "%s%s%s", name, part ? ":" : "", part ? part : "");
    return made;
}

ps_result mesh_material_add(struct mesh_job *job, const struct material_description *material,
                            const char *name, const char *part, size_t *index)
{
    struct scene_description *fragment = job->fragment;
    char *made = make_name(name, part);
    if (!made)
        return mesh_out_of_memory(job, strlen(name));
    *index = fragment->material_count++;
    fragment->materials[*index] = *material;
    fragment->materials[*index].name = made;
    return PS_OK;
}

static ps_result fill_mix(struct mesh_job *job, const struct mesh_share shares[2],
                          const size_t parts[2], struct material_description *mix)
{
    mix->components = malloc(2 * sizeof *mix->components);
    mix->weights = malloc(2 * sizeof *mix->weights);
    mix->component_count = 2;
    if (!mix->components || !mix->weights)
        return mesh_out_of_memory(job, 2 * sizeof *mix->weights);
    for (int i = 0; i < 2; i++) {
        mix->components[i] = parts[i];
        mix->weights[i] = shares[i].weight;
    }
    return PS_OK;
}

ps_result mesh_material_add_mix(struct mesh_job *job, const struct mesh_share shares[2],
                                const struct pigment_description *varying, const char *name,
                                size_t *index)
{
    size_t parts[2] = {0, 0};
    ps_result result = PS_OK;
    for (int i = 0; result == PS_OK && i < 2; i++) {
        struct material_description part = *shares[i].material;
        part.emission = mesh_pigment(mesh_grey(0));
        part.opacity = mesh_pigment(mesh_grey(1));
        part.blended = false;
        result = mesh_material_add(job, &part, name, shares[i].part, &parts[i]);
    }
    struct material_description mix = *shares[0].material;
    mix.kind = MATERIAL_MIX;
    mix.color = mesh_pigment(mesh_grey(1));
    mix.varying = varying != NULL;
    if (varying)
        mix.share = *varying;
    if (result == PS_OK)
        result = mesh_material_add(job, &mix, name, NULL, index);
    if (result == PS_OK)
        result = fill_mix(job, shares, parts, &job->fragment->materials[*index]);
    return result;
}

/* --- what is left out
 * ----------------------------------------------------------------------------- */

void mesh_material_omit(struct mesh_job *job, const char *what, const char *name)
{
    size_t i = 0;
    while (i < MESH_OMISSIONS && job->omissions[i].what &&
           strcmp(job->omissions[i].what, what) != 0)
        i++;
    assert(i < MESH_OMISSIONS);
    struct mesh_omission *omission = &job->omissions[i];
    char cut[sizeof omission->last];
    snprintf(cut, sizeof cut, "%s", name);
    if (omission->count > 0 && strcmp(omission->last, cut) == 0)
        return; /* of the same material */
    if (omission->count++ == 0) {
        omission->what = what;
        memcpy(omission->material, cut, sizeof cut);
    }
    memcpy(omission->last, cut, sizeof cut);
}

ps_rgb mesh_reflectance(struct mesh_job *job, ps_rgb color, const char *name)
{
    if (ps_rgb_maximum(color) > 1)
        mesh_material_omit(job, "what is above 1 in the reflectance", name);
    return (ps_rgb){fminf(color.r, 1), fminf(color.g, 1), fminf(color.b, 1)};
}

void mesh_note_omissions(struct mesh_job *job)
{
    for (size_t i = 0; i < MESH_OMISSIONS && job->omissions[i].what; i++) {
        const struct mesh_omission *omission = &job->omissions[i];
        if (omission->count > 1)
            mesh_note(job->report, "%s of material %s and %zu more is left out", omission->what,
                      omission->material, omission->count - 1);
        else
            mesh_note(job->report, "%s of material %s is left out", omission->what,
                      omission->material);
    }
}

/* --- all of them
 * --------------------------------------------------------------------------------- */

/* A nameless one gets a number for its name, and false. */
static bool read_name(const struct mesh_job *job, unsigned index, struct aiString *name)
{
    const struct aiMaterial *source = job->scene->mMaterials[index];
    if (aiGetMaterialString(source, AI_MATKEY_NAME, name) != aiReturn_SUCCESS || !name->data[0]) {
        snprintf(name->data, sizeof name->data, "material %u", index + 1);
        return false;
    }
    name->data[sizeof name->data - 1] = '\0';
    return true;
}

/* assimp adds materials of its own: a default one, in some formats without a name, and for OBJ one
 * for each name that the library lacks. */
static bool is_of_the_file(struct mesh_job *job, unsigned index, const char *name, bool has_name)
{
    bool is_default = !has_name || strcmp(name, AI_DEFAULT_MATERIAL_NAME) == 0 ||
                      strcmp(name, "%%%DEFAULT") == 0; /* that of 3DS */
    if (job->gltf.root)
        return index < job->gltf.material_count;
    if (job->format == FORMAT_PLY)
        return mesh_texture_is_named(job->scene->mMaterials[index], aiTextureType_DIFFUSE);
    if (job->format != FORMAT_OBJ)
        return !is_default;
    if (job->library && mtl_has_material(job->library, name))
        return true;
    if (!is_default)
        mesh_note(job->report,
                  job->library ? "its library lacks material %.100s"
                               : "there is no library for material %.100s",
                  name);
    return false;
}

/* Not among assimp's keys by that name for OBJ: whether the file speaks of roughness itself. */
static bool is_physically_based(const struct mesh_job *job, const struct aiMaterial *source)
{
    return job->gltf.root || mesh_material_number(source, "$mat.roughnessFactor", -1) >= 0 ||
           mesh_material_number(source, "$mat.metallicFactor", -1) >= 0;
}

/* Its name alone, by which the scene may put another in its place. */
static ps_result add_absent(struct mesh_job *job, const char *name, size_t *index)
{
    struct material_description absent = mesh_material_white(job->request->origin);
    absent.kind = MATERIAL_MIX;
    return mesh_material_add(job, &absent, name, NULL, index);
}

static ps_result read_material(struct mesh_job *job, unsigned index)
{
    const struct aiMaterial *source = job->scene->mMaterials[index];
    struct aiString name;
    bool has_name = read_name(job, index, &name);
    if (!is_of_the_file(job, index, name.data, has_name))
        return job->format == FORMAT_OBJ && has_name &&
                       strcmp(name.data, AI_DEFAULT_MATERIAL_NAME) != 0
                   ? add_absent(job, name.data, &job->materials[index])
                   : PS_OK;
    if (is_physically_based(job, source))
        return mesh_material_read_gltf(job, source,
                                       job->gltf.root ? job->gltf.materials[index] : NULL,
                                       name.data, &job->materials[index]);
    return mesh_material_read_mtl(job, source, name.data, &job->materials[index]);
}

ps_result mesh_read_materials(struct mesh_job *job)
{
    size_t count = job->scene->mNumMaterials;
    job->materials = malloc((count + 1) * sizeof *job->materials);
    job->fragment->materials =
        calloc(MESH_MATERIAL_PARTS * count + 1, sizeof *job->fragment->materials); /* 1: painted */
    if (!job->materials || !job->fragment->materials)
        return mesh_out_of_memory(job, count * sizeof *job->fragment->materials);
    for (size_t i = 0; i < count; i++)
        job->materials[i] = NO_INDEX;
    if (job->gltf.root && count != job->gltf.material_count + 1)
        return error_set(job->error, PS_ERROR_INVALID, "%s: not all of the materials were read",
                         job->request->path);
    ps_result result = PS_OK;
    for (unsigned i = 0; result == PS_OK && job->request->materials && i < count; i++)
        result = read_material(job, i);
    return result;
}
