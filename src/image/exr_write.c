/* exr_write.c: a picture to an OpenEXR file of scan lines. */
#include "image/exr_output.h"

/* The chunk's first line, in the image. */
static size_t line_of(const struct exr_chunks *chunks, size_t index)
{
    const size_t *lines = chunks->user;
    return index * *lines;
}

static exr_result_t describe(const struct exr_chunks *chunks, size_t index, exr_chunk_info_t *chunk)
{
    size_t line = chunks->image->window.top + line_of(chunks, index);
    return exr_write_scanline_chunk_info(chunks->output->context, EXR_OUTPUT_PART, (int)line,
                                         chunk);
}

static size_t begins(const struct exr_chunks *chunks, size_t index)
{
    return line_of(chunks, index) * chunks->image->width;
}

static exr_result_t store(const struct exr_chunks *chunks, size_t index, const void *bytes,
                          uint64_t size)
{
    size_t line = chunks->image->window.top + line_of(chunks, index);
    return exr_write_scanline_chunk(chunks->output->context, EXR_OUTPUT_PART, (int)line, bytes,
                                    size);
}

ps_result image_write_exr(const struct image *image, const char *path,
                          enum image_compression compression, struct workers *workers,
                          struct error *error)
{
    size_t lines = exr_output_lines(compression);
    struct exr_output output;
    ps_result result = exr_output_open(&output, path, image, 0, compression, error);
    if (result != PS_OK)
        return result;
    const struct exr_chunks chunks = {
        .output = &output,
        .image = image,
        .count = (image->height + lines - 1) / lines,
        .describe = describe,
        .begins = begins,
        .store = store,
        .user = &lines,
    };
    return exr_output_close(&output, exr_chunks_write(&chunks, workers, error), error);
}
