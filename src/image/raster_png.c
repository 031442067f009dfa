/* raster_png.c: a PNG file's samples, through libpng.
 *
 * libpng leaves a failed call by longjmp. Everything that outlives such a jump sits in a struct of
 * the caller, and the function that calls setjmp changes no variable of its own. Chunks that are
 * not needed are skipped unread: that is safer, and the place where decompression bombs hide.
 */
#include "image/raster_decode.h"

#include <png.h>
#include <string.h>

struct png_job {
    const struct raster_source *source;
    size_t position; /* of the next byte to read */
    struct error *error;
    png_structp png;
    png_infop info;
    struct raster *raster;
    struct raster_rows rows;
    ps_result result; /* what to return after a jump */
};

static void fail(png_structp png, png_const_charp message)
{
    struct png_job *job = png_get_error_ptr(png);
    job->result = error_set(job->error, PS_ERROR_IO, "%s: this PNG file is damaged: %s",
                            job->source->path, message);
    png_longjmp(png, 1);
}

static void drop_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void read_bytes(png_structp png, png_bytep bytes, size_t size)
{
    struct png_job *job = png_get_io_ptr(png);
    if (size > job->source->size - job->position) {
        job->result = error_set(job->error, PS_ERROR_IO, "%s: it ends too early (a truncated PNG)",
                                job->source->path);
        png_longjmp(png, 1);
    }
    memcpy(bytes, job->source->bytes + job->position, size);
    job->position += size;
}

static bool is_little_endian(void)
{
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 1;
}

static void expect(struct png_job *job, ps_result result)
{
    if (result != PS_OK) {
        job->result = result;
        png_longjmp(job->png, 1);
    }
}

/* The size is checked before libpng unpacks anything, and its own limits let all sizes pass, since
 * what it says of them does not help. */
static void read_header(struct png_job *job)
{
    png_read_info(job->png, job->info);
    png_uint_32 width = png_get_image_width(job->png, job->info);
    png_uint_32 height = png_get_image_height(job->png, job->info);
    size_t packed_row = png_get_rowbytes(job->png, job->info);
    size_t packed_pixel = (packed_row + width - 1) / width;
    expect(job, raster_check_size(job->source->path, width, height, packed_pixel, job->error));
    expect(job, raster_check_expansion(job->source, (uint64_t)packed_row * height,
                                       RASTER_DEFLATE_EXPANSION, job->error));
    job->raster->width = width;
    job->raster->height = height;
}

static void choose_form(struct png_job *job)
{
    png_set_expand(job->png);
    if (is_little_endian()) {
        png_set_swap(job->png); /* of 16 bits only */
    }
    png_set_interlace_handling(job->png);
    png_read_update_info(job->png, job->info);
    job->raster->channels = png_get_channels(job->png, job->info);
    job->raster->sample = png_get_bit_depth(job->png, job->info) == 16 ? RASTER_SHORT : RASTER_BYTE;
    job->raster->srgb = true;
}

static void read_rows(struct png_job *job)
{
    expect(job, raster_rows_begin(job->source, job->raster, &job->rows, job->error));
    while (job->rows.done < job->raster->height) {
        png_read_row(job->png, raster_rows_next(&job->rows), NULL);
        expect(job, raster_rows_add(&job->rows, job->error));
    }
}

/* Seven passes, each of which fills in some pixels of all rows. */
static void read_passes(struct png_job *job)
{
    expect(job, raster_allocate(job->source->path, job->raster, job->error));
    for (int pass = 0; pass < PNG_INTERLACE_ADAM7_PASSES; pass++) {
        for (size_t row = 0; row < job->raster->height; row++)
            png_read_row(job->png, raster_row(job->raster, row), NULL);
    }
}

static void read_picture(struct png_job *job)
{
    if (setjmp(png_jmpbuf(job->png)))
        return;
    png_set_read_fn(job->png, job, read_bytes);
    png_set_user_limits(job->png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_keep_unknown_chunks(job->png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
    read_header(job);
    choose_form(job);
    if (png_get_interlace_type(job->png, job->info) == PNG_INTERLACE_NONE)
        read_rows(job);
    else
        read_passes(job);
    png_read_end(job->png, NULL);
}

ps_result raster_read_png(const struct raster_source *source, struct raster *raster,
                          struct error *error)
{
    struct png_job job = {.source = source, .error = error, .raster = raster};
    job.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &job, fail, drop_warning);
    job.info = job.png ? png_create_info_struct(job.png) : NULL;
    if (job.info) {
        job.result = PS_OK;
        read_picture(&job);
    } else {
        job.result =
            error_set(error, PS_ERROR_MEMORY, "%s: out of memory for a PNG reader", source->path);
    }
    png_destroy_read_struct(&job.png, &job.info, NULL);
    raster_rows_release(&job.rows);
    return job.result;
}
