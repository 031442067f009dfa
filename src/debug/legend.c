#include "debug/legend.h"

#include "base/text.h"
#include "compare/heatmap.h"
#include "debug/font.h"
#include "debug/id_colour.h"
#include <math.h>
#include <stdio.h>

static const struct colour paper = {24, 24, 24}, ink = {230, 230, 230};

/* From top to bottom, in text pixels: margin, title, gap, ramp, gap, numbers, margin. */
enum {
    MARGIN = 4,
    RAMP_TOP = MARGIN + FONT_HEIGHT + 3,
    RAMP_HEIGHT = 8,
    NUMBERS_TOP = RAMP_TOP + RAMP_HEIGHT + 4,
    STRIP_HEIGHT = NUMBERS_TOP + FONT_HEIGHT + MARGIN
};

double legend_top(double largest)
{
    static const double rounds[] = {1, 1.5, 2, 3, 4, 5, 6, 8, 10};
    if (!(largest > 0.0))
        return 1.0;
    double decade = pow(10.0, floor(log10(largest)));
    for (size_t i = 0; i < sizeof rounds / sizeof rounds[0]; i++)
        if (largest <= rounds[i] * decade * (1.0 + 1e-9))
            return rounds[i] * decade;
    return 10.0 * decade;
}

double legend_step(double top, size_t most)
{
    static const double rounds[] = {1, 2, 5, 10};
    double least = top / (double)most;
    double decade = pow(10.0, floor(log10(least)));
    for (size_t i = 0; i < sizeof rounds / sizeof rounds[0]; i++)
        if (least <= rounds[i] * decade * (1.0 + 1e-9))
            return rounds[i] * decade;
    return 10.0 * decade;
}

struct colour legend_colour(const struct legend_scale *scale, double value)
{
    uint8_t rgb[3];
    double share = fmin(fmax(value / scale->top, 0.0), 1.0);
    heatmap_colour(scale->darkest + (1.0 - scale->darkest) * share, rgb);
    return (struct colour){rgb[0], rgb[1], rgb[2]};
}

size_t legend_height(size_t picture_width)
{
    return STRIP_HEIGHT * canvas_text_scale(picture_width);
}

/* The strip's empty paper and its title; returns the scale of its text. */
static size_t start(struct canvas *canvas, size_t y, const char *title)
{
    size_t scale = canvas_text_scale(canvas->width);
    canvas_fill(canvas, (struct rectangle){0, y, canvas->width, STRIP_HEIGHT * scale}, paper);
    canvas_text(canvas, (long)(MARGIN * scale), (long)(y + MARGIN * scale), scale, ink, title);
    return scale;
}

static void draw_number(struct canvas *canvas, double value, size_t x, size_t y, size_t scale)
{
    char text[32];
    text_from_float((float)value, text, sizeof text);
    long left = (long)x - (long)(canvas_text_width(scale, text) / 2);
    long rightmost = (long)canvas->width - (long)(canvas_text_width(scale, text) + scale);
    left = left > rightmost ? rightmost : left;
    canvas_fill(canvas,
                (struct rectangle){x, y + (RAMP_TOP + RAMP_HEIGHT) * scale, scale, 2 * scale}, ink);
    canvas_text(canvas, left < (long)scale ? (long)scale : left, (long)(y + NUMBERS_TOP * scale),
                scale, ink, text);
}

void legend_draw_scale(struct canvas *canvas, size_t y, const char *title,
                       const struct legend_scale *scale)
{
    size_t text = start(canvas, y, title), left = MARGIN * text;
    size_t width = canvas->width > 3 * left ? canvas->width - 2 * left : canvas->width;
    for (size_t i = 0; i < width; i++)
        canvas_fill(canvas,
                    (struct rectangle){left + i, y + RAMP_TOP * text, 1, RAMP_HEIGHT * text},
                    legend_colour(scale, scale->top * ((double)i + 0.5) / (double)width));
    size_t room = width / (8 * FONT_ADVANCE * text);
    double step = legend_step(scale->top, room > 1 ? room : 1);
    for (int i = 0; (double)i * step <= scale->top * (1.0 + 1e-9); i++) {
        double share = (double)i * step / scale->top;
        size_t across = (size_t)(share * (double)(width - 1) + 0.5);
        draw_number(canvas, (double)i * step, left + across, y, text);
    }
}

void legend_draw_series(struct canvas *canvas, size_t y, const char *title, unsigned most)
{
    size_t scale = start(canvas, y, title), side = RAMP_HEIGHT * scale;
    for (unsigned number = 1; number <= most; number++) {
        size_t x = MARGIN * scale + (number - 1) * 4 * side;
        char text[16];
        canvas_fill(canvas, (struct rectangle){x, y + RAMP_TOP * scale, 3 * side, side},
                    series_colour(number));
        snprintf(text, sizeof text, "%u", number);
        canvas_text(canvas, (long)x, (long)(y + NUMBERS_TOP * scale), scale, ink, text);
    }
}
