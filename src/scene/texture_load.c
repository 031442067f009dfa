/* texture_load.c: from a picture's file to a texture, in memory or in a file of the cache. */
#include "image/half.h"
#include "image/tonemap.h"
#include "scene/mip_map.h"
#include "scene/texture_cache.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

/* Pictures whose samples take less are decoded faster than they are looked for. */
#define LEAST_IN_CACHE ((size_t)1 << 20)

/* --- tables ---------------------------------------------------------------------------------- */

static size_t code_count(enum raster_sample sample)
{
    return sample == RASTER_BYTE ? UINT8_MAX + 1 : UINT16_MAX + 1;
}

static double code_value(enum raster_sample sample, size_t code)
{
    if (sample == RASTER_HALF)
        return half_to_float((uint16_t)code);
    return (double)code / (double)(code_count(sample) - 1);
}

static float *create_table(enum raster_sample sample, bool srgb)
{
    size_t count = code_count(sample);
    float *table = malloc(count * sizeof *table);
    for (size_t code = 0; table && code < count; code++) {
        double value = code_value(sample, code);
        table[code] = (float)(srgb ? tonemap_linear(value) : value);
    }
    return table;
}

static bool has_alpha(const struct raster *raster)
{
    return raster->channels == 2 || raster->channels == 4;
}

/* Alpha has a table of its own only where it is decoded otherwise than colours are. */
static bool create_tables(struct texture *texture)
{
    enum raster_sample sample = texture->raster.sample;
    bool alpha_differs = texture->srgb && has_alpha(&texture->raster);
    if (sample == RASTER_FLOAT)
        return true;
    texture->color_of = create_table(sample, texture->srgb);
    texture->alpha_of = alpha_differs ? create_table(sample, false) : texture->color_of;
    return texture->color_of && texture->alpha_of;
}

/* --- the texels ------------------------------------------------------------------------------ */

static void refer_to_raster(struct texture *texture)
{
    const struct raster *raster = &texture->raster;
    texture->texel_bytes = raster_texel_bytes(raster);
    texture->levels[0] =
        (struct texels){raster->width, raster->height, raster->width, raster->samples};
    texture->level_count = 1;
}

/* What the picture, and what is said of it, tell of how it is looked up. */
static ps_result prepare(const struct texture_description *description, struct texture *texture,
                         struct error *error)
{
    const struct raster *raster = &texture->raster;
    texture->srgb = description->encoding == ENCODING_SRGB ||
                    (description->encoding == ENCODING_AUTO && raster->srgb);
    texture->width = raster->width;
    texture->height = raster->height;
    texture->log_side = 0.5f * log2f((float)raster->width * (float)raster->height);
    texture->wrap_u = description->wrap_u;
    texture->wrap_v = description->wrap_v;
    texture->nearest = description->nearest;
    if (create_tables(texture))
        return PS_OK;
    return error_set(error, PS_ERROR_MEMORY, "%s: out of memory for a table of colours",
                     description->path);
}

/* --- into the cache -------------------------------------------------------------------------- */

/* A picture that goes into the cache line by line, if it may. */
struct keeping {
    const struct texture_description *description;
    const char *path;      /* of the entry */
    struct texture tables; /* what the entry needs to know of the texture */
    struct texture_entry *entry;
    ps_result result; /* of the entry */
    struct error reason;
};

/* raster_lines.want */
static bool begin_entry(void *user, const struct raster *raster)
{
    struct keeping *keeping = user;
    struct texture *tables = &keeping->tables;
    if (raster_bytes(raster) < LEAST_IN_CACHE)
        return false;
    tables->raster = *raster;
    tables->raster.samples = NULL;
    tables->texel_bytes = raster_texel_bytes(raster);
    keeping->result = prepare(keeping->description, tables, &keeping->reason);
    if (keeping->result == PS_OK)
        keeping->entry = texture_entry_begin(keeping->path, tables, &keeping->reason);
    if (keeping->result == PS_OK && !keeping->entry)
        keeping->result = PS_ERROR_IO;
    return keeping->entry != NULL;
}

/* raster_lines.take */
static ps_result add_to_entry(void *user, const void *samples, struct error *error)
{
    struct keeping *keeping = user;
    keeping->result = texture_entry_add(keeping->entry, samples, &keeping->reason);
    return keeping->result == PS_OK ? PS_OK : error_set(error, keeping->result, "not kept");
}

/* Makes the entry of a picture that did not come line by line. */
static void add_whole(struct keeping *keeping, const struct raster *raster)
{
    const unsigned char *samples = raster->samples;
    size_t bytes = (size_t)raster->width * raster_texel_bytes(raster);
    if (keeping->result != PS_OK || !begin_entry(keeping, raster))
        return;
    for (uint32_t line = 0; line < raster->height && keeping->result == PS_OK; line++)
        keeping->result =
            texture_entry_add(keeping->entry, samples + line * bytes, &keeping->reason);
}

/* Puts the entry in its place, if there is a whole one, and has the texture refer to it. */
static void end_entry(struct keeping *keeping, const struct texture_storage *storage, bool whole,
                      struct texture *texture)
{
    void *samples = texture->raster.samples;
    if (keeping->entry && !(whole && keeping->result == PS_OK)) {
        texture_entry_discard(keeping->entry);
    } else if (keeping->entry) {
        keeping->result =
            texture_entry_end(keeping->entry, texture->raster.mended, &keeping->reason);
        if (keeping->result == PS_OK)
            keeping->result =
                texture_cache_load(keeping->path, storage->budget, texture, &keeping->reason);
        if (keeping->result == PS_OK)
            free(samples);
    }
    texture_release(&keeping->tables);
}

/* Decodes into the cache; or, where that fails, and small pictures, into memory. */
static ps_result decode_for_cache(const struct texture_description *description,
                                  const unsigned char *bytes, size_t size,
                                  const struct texture_storage *storage, const char *path,
                                  struct texture *texture, struct error *error)
{
    struct keeping keeping = {.description = description, .path = path};
    const struct raster_lines lines = {begin_entry, add_to_entry, &keeping};
    ps_result result = raster_decode(description->path, description->layer, bytes, size, &lines,
                                     &texture->raster, error);
    if (result == PS_OK && texture->raster.samples)
        add_whole(&keeping, &texture->raster);
    end_entry(&keeping, storage, result == PS_OK, texture);
    if (keeping.result == PS_OK)
        return result;
    texture->note = strdup(keeping.reason.text);
    if (texture->raster.samples)
        return PS_OK;
    return raster_decode(description->path, description->layer, bytes, size, NULL, &texture->raster,
                         error);
}

static ps_result decode(const struct texture_description *description, const unsigned char *bytes,
                        size_t size, const struct texture_storage *storage, const char *path,
                        struct texture *texture, struct error *error)
{
    struct error ignored;
    if (path && texture_cache_load(path, storage->budget, texture, &ignored) == PS_OK)
        return prepare(description, texture, error);
    ps_result result =
        path ? decode_for_cache(description, bytes, size, storage, path, texture, error)
             : raster_decode(description->path, description->layer, bytes, size, NULL,
                             &texture->raster, error);
    if (result == PS_OK && !texture->file)
        refer_to_raster(texture);
    if (result == PS_OK)
        result = prepare(description, texture, error);
    bool wants_levels = result == PS_OK && storage->mip_maps && mip_map_has_more(texture);
    return wants_levels && !texture->file ? mip_map_add(texture, error) : result;
}

static ps_result fetch_and_decode(const struct texture_description *description,
                                  const struct texture_storage *storage, struct texture *texture,
                                  struct error *error)
{
    unsigned char *fetched = NULL;
    const unsigned char *bytes = description->bytes;
    size_t size = description->byte_count;
    if (!bytes) {
        ps_result result = raster_fetch(description->path, storage->folder, &fetched, &size, error);
        if (result != PS_OK)
            return result;
        bytes = fetched;
    }
    char *path =
        storage->cache ? texture_cache_path(storage->cache, description, bytes, size) : NULL;
    ps_result result = decode(description, bytes, size, storage, path, texture, error);
    free(path);
    free(fetched);
    return result;
}

ps_result texture_load(const struct texture_description *description,
                       const struct texture_storage *storage, struct texture *texture,
                       struct error *error)
{
    static const struct texture_storage anywhere = {.folder = NULL};
    struct texture loaded = {.width = 0};
    ps_result result = fetch_and_decode(description, storage ? storage : &anywhere, &loaded, error);
    if (result == PS_OK)
        *texture = loaded;
    else
        texture_release(&loaded);
    return result;
}

void texture_release(struct texture *texture)
{
    if (texture->alpha_of != texture->color_of)
        free(texture->alpha_of);
    free(texture->color_of);
    free(texture->note);
    free(texture->halves);
    if (texture->file)
        mapped_file_close(texture->file);
    raster_release(&texture->raster);
    *texture = (struct texture){0};
}

size_t texture_bytes(const struct texture *texture)
{
    size_t tables = 0;
    if (texture->color_of) {
        size_t count = texture->alpha_of == texture->color_of ? 1 : 2;
        tables = count * code_count(texture->raster.sample) * sizeof(float);
    }
    size_t texels = 0;
    for (uint32_t i = 0; i < texture->level_count; i++)
        texels += (size_t)texture->levels[i].width * texture->levels[i].height;
    return tables + (texture->file ? 0 : texels * texture->texel_bytes);
}

/* --- of all samples -------------------------------------------------------------------------- */

static float sample_value(const struct raster *raster, const void *samples, size_t i)
{
    return raster->sample == RASTER_HALF ? half_to_float(((const uint16_t *)samples)[i])
                                         : ((const float *)samples)[i];
}

void texture_widen_extremes(struct texture *texture, const void *samples, size_t pixels)
{
    const struct raster *raster = &texture->raster;
    uint32_t colors = raster->channels - has_alpha(raster);
    if (raster->sample == RASTER_BYTE || raster->sample == RASTER_SHORT)
        return;
    if (!texture->has_extremes)
        texture->lowest = texture->highest = sample_value(raster, samples, 0);
    texture->has_extremes = true;
    for (size_t i = 0; i < pixels; i++)
        for (uint32_t channel = 0; channel < colors; channel++) {
            float value = sample_value(raster, samples, i * raster->channels + channel);
            texture->lowest = fminf(texture->lowest, value);
            texture->highest = fmaxf(texture->highest, value);
        }
}

void texture_find_extremes(struct texture *texture)
{
    const struct raster *raster = &texture->raster;
    if (!texture->has_extremes)
        texture_widen_extremes(texture, raster->samples, (size_t)raster->width * raster->height);
}

bool texture_leaves_range(struct texture *texture, float factor)
{
    texture_find_extremes(texture);
    if (!texture->has_extremes)
        return factor > 1.0f;
    float highest = texture->srgb ? (float)tonemap_linear(texture->highest) : texture->highest;
    return texture->lowest < 0.0f || highest * factor > 1.0f;
}

uint64_t texture_digest(const struct texture *texture)
{
    if (texture->digest)
        return texture->digest;
    assert(!texture->file);
    return XXH3_64bits(texture->raster.samples, raster_bytes(&texture->raster));
}
