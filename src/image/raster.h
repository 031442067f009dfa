/* raster.h: pictures as textures want them: interleaved, in the precision of their file.
 *
 * A colour of an 8-bit picture takes 3 bytes here and 12 as floats, which decides whether large
 * textures fit in memory; so samples stay as they were stored, and whoever reads them decodes them.
 * PNG through libpng, JPEG through libjpeg, OpenEXR through its C interface; TGA, BMP and Radiance
 * HDR through stb_image, and WebP through libwebp, where the build has these. Told apart by their
 * first bytes, since names lie.
 */
#ifndef IMAGE_RASTER_H
#define IMAGE_RASTER_H

#include "base/error.h"

#include <stdbool.h>

#define RASTER_SIDE_LIMIT 65536                /* pixels */
#define RASTER_PIXEL_LIMIT (UINT64_C(1) << 30) /* pixels in all */

enum raster_sample {
    RASTER_BYTE,  /* uint8_t, 255 is 1 */
    RASTER_SHORT, /* uint16_t, 65535 is 1 */
    RASTER_HALF,  /* uint16_t, the bits of a half float */
    RASTER_FLOAT  /* float */
};

/* Owns its samples. Zero-initialise before the first use. */
struct raster {
    uint32_t width, height;
    uint32_t channels; /* 1: grey; 2: grey, alpha; 3: red, green, blue; 4: with alpha */
    enum raster_sample sample;
    bool srgb; /* colours carry the sRGB transfer function, by their type of file; alpha never */
    size_t mended;    /* samples that were NaN or infinite */
    size_t file_size; /* bytes that it was decoded from */
    void *samples;    /* row-major, top row first, native byte order */
};

/* Who takes a picture line by line, the top one first, so that it need not lie in memory as a
 * whole. */
struct raster_lines {
    /* Whether lines of such a picture are wanted, whose samples are not read yet. */
    bool (*want)(void *user, const struct raster *raster);
    /* Takes one; anything but PS_OK ends the reading with that, and with the message. */
    ps_result (*take)(void *user, const void *samples, struct error *error);
    void *user;
};

/* The bytes of a picture's file, to be freed; `folder`: the only one to read from
 * (input_file_open), or NULL. PS_ERROR_IO, _INVALID or _MEMORY; messages start with `path`. Any
 * number of threads. */
ps_result raster_fetch(const char *path, const char *folder, unsigned char **bytes, size_t *size,
                       struct error *error);

/* Reads a picture from the bytes of a file, or of one inside of another.
 *
 * PNG: every colour type and depth, interlaced or not; a palette becomes colours, a transparent
 * colour alpha, 1 to 4 bits become 8. Gamma and colour profiles are ignored. JPEG: grey, YCbCr and
 * RGB, 8 bits; CMYK is refused. Colour profiles and the orientation that EXIF states are ignored.
 * OpenEXR: R, G, B or Y, with A where there is one, other channels are skipped; or, where `layer`
 * is not NULL, those of the layer of that name: R, G and B, or X, Y and Z, or one number, with A
 * (exr_layer.h). Of several parts the first with colours, of several levels the largest; what else
 * image_read_exr refuses is refused here. The picture is the display window, 0 outside of the data;
 * it must not be more than 16 times as large as these. Colours of other primaries (chromaticities)
 * become Rec.709's, with Bradford's adaptation. Colours stay premultiplied by alpha, as the format
 * has them. NaN is read as 0 and infinity as the largest half float, 65504. Samples are half floats
 * where these hold every one. TGA and BMP: grey, palettes and colours of 15 to 32 bits, TGA also in
 * runs; an alpha that is 0 everywhere, of which the header of a TGA says that it is none, is left
 * out. BMP in runs is refused. Radiance: linear floats, as they stand, lines in any order. WebP:
 * one picture, 8 bits.
 *
 * `lines`: who wants it line by line, or NULL. PNG that is not interlaced, JPEG and OpenEXR come
 * so, and leave `raster` without samples; others are whole whoever asks. (Progressive JPEG takes
 * libjpeg six bytes a pixel all the same. OpenEXR of floats is decoded twice where halves hold
 * them, by lines or not.)
 *
 * Other kinds have no layers: PS_ERROR_INVALID. PS_ERROR_IO: the file is truncated or damaged;
 * PS_ERROR_INVALID: no picture of a known kind or size; PS_ERROR_MEMORY. Messages start with
 * `path`. `raster` is written only on success, and what it held is not released: pass an empty one.
 * Any number of threads. */
ps_result raster_decode(const char *path, const char *layer, const unsigned char *bytes,
                        size_t size, const struct raster_lines *lines, struct raster *raster,
                        struct error *error);

/* Whether a file that starts with these bytes, RASTER_MAGIC of them or the whole file, is of a kind
 * that is read. */
#define RASTER_MAGIC 34
bool raster_is_known(const unsigned char *bytes, size_t size);

/* Of such a file that is not read: "KTX2" and the like, or NULL where its kind has no name here. */
const char *raster_unread_kind(const unsigned char *bytes, size_t size);

/* The kinds that this build reads: "PNG, JPEG, OpenEXR, ...". */
extern const char raster_kinds[];

void raster_release(struct raster *raster);

/* Of the samples of one pixel, and of all. */
uint32_t raster_texel_bytes(const struct raster *raster);
size_t raster_bytes(const struct raster *raster);

#endif
