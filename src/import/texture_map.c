/* texture_map.c: how a picture lies on its surface.
 *
 * glTF's own words are read from its JSON (textureInfo.texCoord and KHR_texture_transform): assimp
 * turns pictures the wrong way. With v downwards, as glTF has it, and angle a, the picture is
 * looked up at
 *
 *     u' = offset_u + scale_u cos(a) u + scale_v sin(a) v
 *     v' = offset_v - scale_u sin(a) u + scale_v cos(a) v
 *
 * which is what Blender writes and reads. (The GLSL in the extension's text turns the other way.)
 * For other formats assimp's transform counts: scale, turn about the middle, move, with v upwards.
 */
#include "import/material.h"

#define SETS 2

static void choose_set(struct mesh_job *job, size_t set, struct pigment_description *pigment)
{
    pigment->uv_set = set == 1;
    if (set >= SETS && !job->third_uv)
        mesh_note(job->report,
                  "a texture by a third set of coordinates, or one beyond, is laid by the first");
    job->third_uv |= set >= SETS;
}

/* --- glTF
 * ------------------------------------------------------------------------------------------ */

static double number_at(const struct json *array, size_t index, double fallback)
{
    const struct json *number = json_element(array, index);
    return number && number->kind == JSON_NUMBER && isfinite(number->number) ? number->number
                                                                             : fallback;
}

static void map_by_gltf(struct mesh_job *job, const struct json *info,
                        struct pigment_description *pigment)
{
    const struct json *transform =
        json_member(json_member(info, "extensions"), "KHR_texture_transform");
    const struct json *offset = json_member(transform, "offset");
    const struct json *scale = json_member(transform, "scale");
    size_t set;
    if (!json_size(info, "texCoord", 0, &set))
        set = 0;
    if (!json_size(transform, "texCoord", set, &set))
        set = 0;
    choose_set(job, set, pigment);
    double angle = json_number(transform, "rotation", 0);
    double u = number_at(scale, 0, 1), v = number_at(scale, 1, 1);
    /* With v upwards: 1 - v for v, and 1 - v' for v'. */
    pigment->scale_u = u * cos(angle);
    pigment->cross_u = -v * sin(angle);
    pigment->offset_u = number_at(offset, 0, 0) + v * sin(angle);
    pigment->cross_v = u * sin(angle);
    pigment->scale_v = v * cos(angle);
    pigment->offset_v = 1 - number_at(offset, 1, 0) - v * cos(angle);
}

/* --- others
 * ---------------------------------------------------------------------------------------- */

static size_t read_set(const struct aiMaterial *source, enum aiTextureType type)
{
    int set;
    unsigned count = 1;
    if (aiGetMaterialIntegerArray(source, AI_MATKEY_UVWSRC(type, 0), &set, &count) !=
            aiReturn_SUCCESS ||
        set < 0)
        return 0;
    return (size_t)set;
}

static void map_by_assimp(struct mesh_job *job, const struct aiMaterial *source,
                          enum aiTextureType type, struct pigment_description *pigment)
{
    enum { TRANSLATE_U, TRANSLATE_V, SCALE_U, SCALE_V, ROTATION, COUNT };
    float values[COUNT] = {0};
    unsigned count = COUNT;
    choose_set(job, read_set(source, type), pigment);
    if (aiGetMaterialFloatArray(source, AI_MATKEY_UVTRANSFORM(type, 0), values, &count) !=
            aiReturn_SUCCESS ||
        count != COUNT)
        return;
    for (int i = 0; i < COUNT; i++)
        if (!isfinite(values[i]))
            return;
    double c = cos((double)values[ROTATION]), s = sin((double)values[ROTATION]);
    pigment->scale_u = values[SCALE_U] * c;
    pigment->cross_u = -values[SCALE_V] * s;
    pigment->cross_v = values[SCALE_U] * s;
    pigment->scale_v = values[SCALE_V] * c;
    pigment->offset_u = values[TRANSLATE_U] + 0.5 - 0.5 * (c - s);
    pigment->offset_v = values[TRANSLATE_V] + 0.5 - 0.5 * (c + s);
}

void mesh_map_texture(struct mesh_job *job, const struct aiMaterial *source,
                      struct mesh_texture_use use, struct pigment_description *pigment)
{
    if (use.info)
        map_by_gltf(job, use.info, pigment);
    else
        map_by_assimp(job, source, use.type, pigment);
}
