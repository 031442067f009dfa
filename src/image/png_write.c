/* png_write.c: 8-bit sRGB pixels to a PNG file.
 *
 * libpng leaves a failed call by longjmp. Everything that outlives such a jump therefore sits in a
 * struct of the caller, and the function that calls setjmp changes no variable of its own. No pHYs
 * or tIME: the same pixels give the same bytes.
 *
 * zlib looks for runs alone, which its authors made for PNG: once rows are filtered, rendered
 * pictures have little else that repeats. A quarter of the time of the default search, files 0 to 9
 * per cent longer. All rows have Paeth's filter: trying the others too makes files 0 to 3 per cent
 * shorter and takes a fifth more time.
 */
#include "base/output_file.h"
#include "image/image.h"

#include <png.h>
#include <stdbool.h>
#include <string.h>
#include <zlib.h>

#define KEY_LIMIT 79 /* of a text chunk's key, by the PNG specification */

struct png_job {
    struct output_file file;
    uint64_t offset;
    struct error *error;
    png_structp png;
    png_infop info;
    ps_result result; /* what to return after a jump */
    size_t width, height;
    const uint8_t *rgb;
    const struct image_attribute *texts;
    size_t text_count;
};

static void fail(png_structp png, png_const_charp message)
{
    struct png_job *job = png_get_error_ptr(png);
    job->result =
        error_set(job->error, PS_ERROR_INVALID, "cannot write '%s': %s", job->file.path, message);
    png_longjmp(png, 1);
}

static void drop_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void write_bytes(png_structp png, png_bytep bytes, size_t size)
{
    struct png_job *job = png_get_io_ptr(png);
    job->result = output_file_write(&job->file, job->offset, bytes, size, job->error);
    if (job->result != PS_OK)
        png_longjmp(png, 1);
    job->offset += size;
}

static void flush_nothing(png_structp png)
{
    (void)png;
}

/* tEXt is Latin-1 by definition; what goes beyond ASCII is UTF-8 here, which iTXt is for. */
static void set_text(struct png_job *job, const struct image_attribute *text)
{
    bool ascii = true;
    for (const char *c = text->value; *c; c++)
        ascii = ascii && (unsigned char)*c < 128;
    png_text chunk = {
        .compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE,
        .key = text->name,
        .text = text->value,
        .text_length = strlen(text->value),
    };
    png_set_text(job->png, job->info, &chunk, 1);
}

static void write_chunks(struct png_job *job)
{
    if (setjmp(png_jmpbuf(job->png)))
        return;
    png_set_write_fn(job->png, job, write_bytes, flush_nothing);
    png_set_IHDR(job->png, job->info, (png_uint_32)job->width, (png_uint_32)job->height, 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_strategy(job->png, Z_RLE);
    png_set_filter(job->png, PNG_FILTER_TYPE_BASE, PNG_FILTER_PAETH);
    png_set_sRGB(job->png, job->info, PNG_sRGB_INTENT_PERCEPTUAL);
    for (size_t i = 0; i < job->text_count; i++)
        set_text(job, &job->texts[i]);
    png_write_info(job->png, job->info);
    for (size_t y = 0; y < job->height; y++)
        png_write_row(job->png, job->rgb + 3 * y * job->width);
    png_write_end(job->png, job->info);
}

/* libpng would change other keys without an error. */
static bool is_key(const char *key)
{
    size_t length = 0;
    while (key[length] >= ' ' && key[length] <= '~')
        length++;
    return key[length] == '\0' && length > 0 && length <= KEY_LIMIT;
}

static ps_result check_arguments(const struct png_job *job, const char *path)
{
    if (job->width == 0 || job->height == 0 || job->width > PNG_USER_WIDTH_MAX ||
        job->height > PNG_USER_HEIGHT_MAX) {
        return error_set(
            job->error, PS_ERROR_INVALID,
            "cannot write '%s': a PNG of %zu x %zu pixels cannot be (1 to %d each way)", path,
            job->width, job->height, PNG_USER_WIDTH_MAX);
    }
    for (size_t i = 0; i < job->text_count; i++) {
        if (!is_key(job->texts[i].name)) {
            return error_set(job->error, PS_ERROR_INVALID,
                             "cannot write '%s': the text key '%s' must be 1 to %d printable "
                             "characters",
                             path, job->texts[i].name, KEY_LIMIT);
        }
    }
    return PS_OK;
}

static ps_result write_picture(struct png_job *job)
{
    job->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, job, fail, drop_warning);
    job->info = job->png ? png_create_info_struct(job->png) : NULL;
    if (job->info) {
        job->result = PS_OK;
        write_chunks(job);
    } else {
        job->result = error_memory(job->error, job->width * 3, "a PNG writer");
    }
    png_destroy_write_struct(&job->png, &job->info);
    return job->result;
}

ps_result image_write_png(const char *path, size_t width, size_t height, const uint8_t *rgb,
                          const struct image_attribute *texts, size_t text_count,
                          struct error *error)
{
    struct png_job job = {.error = error,
                          .width = width,
                          .height = height,
                          .rgb = rgb,
                          .texts = texts,
                          .text_count = texts ? text_count : 0};
    ps_result result = check_arguments(&job, path);
    if (result == PS_OK)
        result = output_file_open(&job.file, path, error);
    if (result != PS_OK)
        return result;
    result = write_picture(&job);
    if (result != PS_OK) {
        output_file_discard(&job.file);
        return result;
    }
    return output_file_commit(&job.file, error);
}
