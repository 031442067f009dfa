/* texture.c: pictures that materials name, beside the mesh or inside of it.
 *
 * A path is tried as it stands, from the mesh file's folder; then with %20 and the like decoded, as
 * glTF's are; then by its last part alone, since many exporters write paths of their own machine;
 * then both without regard to letter case, which counts for nothing where many exporters run.
 */
#include "import/material.h"

#include "base/path.h"
#include "image/raster.h"
#include "import/steps.h"
#include "import/text.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST_PATH 4096
#define GL_NEAREST 9728

struct pigment_description mesh_pigment(ps_rgb color)
{
    return (struct pigment_description){
        .kind = PIGMENT_COLOR,
        .colors = {color},
        .texture = NO_INDEX,
        .channel = CHANNEL_RGB,
        .scale_u = 1,
        .scale_v = 1,
        .placement = AFFINE_IDENTITY,
        .octaves = 1,
    };
}

/* --- where the picture is --------------------------------------------------------------------- */

static bool read_name(const struct aiMaterial *source, enum aiTextureType type,
                      struct aiString *name)
{
    if (aiGetMaterialString(source, AI_MATKEY_TEXTURE(type, 0), name) != aiReturn_SUCCESS)
        return false;
    name->data[sizeof name->data - 1] = '\0';
    return name->data[0] != '\0';
}

bool mesh_texture_is_named(const struct aiMaterial *source, enum aiTextureType type)
{
    struct aiString name;
    return read_name(source, type, &name);
}

/* From the mesh file's folder, whose length `folder` becomes. */
static bool make_path(const struct mesh_job *job, const char *name, char *path, size_t *folder)
{
    const char *mesh = job->request->path;
    *folder = name[0] == '/' ? 0 : (size_t)(path_name(mesh) - mesh);
    int length = snprintf(path, LONGEST_PATH, "%.*s%s", (int)*folder, mesh, name);
    return length > 0 && length < LONGEST_PATH;
}

static bool try_path(struct mesh_job *job, const char *name, char *path)
{
    size_t folder;
    return make_path(job, name, path, &folder) && mesh_files_exist(&job->files, path);
}

/* Of absolute paths only the last part is looked for. */
static bool try_other_case(struct mesh_job *job, const char *name, char *path)
{
    size_t folder;
    return name[0] != '/' && make_path(job, name, path, &folder) &&
           mesh_files_match_case(&job->files, path, folder);
}

enum found { FOUND_NOTHING, FOUND, FOUND_IN_OTHER_CASE };

static enum found find_path(struct mesh_job *job, char *name, char *path)
{
    for (char *c = name; *c; c++)
        if (*c == '\\')
            *c = '/';
    while (strncmp(name, "./", 2) == 0)
        name += 2;
    if (try_path(job, name, path))
        return FOUND;
    mesh_decode_percent(name);
    if (try_path(job, name, path) || try_path(job, path_name(name), path))
        return FOUND;
    if (try_other_case(job, name, path) || try_other_case(job, path_name(name), path))
        return FOUND_IN_OTHER_CASE;
    return FOUND_NOTHING;
}

/* "*3" is the third of those inside of the file; some formats name them by their file's name. */
static const struct aiTexture *find_embedded(const struct aiScene *scene, const char *name)
{
    if (name[0] == '*') {
        char *end;
        unsigned long index = strtoul(name + 1, &end, 10);
        return end > name + 1 && *end == '\0' && index < scene->mNumTextures
                   ? scene->mTextures[index]
                   : NULL;
    }
    for (unsigned i = 0; i < scene->mNumTextures; i++) {
        const struct aiTexture *texture = scene->mTextures[i];
        if (texture && texture->mFilename.length > 0 &&
            strcmp(path_name(texture->mFilename.data), path_name(name)) == 0)
            return texture;
    }
    return NULL;
}

/* --- the texture
 * -------------------------------------------------------------------------------- */

static int read_integer(const struct aiMaterial *source, const char *key, enum aiTextureType type,
                        int fallback)
{
    int value;
    unsigned count = 1;
    if (aiGetMaterialIntegerArray(source, key, type, 0, &value, &count) != aiReturn_SUCCESS)
        return fallback;
    return value;
}

static enum texture_wrap read_wrap(const struct aiMaterial *source, const char *key,
                                   enum aiTextureType type)
{
    switch (read_integer(source, key, type, aiTextureMapMode_Wrap)) {
    case aiTextureMapMode_Clamp:
    case aiTextureMapMode_Decal:
        return WRAP_CLAMP;
    case aiTextureMapMode_Mirror:
        return WRAP_MIRROR;
    default:
        return WRAP_REPEAT;
    }
}

static bool is_same(const struct texture_description *a, const struct texture_description *b)
{
    return strcmp(a->path, b->path) == 0 && a->wrap_u == b->wrap_u && a->wrap_v == b->wrap_v &&
           a->encoding == b->encoding && a->nearest == b->nearest;
}

static void release_texture(struct texture_description *texture)
{
    free(texture->path);
    free(texture->bytes);
    texture->path = NULL;
    texture->bytes = NULL;
}

/* Takes over what `texture` owns. */
static ps_result add_texture(struct mesh_job *job, struct texture_description *texture,
                             size_t *index)
{
    struct scene_description *fragment = job->fragment;
    size_t bytes = (fragment->texture_count + 1) * sizeof *fragment->textures;
    for (*index = 0; *index < fragment->texture_count; ++*index)
        if (is_same(&fragment->textures[*index], texture)) {
            release_texture(texture);
            return PS_OK;
        }
    struct texture_description *textures = realloc(fragment->textures, bytes);
    if (!textures) {
        release_texture(texture);
        return mesh_out_of_memory(job, bytes);
    }
    fragment->textures = textures;
    textures[fragment->texture_count++] = *texture;
    return PS_OK;
}

static ps_result copy_embedded(struct mesh_job *job, const struct aiTexture *embedded,
                               const char *name, struct texture_description *texture)
{
    char path[LONGEST_PATH];
    snprintf(path, sizeof path, "%s:%s", job->request->path, name);
    texture->path = strdup(path);
    texture->byte_count = embedded->mWidth;
    texture->bytes = malloc(texture->byte_count);
    if (!texture->path || !texture->bytes) {
        release_texture(texture);
        return mesh_out_of_memory(job, texture->byte_count);
    }
    memcpy(texture->bytes, embedded->pcData, texture->byte_count);
    return PS_OK;
}

/* Whether the name is new among these, to which it is added. */
static ps_result remember(struct mesh_job *job, struct mesh_names *names, const char *name,
                          bool *is_new)
{
    size_t bytes = (names->count + 1) * sizeof *names->names;
    *is_new = false;
    for (size_t i = 0; i < names->count; i++)
        if (strcmp(names->names[i], name) == 0)
            return PS_OK;
    char **longer = realloc(names->names, bytes);
    if (!longer)
        return mesh_out_of_memory(job, bytes);
    names->names = longer;
    longer[names->count] = strdup(name);
    if (!longer[names->count])
        return mesh_out_of_memory(job, strlen(name));
    names->count++;
    *is_new = true;
    return PS_OK;
}

static ps_result count_missing(struct mesh_job *job, const char *name)
{
    struct mesh_report *report = job->report;
    char *end = report->missing_names + strlen(report->missing_names);
    size_t room = sizeof report->missing_names - (size_t)(end - report->missing_names);
    bool is_new;
    ps_result result = remember(job, &job->lost, name, &is_new);
    if (is_new && report->missing_textures++ < MESH_MISSING_NAMES)
        snprintf(end, room, "%s%.*s", *report->missing_names ? ", " : "", MESH_MISSING_LENGTH,
                 name);
    return result;
}

static ps_result count_unknown(struct mesh_job *job, const char *name, const unsigned char *start,
                               size_t size)
{
    bool is_new;
    ps_result result = remember(job, &job->lost, name, &is_new);
    if (is_new && job->unknown_textures++ == 0) {
        snprintf(job->unknown_name, sizeof job->unknown_name, "%.*s", MESH_MISSING_LENGTH, name);
        job->unknown_kind = raster_unread_kind(start, size);
    }
    return result;
}

void mesh_note_textures(struct mesh_job *job)
{
    const char *kind = job->unknown_kind ? job->unknown_kind : "of an unknown kind";
    if (job->unknown_textures == 1)
        mesh_note(job->report, "texture %s is left out: it is %s (%s are read)", job->unknown_name,
                  kind, raster_kinds);
    else if (job->unknown_textures > 1)
        mesh_note(job->report, "texture %s, which is %s, and %zu more are left out (%s are read)",
                  job->unknown_name, kind, job->unknown_textures - 1, raster_kinds);
    const struct mesh_names *other = &job->other_case;
    if (other->count > 0)
        mesh_note(job->report, "%zu texture%s found under a name of other letter case (%.*s)",
                  other->count, other->count > 1 ? "s are" : " is", MESH_MISSING_LENGTH,
                  other->names[0]);
}

static ps_result locate_inside(struct mesh_job *job, const struct aiTexture *embedded,
                               const char *name, struct texture_description *texture)
{
    bool is_file = embedded->mHeight == 0 && embedded->mWidth > 0 && embedded->pcData;
    if (!is_file)
        return count_missing(job, name);
    if (!raster_is_known((const unsigned char *)embedded->pcData, embedded->mWidth))
        return count_unknown(job, name, (const unsigned char *)embedded->pcData, embedded->mWidth);
    return copy_embedded(job, embedded, name, texture);
}

static ps_result locate(struct mesh_job *job, char *name, struct texture_description *texture)
{
    const struct aiTexture *embedded = find_embedded(job->scene, name);
    char path[LONGEST_PATH];
    unsigned char start[RASTER_MAGIC];
    if (embedded)
        return locate_inside(job, embedded, name, texture);
    bool is_new;
    enum found found = name[0] == '*' ? FOUND_NOTHING : find_path(job, name, path);
    if (found == FOUND_NOTHING)
        return count_missing(job, name);
    if (found == FOUND_IN_OTHER_CASE && remember(job, &job->other_case, name, &is_new) != PS_OK)
        return PS_ERROR_MEMORY;
    size_t size = mesh_files_peek(&job->files, path, start, sizeof start);
    if (!raster_is_known(start, size))
        return count_unknown(job, name, start, size);
    texture->path = strdup(path);
    return texture->path ? PS_OK : mesh_out_of_memory(job, strlen(path));
}

/* Its index, or NO_INDEX. */
static ps_result find_texture(struct mesh_job *job, const struct aiMaterial *source,
                              struct mesh_texture_use use, size_t *index)
{
    struct aiString name;
    *index = NO_INDEX;
    if (!read_name(source, use.type, &name))
        return PS_OK;
    struct texture_description texture = {
        .wrap_u = read_wrap(source, _AI_MATKEY_MAPPINGMODE_U_BASE, use.type),
        .wrap_v = read_wrap(source, _AI_MATKEY_MAPPINGMODE_V_BASE, use.type),
        .encoding = use.encoding,
        .nearest = read_integer(source, "$tex.mappingfiltermag", use.type, 0) == GL_NEAREST,
        .origin = job->request->origin,
    };
    ps_result result = locate(job, name.data, &texture);
    if (texture.bytes && use.encoding == ENCODING_AUTO)
        texture.encoding = ENCODING_SRGB; /* its path has no extension to go by */
    if (result != PS_OK || !texture.path)
        return result;
    return add_texture(job, &texture, index);
}

/* --- the pigment
 * -------------------------------------------------------------------------------- */

ps_result mesh_pigment_texture(struct mesh_job *job, const struct aiMaterial *source,
                               struct mesh_texture_use use, struct pigment_description *pigment)
{
    size_t texture;
    ps_result result = find_texture(job, source, use, &texture);
    if (result != PS_OK || texture == NO_INDEX)
        return result;
    pigment->kind = PIGMENT_IMAGE;
    pigment->texture = texture;
    pigment->channel = use.channel;
    mesh_map_texture(job, source, use, pigment);
    return PS_OK;
}
