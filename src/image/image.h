/* image.h: pictures in memory and in files.
 *
 * Channels are planes of float, row-major, top row first, named as OpenEXR viewers expect: "R",
 * "direct.R", "N.X", "Z". OpenEXR through its C interface; PNG through libpng. Every file is
 * written under a temporary name beside the target and renamed when whole, so a reader never sees
 * half a picture.
 */
#ifndef IMAGE_IMAGE_H
#define IMAGE_IMAGE_H

#include "base/error.h"
#include "base/parallel.h"
#include "base/rectangle.h"
#include <stdbool.h>

struct image_channel {
    char *name;     /* owned */
    float *samples; /* width * height, owned */
};

struct image_attribute {
    char *name, *value; /* owned; string attributes only */
};

/* Owns everything it points to. Zero-initialise before the first use. */
struct image {
    size_t width, height;
    struct picture_window window; /* zeros: a whole picture */
    struct image_channel *channels;
    size_t channel_count;
    struct image_attribute *attributes;
    size_t attribute_count;
};

void image_release(struct image *image);

/* Appends a channel of zeros; the image's width and height must be set, and no channel have that
 * name. Returns its samples, or NULL when out of memory. */
float *image_add_channel(struct image *image, const char *name);

/* The same with samples that are there already, allocated with malloc: the picture owns them from
 * then on. When out of memory, PS_ERROR_MEMORY, they stay the caller's. */
ps_result image_adopt_channel(struct image *image, const char *name, float *samples,
                              struct error *error);

/* Releases the channels that `keeps` is false of; the others stay in their order. */
void image_keep_channels(struct image *image, bool (*keeps)(const void *user, const char *name),
                         const void *user);

/* Keeps of a plane, `width` samples a row, a rectangle alone, which must lie in it: its rows follow
 * each other then. */
void image_crop_plane(float *samples, size_t width, struct rectangle part);

/* The same of all channels; the window is the smaller picture's. */
void image_crop(struct image *image, struct rectangle part);

/* Appends, or replaces, a string attribute. */
ps_result image_set_attribute(struct image *image, const char *name, const char *value,
                              struct error *error);

/* NULL where there is none. */
const float *image_channel(const struct image *image, const char *name);
const char *image_attribute(const struct image *image, const char *name);

/* How an OpenEXR file holds its samples, always without loss: by deflating 16 lines together or
 * each alone, by run lengths, or as they are. */
enum image_compression { IMAGE_ZIP, IMAGE_ZIPS, IMAGE_RLE, IMAGE_UNCOMPRESSED };

/* The names of these in OpenEXR's words. */
#define IMAGE_COMPRESSIONS "zip, zips, rle, none"
bool image_compression_named(const char *name, enum image_compression *compression);

/* Writes a scan-line OpenEXR, 32-bit float, channels in the alphabetical order that the format
 * demands, string attributes as they stand; the data window is the image, the display window the
 * picture that it lies in. The same image gives the same bytes, whatever the number of workers.
 * Channels' names must differ. */
ps_result image_write_exr(const struct image *image, const char *path,
                          enum image_compression compression, struct workers *workers,
                          struct error *error);

/* Reads a single-part scan-line or tiled (one level) OpenEXR, half, float or uint channels, into
 * floats; the picture is the data window, and `window` says where it lies in a display window that
 * begins at (0, 0) and holds it; elsewhere the data window is all there is. Refuses B44, deep,
 * multi-part, mip-mapped and subsampled files, and sizes that can't be, each with a clear message.
 * `image` is written only on success, and what it held is not released: pass an empty one. */
ps_result image_read_exr(const char *path, struct image *image, struct error *error);

/* `rgb`: width*height*3 bytes, sRGB. `texts`: `text_count` tEXt chunks (iTXt where the value is not
 * ASCII), may be NULL; names of 1 to 79 printable characters. */
ps_result image_write_png(const char *path, size_t width, size_t height, const uint8_t *rgb,
                          const struct image_attribute *texts, size_t text_count,
                          struct error *error);

#endif
