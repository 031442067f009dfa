/* output.h: writes a rendered picture to the files that were asked for. */
#ifndef SESSION_OUTPUT_H
#define SESSION_OUTPUT_H

#include "base/parallel.h"
#include "image/image.h"
#include "render/settings.h"
#include "session/output_options.h"
#include "session/scene_options.h"

/* Whether a name ends in a format that psplat writes: .exr or .png. */
bool output_is_writable_format(const char *path);

/* Whether files of that name hold layers beside the picture. */
bool output_holds_layers(const char *path);

/* Writes the picture by its name's suffix: an EXR of the layers that the options keep, or a PNG of
 * the layer `display`, which must be there then. The workers change its time, not the file. */
ps_result output_write(const struct image *image, const char *path,
                       const struct output_options *options, struct workers *workers,
                       struct error *error);

/* What a part of the layer `display`, a rectangle of the picture that the image shows, is in a PNG:
 * rows of 3 bytes a pixel, `stride` bytes apart. */
void output_encode(const struct image *image, struct rectangle part, uint8_t *rgb, size_t stride,
                   struct workers *workers);

/* A picture of those channels that the options keep, which stay the other's, as all else does; its
 * array is freed by the caller in any case. */
ps_result output_kept_layers(const struct image *image, const struct output_options *options,
                             struct image *kept, struct error *error);

/* Attributes that say how the picture of so many passes was made: version, scene, every setting,
 * and, where it can be repeated, the command that does so: what was interrupted, by asking for the
 * passes that were done. */
ps_result output_describe(struct image *image, const char *scene_path,
                          const struct scene_options *options,
                          const struct render_settings *settings, uint32_t passes, bool repeatable,
                          struct error *error);

/* Whether the folder of a file that is to be written is there and can be written to; the message
 * says what is wrong. */
bool output_check(const char *path, struct error *error);

/* Whether a file that is to be written, as `option` says or would have said, is none of those that
 * the scene was read from, under whatever name: scene, mesh and picture files, but not what a mesh
 * file names beside pictures. */
bool output_check_not_input(const char *path, const char *option,
                            const struct scene_description *description, struct error *error);

#endif
