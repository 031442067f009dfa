/* raster_jpeg.c: a JPEG file's samples, through libjpeg.
 *
 * libjpeg has an error handler leave a failed call, here by longjmp: as with libpng, what outlives
 * the jump sits in a struct of the caller. Damage is but a warning to libjpeg, which goes on with
 * grey; here it is an error, apart from warnings that leave the pixels whole.
 */
#include "image/raster_decode.h"

#include <setjmp.h>
#include <stdio.h>
/* after stdio.h, which it needs */
#include <jerror.h>
#include <jpeglib.h>

/* A block of 64 pixels takes at least one bit with Huffman's codes. */
#define HUFFMAN_EXPANSION 512

/* A progressive picture of real life has about ten; each costs time for the whole picture. */
#define SCAN_LIMIT 500

struct jpeg_job {
    struct jpeg_decompress_struct decoder; /* its client_data is the job */
    struct jpeg_error_mgr errors;
    struct jpeg_progress_mgr progress;
    jmp_buf jump;
    const struct raster_source *source;
    struct raster *raster;
    struct error *error;
    struct raster_rows rows;
    ps_result result; /* what to return after a jump */
};

static void leave(struct jpeg_job *job, ps_result result)
{
    job->result = result;
    longjmp(job->jump, 1);
}

static ps_result refuse(const struct jpeg_job *job, const char *why)
{
    return error_set(job->error, PS_ERROR_INVALID, "%s: %s", job->source->path, why);
}

static bool is_refusal(int code)
{
    return code == JERR_BAD_PRECISION || code == JERR_SOF_UNSUPPORTED || code == JERR_NOT_COMPILED;
}

static void fail(j_common_ptr decoder)
{
    struct jpeg_job *job = decoder->client_data;
    char message[JMSG_LENGTH_MAX];
    decoder->err->format_message(decoder, message);
    if (decoder->err->msg_code == JERR_OUT_OF_MEMORY) {
        leave(job, error_set(job->error, PS_ERROR_MEMORY, "%s: out of memory for a JPEG reader",
                             job->source->path));
    }
    if (is_refusal(decoder->err->msg_code)) {
        leave(job,
              error_set(job->error, PS_ERROR_INVALID, "%s: this kind of JPEG cannot be read: %s",
                        job->source->path, message));
    }
    leave(job, error_set(job->error, PS_ERROR_IO, "%s: this JPEG file is damaged: %s",
                         job->source->path, message));
}

static bool leaves_pixels_whole(int code)
{
    return code == JWRN_EXTRANEOUS_DATA || code == JWRN_ADOBE_XFORM || code == JWRN_JFIF_MAJOR ||
           code == JWRN_BOGUS_ICC;
}

static void judge_message(j_common_ptr decoder, int level)
{
    struct jpeg_job *job = decoder->client_data;
    int code = decoder->err->msg_code;
    if (level >= 0 || leaves_pixels_whole(code))
        return;
    if (code == JWRN_JPEG_EOF) {
        leave(job, error_set(job->error, PS_ERROR_IO, "%s: it ends too early (a truncated JPEG)",
                             job->source->path));
    }
    fail(decoder);
}

static void print_nothing(j_common_ptr decoder)
{
    (void)decoder;
}

static void limit_scans(j_common_ptr decoder)
{
    struct jpeg_job *job = decoder->client_data;
    if (job->decoder.input_scan_number > SCAN_LIMIT)
        leave(job, refuse(job, "a JPEG of so many scans cannot be read"));
}

static void expect(struct jpeg_job *job, ps_result result)
{
    if (result != PS_OK)
        leave(job, result);
}

static ps_result choose_colors(struct jpeg_job *job)
{
    struct jpeg_decompress_struct *decoder = &job->decoder;
    switch (decoder->jpeg_color_space) {
    case JCS_GRAYSCALE:
        decoder->out_color_space = JCS_GRAYSCALE;
        job->raster->channels = 1;
        return PS_OK;
    case JCS_YCbCr:
    case JCS_RGB:
        decoder->out_color_space = JCS_RGB;
        job->raster->channels = 3;
        return PS_OK;
    case JCS_CMYK:
    case JCS_YCCK:
        return refuse(job, "its colours are CMYK, for print (convert it to RGB)");
    default:
        return refuse(job, "its colours are of no known kind (grey, YCbCr and RGB can be read)");
    }
}

/* An arithmetic code needs next to nothing for a flat picture, so that no file is too short for the
 * memory that its header asks for; and hardly any program writes it. */
static ps_result check_coding(const struct jpeg_job *job)
{
    if (job->decoder.arith_code)
        return refuse(job, "its coding is arithmetic (convert it to Huffman's codes)");
    return PS_OK;
}

static void read_header(struct jpeg_job *job)
{
    struct jpeg_decompress_struct *decoder = &job->decoder;
    jpeg_read_header(decoder, TRUE);
    expect(job, check_coding(job));
    expect(job, choose_colors(job));
    job->raster->width = decoder->image_width;
    job->raster->height = decoder->image_height;
    job->raster->sample = RASTER_BYTE;
    job->raster->srgb = true;
    expect(job, raster_check_size(job->source->path, decoder->image_width, decoder->image_height,
                                  job->raster->channels, job->error));
    uint64_t pixels = (uint64_t)decoder->image_width * decoder->image_height;
    expect(job, raster_check_expansion(job->source, pixels, HUFFMAN_EXPANSION, job->error));
}

static void read_picture(struct jpeg_job *job)
{
    if (setjmp(job->jump))
        return;
    jpeg_create_decompress(&job->decoder);
    job->decoder.progress = &job->progress;
    jpeg_mem_src(&job->decoder, job->source->bytes, job->source->size);
    read_header(job);
    expect(job, raster_rows_begin(job->source, job->raster, &job->rows, job->error));
    jpeg_start_decompress(&job->decoder);
    while (job->decoder.output_scanline < job->decoder.output_height) {
        JSAMPROW row = raster_rows_next(&job->rows);
        jpeg_read_scanlines(&job->decoder, &row, 1);
        expect(job, raster_rows_add(&job->rows, job->error));
    }
    jpeg_finish_decompress(&job->decoder);
}

ps_result raster_read_jpeg(const struct raster_source *source, struct raster *raster,
                           struct error *error)
{
    struct jpeg_job job = {.source = source, .raster = raster, .error = error, .result = PS_OK};
    job.decoder.err = jpeg_std_error(&job.errors);
    job.decoder.client_data = &job;
    job.errors.error_exit = fail;
    job.errors.emit_message = judge_message;
    job.errors.output_message = print_nothing;
    job.progress.progress_monitor = limit_scans;
    read_picture(&job);
    jpeg_destroy_decompress(&job.decoder);
    raster_rows_release(&job.rows);
    return job.result;
}
