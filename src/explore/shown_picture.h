/* shown_picture.h: a picture that views show and requests read, shared by counting references.
 *
 * It does not change once it is made, so that all may look at it without a lock. Layers are the
 * channels that belong together: `picture` is R, G and B; `indirect` indirect.R, .G and .B; `Z` the
 * one channel of that name.
 */
#ifndef EXPLORE_SHOWN_PICTURE_H
#define EXPLORE_SHOWN_PICTURE_H

#include "base/error.h"
#include "base/json_writer.h"
#include <psplat/psplat.h>
#include <stdbool.h>

struct shown_picture;

/* With one reference, which is the caller's. Takes the picture over, in any case; NULL when out of
 * memory. `number` names it for those who fetch it: larger than those before. */
struct shown_picture *shown_picture_create(psplat_picture *picture, uint64_t number);

/* Reads an OpenEXR file, likewise. */
ps_result shown_picture_read(const char *path, uint64_t number, struct shown_picture **read,
                             struct error *error);

/* Another reference to it; and one given back. NULL is nothing. Any thread. */
struct shown_picture *shown_picture_keep(struct shown_picture *shown);
void shown_picture_release(struct shown_picture *shown);

uint64_t shown_picture_number(const struct shown_picture *shown);
size_t shown_picture_width(const struct shown_picture *shown);
size_t shown_picture_height(const struct shown_picture *shown);

#define LAYER_NAME_LENGTH 64

struct shown_layer {
    char name[LAYER_NAME_LENGTH];
    size_t channel_count; /* 1 or 3 */
    const float *planes[3];
    bool is_display; /* 0..1, to be sRGB-encoded for a screen */
};

/* False where it has no such layer. */
bool shown_picture_layer(const struct shown_picture *shown, const char *name,
                         struct shown_layer *layer);

/* Calls back for each layer, in the order of the picture's channels. */
void shown_picture_each_layer(const struct shown_picture *shown,
                              void (*each)(void *user, const struct shown_layer *layer),
                              void *user);

/* A layer as bytes: a header of four u32 (width, height, channels, the picture's number) and the
 * samples as float32, row by row from the top, a pixel's together, all little-endian. `display` is
 * sRGB-encoded. */
size_t shown_layer_bytes(const struct shown_picture *shown, const struct shown_layer *layer);

/* Writes bytes from `at`, at most `most`; returns how many. */
size_t shown_layer_read(const struct shown_picture *shown, const struct shown_layer *layer,
                        size_t at, char *bytes, size_t most);

#endif
