/* view_overlap.c: how many splats light each pixel, as a heat map with its scale (Hoet 2014, figure
 * 18). Rendering time goes by this number, and noise by one over its root. The estimator runs as in
 * a render, with a filter that counts (kernel_profile_count).
 */
#include "debug/debug.h"
#include "debug/legend.h"
#include "pipeline/render.h"
#include <math.h>
#include <stdio.h>

struct counts {
    double sum, largest;
    size_t pixels;
};

static ps_result count_splats(struct render *render, struct error *error)
{
    render->counts_splats = true;
    ps_result result = render_estimate(render, error);
    if (result == PS_OK && !render->has_splatter && render->pass.tile_count > 0)
        return error_set(error, PS_ERROR_INVALID,
                         "overlap: the estimator %s made no splats; try -p estimator=splat",
                         strategy_in(render, PS_ESTIMATOR)->type->name);
    if (result == PS_CANCELLED)
        return error_set(error, result, "interrupted");
    return result;
}

typedef void (*pixel_visitor)(void *user, size_t x, size_t y, float count);

/* Visits the pixels that see a surface. */
static void visit(const struct gbuffer *gbuffer, pixel_visitor visitor, void *user)
{
    for (size_t i = 0; i < (size_t)gbuffer->tile_count * PS_TILE_PIXELS; i++) {
        uint32_t x, y, tile = (uint32_t)(i / PS_TILE_PIXELS), lane = i % PS_TILE_PIXELS;
        if (gbuffer->tiles[tile].object[lane] != PS_NO_OBJECT &&
            gbuffer_pixel(gbuffer, tile, lane, &x, &y))
            visitor(user, x, y, gbuffer->tiles[tile].weight[lane]);
    }
}

static void add_up(void *user, size_t x, size_t y, float count)
{
    (void)x;
    (void)y;
    struct counts *counts = user;
    counts->sum += (double)count;
    counts->largest = fmax(counts->largest, (double)count);
    counts->pixels++;
}

struct painting {
    struct canvas *canvas;
    struct legend_scale scale;
};

static void paint(void *user, size_t x, size_t y, float count)
{
    const struct painting *painting = user;
    canvas_set(painting->canvas, (long)x, (long)y, legend_colour(&painting->scale, (double)count));
}

static ps_result draw(struct render *render, const struct debug_options *options, int part,
                      struct canvas *canvas, struct error *error)
{
    (void)part;
    size_t width = render->film.width, height = render->film.height;
    struct counts counts = {0, 0, 0};
    ps_result result = count_splats(render, error);
    if (result == PS_OK)
        result = canvas_create(canvas, width, height + legend_height(width), error);
    if (result != PS_OK)
        return result;
    visit(&render->gbuffer, add_up, &counts);
    double mean = counts.pixels > 0 ? counts.sum / (double)counts.pixels : 0.0;
    struct painting painting = {
        .canvas = canvas,
        .scale.top = options->top > 0.0 ? options->top : legend_top(counts.largest),
    };
    char title[128];
    visit(&render->gbuffer, paint, &painting);
    snprintf(title, sizeof title, "splats a pixel: mean %.1f, most %.0f", mean, counts.largest);
    legend_draw_scale(canvas, height, title, &painting.scale);
    return PS_OK;
}

const struct debug_view debug_overlap = {.name = "overlap", .draw = draw};
