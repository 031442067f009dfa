/* exr_output.h: an OpenEXR file on its way to the disk: its header, and its chunks, compressed by
 * threads.
 *
 * The order of calls matters and is written down nowhere: start, add the part, required attributes,
 * channels, other attributes, header; then for each chunk its information, the encoder (initialised
 * with a thread's first chunk, updated with the others), the planes' pointers *moved to that
 * chunk's first line*, and the run; then finish. Bytes go through output_file rather than the
 * library's own file handling, so that the file appears whole and a failed write says why.
 *
 * The library's messages are dropped: its handler runs with the context locked while writing, so it
 * cannot ask for our data; result codes with what was being written tell as much. No capDate: the
 * same picture gives the same bytes.
 */
#ifndef IMAGE_EXR_OUTPUT_H
#define IMAGE_EXR_OUTPUT_H

#include "base/output_file.h"
#include "image/image.h"
#include <OpenEXR/openexr.h>

#define EXR_OUTPUT_PART 0 /* the file's only part */

struct exr_output {
    struct output_file file;
    exr_context_t context;
    struct error *error; /* of the call under way */
    bool failed;         /* a write failed, and `error` already says why */
};

/* Opens a file and writes its header: channels, attributes and windows are the image's. `tile`: the
 * side of its tiles; 0: scan lines. On failure nothing is left. It must not move until it is
 * closed. */
ps_result exr_output_open(struct exr_output *output, const char *path, const struct image *image,
                          uint32_t tile, enum image_compression compression, struct error *error);

/* Ends the file, which appears where `result`, that of what was written, is PS_OK, and else is
 * none; returns it unless that fails. */
ps_result exr_output_close(struct exr_output *output, ps_result result, struct error *error);

/* A result for one of the library's, with a message that names what was being written. */
ps_result exr_output_explain(const struct exr_output *output, exr_result_t code, const char *kind,
                             const char *name);

/* How many lines make a chunk without tiles. */
size_t exr_output_lines(enum image_compression compression);

/* Chunks that are written in their order, by so many threads as there are workers. */
struct exr_chunks {
    struct exr_output *output;
    const struct image *image; /* where samples come from */
    size_t count;
    exr_result_t (*describe)(const struct exr_chunks *chunks, size_t index,
                             exr_chunk_info_t *chunk);
    /* Where in the image's planes a chunk begins: a pixel. */
    size_t (*begins)(const struct exr_chunks *chunks, size_t index);
    exr_result_t (*store)(const struct exr_chunks *chunks, size_t index, const void *bytes,
                          uint64_t size);
    const void *user;
};

ps_result exr_chunks_write(const struct exr_chunks *chunks, struct workers *workers,
                           struct error *error);

#endif
