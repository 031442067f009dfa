/* exr_source.h: an OpenEXR file that is being read; for exr_header.c and exr_read.c alone. */
#ifndef IMAGE_EXR_SOURCE_H
#define IMAGE_EXR_SOURCE_H

#include "image/raster_decode.h"

#include <OpenEXR/openexr.h>
#include <stdbool.h>

struct exr_source {
    exr_context_t context;
    int part;
    const char *path;
    const struct raster_source *memory; /* NULL: from the file, with all channels */
    struct error *error;
    char message[256];             /* the library's first complaint, or empty */
    size_t height;                 /* of the picture */
    struct image image;            /* its planes: of the picture, or of the lines of a band */
    const struct exr_bands *bands; /* who takes it band by band, or NULL */
    size_t band_lines;             /* of a chunk */
    size_t tile_width;             /* 0: chunks are groups of lines */
    exr_attr_box2i_t window;
    struct exr_facts facts;
    exr_decode_pipeline_t decoder;
    bool decoding; /* the decoder has been initialised */
    /* Where channels go that are not wanted: the library crashes if told to skip one. */
    float *spare;
    size_t spare_count;
};

/* Chooses the part, checks what its header says, and adds its attributes and the channels that are
 * wanted to the image, maybe none where the file's picture is wanted. PS_ERROR_IO, _INVALID or
 * _MEMORY. */
ps_result exr_header_read(struct exr_source *source);

/* A result for one of the library's, with its first message; and that of a file that is not
 * read. */
ps_result exr_source_explain(const struct exr_source *source, exr_result_t code);
ps_result exr_source_refuse(const struct exr_source *source, const char *why);

#endif
