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
#include "image/png_rows.h"

#include <png.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#define KEY_LIMIT 79 /* of a text chunk's key, by the PNG specification */

struct png_rows {
    struct output_file file;
    uint64_t offset;
    struct error *error;
    png_structp png;
    png_infop info;
    ps_result result; /* what to return after a jump */
    size_t width, height;
};

static void fail(png_structp png, png_const_charp message)
{
    struct png_rows *rows = png_get_error_ptr(png);
    rows->result =
        error_set(rows->error, PS_ERROR_INVALID, "cannot write '%s': %s", rows->file.path, message);
    png_longjmp(png, 1);
}

static void drop_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void write_bytes(png_structp png, png_bytep bytes, size_t size)
{
    struct png_rows *rows = png_get_io_ptr(png);
    rows->result = output_file_write(&rows->file, rows->offset, bytes, size, rows->error);
    if (rows->result != PS_OK)
        png_longjmp(png, 1);
    rows->offset += size;
}

static void flush_nothing(png_structp png)
{
    (void)png;
}

/* tEXt is Latin-1 by definition; what goes beyond ASCII is UTF-8 here, which iTXt is for. */
static void set_text(struct png_rows *rows, const struct image_attribute *text)
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
    png_set_text(rows->png, rows->info, &chunk, 1);
}

static void begin(struct png_rows *rows, const struct image_attribute *texts, size_t text_count)
{
    if (setjmp(png_jmpbuf(rows->png)))
        return;
    png_set_write_fn(rows->png, rows, write_bytes, flush_nothing);
    png_set_IHDR(rows->png, rows->info, (png_uint_32)rows->width, (png_uint_32)rows->height, 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_strategy(rows->png, Z_RLE);
    png_set_filter(rows->png, PNG_FILTER_TYPE_BASE, PNG_FILTER_PAETH);
    png_set_sRGB(rows->png, rows->info, PNG_sRGB_INTENT_PERCEPTUAL);
    for (size_t i = 0; i < text_count; i++)
        set_text(rows, &texts[i]);
    png_write_info(rows->png, rows->info);
}

/* libpng would change other keys without an error. */
static bool is_key(const char *key)
{
    size_t length = 0;
    while (key[length] >= ' ' && key[length] <= '~')
        length++;
    return key[length] == '\0' && length > 0 && length <= KEY_LIMIT;
}

static ps_result check_arguments(const char *path, size_t width, size_t height,
                                 const struct image_attribute *texts, size_t text_count,
                                 struct error *error)
{
    if (width == 0 || height == 0 || width > PNG_USER_WIDTH_MAX || height > PNG_USER_HEIGHT_MAX) {
        return error_set(
            error, PS_ERROR_INVALID,
            "cannot write '%s': a PNG of %zu x %zu pixels cannot be (1 to %d each way)", path,
            width, height, PNG_USER_WIDTH_MAX);
    }
    for (size_t i = 0; i < text_count; i++) {
        if (!is_key(texts[i].name)) {
            return error_set(error, PS_ERROR_INVALID,
                             "cannot write '%s': the text key '%s' must be 1 to %d printable "
                             "characters",
                             path, texts[i].name, KEY_LIMIT);
        }
    }
    return PS_OK;
}

static void destroy(struct png_rows *rows)
{
    png_destroy_write_struct(&rows->png, &rows->info);
    free(rows);
}

void png_rows_discard(struct png_rows *rows)
{
    if (!rows)
        return;
    output_file_discard(&rows->file);
    destroy(rows);
}

ps_result png_rows_create(const char *path, size_t width, size_t height,
                          const struct image_attribute *texts, size_t text_count,
                          struct png_rows **created, struct error *error)
{
    *created = NULL;
    ps_result result = check_arguments(path, width, height, texts, text_count, error);
    if (result != PS_OK)
        return result;
    struct png_rows *rows = calloc(1, sizeof *rows);
    if (!rows) {
        error_memory(error, sizeof *rows, "a PNG writer");
        return PS_ERROR_MEMORY;
    }
    *rows = (struct png_rows){.error = error, .width = width, .height = height};
    result = output_file_open(&rows->file, path, error);
    if (result != PS_OK) {
        free(rows);
        return result;
    }
    rows->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, rows, fail, drop_warning);
    rows->info = rows->png ? png_create_info_struct(rows->png) : NULL;
    if (rows->info)
        begin(rows, texts, text_count);
    else
        rows->result = error_memory(error, width * 3, "a PNG writer");
    result = rows->result;
    if (result == PS_OK)
        *created = rows;
    else
        png_rows_discard(rows);
    return result;
}

ps_result png_rows_add(struct png_rows *rows, const uint8_t *rgb, size_t count, struct error *error)
{
    rows->error = error;
    if (setjmp(png_jmpbuf(rows->png)))
        return rows->result;
    for (size_t y = 0; y < count; y++)
        png_write_row(rows->png, rgb + 3 * y * rows->width);
    return PS_OK;
}

static ps_result end(struct png_rows *rows)
{
    if (setjmp(png_jmpbuf(rows->png)))
        return rows->result;
    png_write_end(rows->png, rows->info);
    return PS_OK;
}

ps_result png_rows_finish(struct png_rows *rows, struct error *error)
{
    rows->error = error;
    ps_result result = end(rows);
    if (result != PS_OK) {
        png_rows_discard(rows);
        return result;
    }
    result = output_file_commit(&rows->file, error);
    destroy(rows);
    return result;
}

ps_result image_write_png(const char *path, size_t width, size_t height, const uint8_t *rgb,
                          const struct image_attribute *texts, size_t text_count,
                          struct error *error)
{
    struct png_rows *rows;
    ps_result result =
        png_rows_create(path, width, height, texts, texts ? text_count : 0, &rows, error);
    if (result != PS_OK)
        return result;
    result = png_rows_add(rows, rgb, height, error);
    if (result == PS_OK)
        return png_rows_finish(rows, error);
    png_rows_discard(rows);
    return result;
}
