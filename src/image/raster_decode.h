/* raster_decode.h: what the readers of one type of file share; for src/image alone. */
#ifndef IMAGE_RASTER_DECODE_H
#define IMAGE_RASTER_DECODE_H

#include "image/image.h"
#include "image/raster.h"

/* A whole file in memory; borrowed. */
struct raster_source {
    const char *path; /* for messages */
    const unsigned char *bytes;
    size_t size;
    const char *layer;                /* of an OpenEXR file; NULL: its picture */
    const struct raster_lines *lines; /* or NULL */
};

/* Each reads `source` into `raster`, as raster_read says; on failure the caller releases `raster`,
 * whatever it holds by then. */
ps_result raster_read_png(const struct raster_source *source, struct raster *raster,
                          struct error *error);
ps_result raster_read_jpeg(const struct raster_source *source, struct raster *raster,
                           struct error *error);
ps_result raster_read_exr(const struct raster_source *source, struct raster *raster,
                          struct error *error);

#ifdef PSPLAT_STB
ps_result raster_read_bytes(const struct raster_source *source, struct raster *raster,
                            struct error *error); /* TGA and BMP */
ps_result raster_read_radiance(const struct raster_source *source, struct raster *raster,
                               struct error *error);
/* Radiance's lines in the order that stb_image knows. */
ps_result raster_read_floats(const struct raster_source *source, struct raster *raster,
                             struct error *error);
#endif
#ifdef PSPLAT_WEBP
ps_result raster_read_webp(const struct raster_source *source, struct raster *raster,
                           struct error *error);
#endif

/* CIE 1931 x and y. */
struct chromaticities {
    float red[2], green[2], blue[2], white[2];
};

/* Of a file that was read. */
struct exr_facts {
    int64_t left,
        top; /* of the display window's upper left corner to that of the data window, in pixels */
    int64_t width, height; /* of the display window, as stated */
    uint64_t pixels;       /* of the data window */
    bool layer_is_part;    /* channels have their own names alone */
    bool halves;           /* all channels that are read are half floats in the file */
    bool has_chromaticities;
    struct chromaticities chromaticities;
};

/* Who takes an OpenEXR picture in bands of lines, from the top. */
struct exr_bands {
    /* The first `lines` lines of the planes are the next ones; they may be changed. Anything but
     * PS_OK ends the reading. */
    ps_result (*take)(void *user, const struct image *band, const struct exr_facts *facts,
                      size_t lines, struct error *error);
    void *user;
};

/* As image_read_exr, from memory, with the limits of a raster, and with messages that start with
 * the path. Only the channels of the layer's picture (exr_layer.h), maybe none where it is the
 * file's. Of several parts the first that has some beside alpha. `bands`: who takes them, so that
 * the image has planes for the lines of one alone in the end; or NULL. */
ps_result exr_read_layer(const struct raster_source *source, const struct exr_bands *bands,
                         struct image *image, struct exr_facts *facts, struct error *error);

/* chromaticities.c: makes the colours in planes of red, green and blue Rec.709's. No-op where the
 * primaries are those, or cannot be. */
void chromaticities_to_rec709(const struct chromaticities *from, float *const planes[3],
                              size_t pixels);

/* Refuses pictures without a size and those beyond the limits. */
ps_result raster_check_size(const char *path, int64_t width, int64_t height, size_t bytes_per_pixel,
                            struct error *error);

/* No stream of deflate unpacks to more than this times its size. */
#define RASTER_DEFLATE_EXPANSION 1032

/* Refuses a picture that the file is too short for: one that even at `expansion` decoded bytes for
 * each of its own would end too early. Keeps a small hostile file from taking gigabytes. */
ps_result raster_check_expansion(const struct raster_source *source, uint64_t decoded,
                                 uint64_t expansion, struct error *error);

/* Checks the size that `raster` states, and allocates its samples. */
ps_result raster_allocate(const char *path, struct raster *raster, struct error *error);

/* Where the rows of a picture go, one after the other from the top: to whoever wants lines, or into
 * the raster. */
struct raster_rows {
    const struct raster_lines *lines; /* NULL: into the raster */
    const struct raster *raster;
    void *line; /* owned; room for one that is handed on */
    uint32_t done;
};

/* Checks the size that `raster` states, which is borrowed, and makes room: of its samples, unless
 * lines are wanted. */
ps_result raster_rows_begin(const struct raster_source *source, struct raster *raster,
                            struct raster_rows *rows, struct error *error);

/* Where the next row goes; and when it is there. */
void *raster_rows_next(const struct raster_rows *rows);
ps_result raster_rows_add(struct raster_rows *rows, struct error *error);
void raster_rows_release(struct raster_rows *rows);

/* Where a row's samples start, 0 is the top one. */
void *raster_row(const struct raster *raster, size_t row);

#endif
