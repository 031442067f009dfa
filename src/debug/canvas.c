#include "debug/canvas.h"

#include "debug/font.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

ps_result canvas_create(struct canvas *canvas, size_t width, size_t height, struct error *error)
{
    *canvas = (struct canvas){width, height, calloc(width * height, 3)};
    return canvas->rgb ? PS_OK : error_memory(error, 3 * width * height, "the picture");
}

void canvas_release(struct canvas *canvas)
{
    free(canvas->rgb);
    *canvas = (struct canvas){.rgb = NULL};
}

void canvas_set(struct canvas *canvas, long x, long y, struct colour colour)
{
    if (x < 0 || y < 0 || (size_t)x >= canvas->width || (size_t)y >= canvas->height)
        return;
    uint8_t *pixel = canvas->rgb + 3 * ((size_t)y * canvas->width + (size_t)x);
    pixel[0] = colour.r;
    pixel[1] = colour.g;
    pixel[2] = colour.b;
}

struct colour canvas_get(const struct canvas *canvas, size_t x, size_t y)
{
    const uint8_t *pixel = canvas->rgb + 3 * (y * canvas->width + x);
    return (struct colour){pixel[0], pixel[1], pixel[2]};
}

void canvas_fill(struct canvas *canvas, struct rectangle part, struct colour colour)
{
    for (size_t y = part.y; y < part.y + part.height; y++)
        for (size_t x = part.x; x < part.x + part.width; x++)
            canvas_set(canvas, (long)x, (long)y, colour);
}

void canvas_disc(struct canvas *canvas, float x, float y, float radius, struct colour colour)
{
    long reach = lroundf(ceilf(radius));
    long column = lroundf(floorf(x)), row = lroundf(floorf(y));
    for (long j = row - reach; j <= row + reach; j++)
        for (long i = column - reach; i <= column + reach; i++)
            if (hypotf((float)i + 0.5f - x, (float)j + 0.5f - y) <= radius)
                canvas_set(canvas, i, j, colour);
    canvas_set(canvas, column, row, colour);
}

/* Narrows the part [*begin, *end] of a line to where `at + part * step` lies in 0..size (Liang and
 * Barsky 1984). */
static void clip(float at, float step, float size, float *begin, float *end)
{
    if (step == 0.0f) {
        *end = at >= 0.0f && at <= size ? *end : -1.0f;
        return;
    }
    float one = -at / step, other = (size - at) / step;
    *begin = fmaxf(*begin, fminf(one, other));
    *end = fminf(*end, fmaxf(one, other));
}

void canvas_line(struct canvas *canvas, float from_x, float from_y, float to_x, float to_y,
                 struct colour colour)
{
    float dx = to_x - from_x, dy = to_y - from_y, begin = 0.0f, end = 1.0f;
    clip(from_x, dx, (float)canvas->width, &begin, &end);
    clip(from_y, dy, (float)canvas->height, &begin, &end);
    if (!(begin <= end))
        return;
    long steps = lroundf(ceilf((end - begin) * fmaxf(fabsf(dx), fabsf(dy)))) + 1;
    for (long i = 0; i <= steps; i++) {
        float part = begin + (end - begin) * (float)i / (float)steps;
        canvas_set(canvas, lroundf(floorf(from_x + part * dx)), lroundf(floorf(from_y + part * dy)),
                   colour);
    }
}

static void draw_letter(struct canvas *canvas, long x, long y, long scale, struct colour colour,
                        char letter)
{
    for (long j = 0; j < FONT_HEIGHT * scale; j++)
        for (long i = 0; i < FONT_WIDTH * scale; i++)
            if (font_pixel(letter, (size_t)(i / scale), (size_t)(j / scale)))
                canvas_set(canvas, x + i, y + j, colour);
}

void canvas_text(struct canvas *canvas, long x, long y, size_t scale, struct colour colour,
                 const char *text)
{
    for (; *text; text++, x += (long)(FONT_ADVANCE * scale))
        draw_letter(canvas, x, y, (long)scale, colour, *text);
}

size_t canvas_text_width(size_t scale, const char *text)
{
    size_t length = strlen(text);
    return length > 0 ? scale * (FONT_ADVANCE * length - (FONT_ADVANCE - FONT_WIDTH)) : 0;
}

size_t canvas_text_scale(size_t picture_width)
{
    return picture_width < 800 ? 1 : picture_width / 400;
}

void canvas_paste(struct canvas *canvas, size_t x, size_t y, const uint8_t *rgb, size_t width,
                  size_t height)
{
    for (size_t row = 0; row < height && y + row < canvas->height; row++) {
        size_t columns = x >= canvas->width          ? 0
                         : width < canvas->width - x ? width
                                                     : canvas->width - x;
        memcpy(canvas->rgb + 3 * ((y + row) * canvas->width + x), rgb + 3 * row * width,
               3 * columns);
    }
}
