/* exr_bytes.h: OpenEXR files put together byte by byte from the format's description, uncompressed,
 * so that the reader is not only tested against our writer. */
#ifndef TESTS_EXR_BYTES_H
#define TESTS_EXR_BYTES_H

#include "scratch.h"

#include <math.h>

#define WIDTH 7
#define HEIGHT 5
#define TILE_WIDTH 4
#define TILE_HEIGHT 3

enum { UINT, HALF, FLOAT }; /* the format's numbers of the sample types */

/* A file to build; zeros stand for the ordinary choice. */
struct form {
    int types[3]; /* of the channels A, B and C */
    int left, top;
    int tiled, level_mode;
    int compression; /* as the header says; the pixels are stored as they are */
    int sampling;    /* of columns; 0 for 1 */
    int version_flags;
    int width_claimed; /* 0 for WIDTH */
    const char *type;  /* NULL for none */
};

struct bytes {
    unsigned char data[8192];
    size_t size;
};

static void put(struct bytes *bytes, const void *data, size_t size)
{
    assert_true(bytes->size + size <= sizeof bytes->data);
    memcpy(bytes->data + bytes->size, data, size);
    bytes->size += size;
}

static void put_int(struct bytes *bytes, int64_t value, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        unsigned char byte = (unsigned char)((uint64_t)value >> (8 * i));
        put(bytes, &byte, 1);
    }
}

static void put_text(struct bytes *bytes, const char *text)
{
    put(bytes, text, strlen(text) + 1);
}

static void put_attribute(struct bytes *bytes, const char *name, const char *type, size_t size)
{
    put_text(bytes, name);
    put_text(bytes, type);
    put_int(bytes, (int64_t)size, 4);
}

static void put_box(struct bytes *bytes, const char *name, const struct form *form)
{
    int width = form->width_claimed ? form->width_claimed : WIDTH;
    put_attribute(bytes, name, "box2i", 16);
    put_int(bytes, form->left, 4);
    put_int(bytes, form->top, 4);
    put_int(bytes, (int64_t)form->left + width - 1, 4);
    put_int(bytes, form->top + HEIGHT - 1, 4);
}

static void put_channels(struct bytes *bytes, const struct form *form)
{
    static const char *const names[] = {"A", "B", "C"};
    put_attribute(bytes, "channels", "chlist", 3 * 18 + 1);
    for (int i = 0; i < 3; i++) {
        put_text(bytes, names[i]);
        put_int(bytes, form->types[i], 4);
        put_int(bytes, 0, 4);
        put_int(bytes, form->sampling ? form->sampling : 1, 4);
        put_int(bytes, 1, 4);
    }
    put_int(bytes, 0, 1);
}

static void put_header(struct bytes *bytes, const struct form *form)
{
    put_channels(bytes, form);
    put_attribute(bytes, "compression", "compression", 1);
    put_int(bytes, form->compression, 1);
    put_box(bytes, "dataWindow", form);
    put_box(bytes, "displayWindow", form);
    put_attribute(bytes, "lineOrder", "lineOrder", 1);
    put_int(bytes, 0, 1);
    put_attribute(bytes, "pixelAspectRatio", "float", 4);
    put_int(bytes, 0x3f800000, 4);
    put_attribute(bytes, "screenWindowCenter", "v2f", 8);
    put_int(bytes, 0, 8);
    put_attribute(bytes, "screenWindowWidth", "float", 4);
    put_int(bytes, 0x3f800000, 4);
    put_attribute(bytes, "comments", "string", 5);
    put(bytes, "hello", 5);
    if (form->tiled) {
        put_attribute(bytes, "tiles", "tiledesc", 9);
        put_int(bytes, TILE_WIDTH, 4);
        put_int(bytes, TILE_HEIGHT, 4);
        put_int(bytes, form->level_mode, 1);
    }
    if (form->type) {
        put_attribute(bytes, "type", "string", strlen(form->type));
        put(bytes, form->type, strlen(form->type));
        put_attribute(bytes, "name", "string", 1);
        put(bytes, "n", 1);
        put_attribute(bytes, "chunkCount", "int", 4);
        put_int(bytes, HEIGHT, 4);
        put_attribute(bytes, "version", "int", 4);
        put_int(bytes, 1, 4);
        put_attribute(bytes, "maxSamplesPerPixel", "int", 4);
        put_int(bytes, 1, 4);
    }
    put_int(bytes, 0, 1);
}

/* A whole number below 2048, which a half holds exactly. */
static int value_at(int channel, int x, int y)
{
    return 400 * channel + 10 * y + x;
}

static void put_sample(struct bytes *bytes, int type, int value)
{
    int exponent;
    float number = (float)value;
    double mantissa = frexp(value, &exponent);
    if (type == FLOAT) {
        put(bytes, &number,
            sizeof number); /* the tests' machine is little-endian, like the format */
    } else if (type == UINT) {
        put_int(bytes, value, 4);
    } else {
        put_int(bytes, value ? ((exponent + 14) << 10) + (int)((2 * mantissa - 1) * 1024) : 0, 2);
    }
}

/* A line's or tile's pixels, with their size in front. */
static void put_pixels(struct bytes *bytes, const struct form *form, int left, int top, int right,
                       int bottom)
{
    size_t start = bytes->size;
    put_int(bytes, 0, 4);
    for (int y = top; y < bottom; y++) {
        for (int channel = 0; channel < 3; channel++) {
            for (int x = left; x < right; x++) {
                put_sample(bytes, form->types[channel], value_at(channel, x, y));
            }
        }
    }
    size_t end = bytes->size;
    bytes->size = start;
    put_int(bytes, (int64_t)(end - start - 4), 4);
    bytes->size = end;
}

static void set_offset(struct bytes *bytes, size_t table, int index)
{
    size_t here = bytes->size;
    bytes->size = table + 8 * (size_t)index;
    put_int(bytes, (int64_t)here, 8);
    bytes->size = here;
}

static void put_lines(struct bytes *bytes, const struct form *form)
{
    size_t table = bytes->size;
    bytes->size += 8 * HEIGHT;
    for (int y = 0; y < HEIGHT; y++) {
        set_offset(bytes, table, y);
        put_int(bytes, form->top + y, 4);
        put_pixels(bytes, form, 0, y, WIDTH, y + 1);
    }
}

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

static void put_tiles(struct bytes *bytes, const struct form *form)
{
    size_t table = bytes->size;
    int index = 0;
    bytes->size += 8 * 2 * 2;
    for (int top = 0; top < HEIGHT; top += TILE_HEIGHT) {
        for (int left = 0; left < WIDTH; left += TILE_WIDTH) {
            set_offset(bytes, table, index++);
            put_int(bytes, left / TILE_WIDTH, 4);
            put_int(bytes, top / TILE_HEIGHT, 4);
            put_int(bytes, 0, 8); /* the level */
            put_pixels(bytes, form, left, top, smaller(left + TILE_WIDTH, WIDTH),
                       smaller(top + TILE_HEIGHT, HEIGHT));
        }
    }
}

static inline struct bytes build(const struct form *form)
{
    struct bytes bytes = {.size = 0};
    put_int(&bytes, 20000630, 4);
    put_int(&bytes, 2 | form->version_flags | (form->tiled ? 0x200 : 0), 4);
    put_header(&bytes, form);
    if (form->version_flags & 0x1000) {
        put_header(&bytes, form);
        put_int(&bytes, 0, 1);
    }
    if (form->tiled) {
        put_tiles(&bytes, form);
    } else {
        put_lines(&bytes, form);
    }
    return bytes;
}

#endif
