/* texture.h: a picture that can be looked up at any (u, v).
 *
 * (0, 0) is the lower left corner of the picture and (1, 1) the upper right one; v goes upwards,
 * while files store their top row first. Texel (i, j), counted from the lower left, has its centre
 * at ((i + 1/2) / width, (j + 1/2) / height). Samples stay in the precision of the file and are
 * decoded through a table when they are looked up, before they are interpolated: averages of sRGB
 * codes are not averages of light.
 */
#ifndef SCENE_TEXTURE_H
#define SCENE_TEXTURE_H

#include "base/error.h"
#include "base/mapped_file.h"
#include "image/raster.h"
#include "scene/description.h"

/* Samples as a raster has them, the top row first; in tiles of 2^tile_shift texels a side, where a
 * file has them, of which the last ones may reach beyond the picture. */
struct texels {
    uint32_t width, height, tiles_across;
    const unsigned char *bytes;
};

#define TEXTURE_LEVELS 17 /* of 65536 texels */

/* Owns texels and tables. Constant once loaded: any number of threads may sample it. */
struct texture {
    uint32_t width, height;
    int32_t wrap_u, wrap_v; /* enum texture_wrap */
    bool nearest;           /* rather than bilinear */
    struct raster raster;   /* without samples where a file of the cache has them */
    uint32_t texel_bytes, tile_shift;
    uint32_t level_count; /* of the picture, half of it, and so on (mip_map.h) */
    struct texels levels[TEXTURE_LEVELS];
    float log_side;             /* binary logarithm of the picture's mean side in texels */
    void *halves;               /* owned: levels after the first, where they lie in memory */
    struct mapped_file *file;   /* that has the texels, or NULL */
    float *color_of, *alpha_of; /* values of codes; NULL for floats; may be the same table */
    bool srgb;                  /* colours carry sRGB's function; the tables undo it */
    bool has_extremes;          /* the following are known */
    float lowest, highest;      /* of colours, undecoded; where samples are halves or floats */
    uint64_t digest;            /* of the samples, row by row; 0: not known */
    bool clipped;               /* some material's reflectances are taken from it, and leave 0..1 */
    char *note;                 /* owned; why it is not kept in the cache, or NULL */
};

/* Where pictures lie. */
struct texture_storage {
    const char *folder;           /* the only one to read them from (input_file.h), or NULL */
    bool mip_maps;                /* whether texture_filter finds more levels than the first */
    const char *cache;            /* with MIP maps: a folder for both (texture_cache.h), or NULL */
    struct mapped_budget *budget; /* of what lies there, where there is a cache */
};

/* Loads what raster_decode can read, or a layer of it. The encoding "auto" takes the colours of
 * OpenEXR and Radiance files for linear, and others for sRGB (IEC 61966-2-1); pictures that hold no
 * colours, such as normal maps, want ENCODING_LINEAR. Alpha is linear, and colours are not divided
 * by it: those of OpenEXR are premultiplied. `storage`: NULL, as if all of it were; its budget
 * outlives the texture. Messages start with the description's path; codes are those of raster_fetch
 * and raster_decode. `texture` is written only on success, and what it held is not released. */
ps_result texture_load(const struct texture_description *description,
                       const struct texture_storage *storage, struct texture *texture,
                       struct error *error);
void texture_release(struct texture *texture);

/* The linear colour and alpha at (u, v), any numbers; grey is three times the same, alpha 1 where
 * the picture has none. NaN counts as 0, and so does what is too large to have a fraction where the
 * picture repeats or is mirrored. */
void texture_sample(const struct texture *texture, float u, float v, float rgba[4]);

/* The same as a mean over a part of the picture whose width, in texture coordinates, has the binary
 * logarithm log_width; -INFINITY: a point. Between the two levels whose texels are about as wide
 * (Williams 1983). */
void texture_filter(const struct texture *texture, float u, float v, float log_width,
                    float rgba[4]);

/* A texel's channels as values, and the number of the one that is alpha, if there are so many. */
void texture_values(const struct texture *texture, const void *samples, float values[4]);
static inline uint32_t texture_alpha(const struct texture *texture)
{
    return texture->raster.channels < 3 ? 1 : 3;
}

/* The colour of one texel: column from the left, row from the bottom; both must exist. */
void texture_texel(const struct texture *texture, uint32_t column, uint32_t row, float rgba[4]);

/* Whether the colours, times a factor of 0 or more, may leave 0..1: integers by their type, floats
 * looked at one by one, once. Not to be called while others sample. */
bool texture_leaves_range(struct texture *texture, float factor);

/* Makes sure that lowest and highest are known where they count; and that they hold for so many
 * more pixels. */
void texture_find_extremes(struct texture *texture);
void texture_widen_extremes(struct texture *texture, const void *samples, size_t pixels);

/* A number that stands for the samples as they were decoded. */
uint64_t texture_digest(const struct texture *texture);

/* Of memory, tables included; not what a file has. */
size_t texture_bytes(const struct texture *texture);

#endif
