/* view_pixel.c: where the light of one pixel comes from: the photons whose splats light it, each
 * joined with it by a line, the brightest on top. Photons that something hides from the camera have
 * a dimmed line and no dot.
 */
#include "debug/backdrop.h"
#include "debug/debug.h"
#include "debug/legend.h"
#include "debug/pixel_light.h"
#include <psplat/math.h>
#include <stdio.h>

#define MOST_SOURCES 200
#define DARKEST 0.3 /* see legend_scale */

struct view {
    struct legend_scale scale;
    float x, y; /* the middle of the pixel */
    struct canvas *canvas;
};

static struct colour dim(struct colour colour)
{
    return (struct colour){(uint8_t)(colour.r / 2), (uint8_t)(colour.g / 2),
                           (uint8_t)(colour.b / 2)};
}

static void draw_source(const struct view *view, const struct pixel_source *source)
{
    float radius = fmaxf(1.5f, (float)view->canvas->width / 300.0f);
    struct colour colour = legend_colour(&view->scale, (double)ps_luminance(source->irradiance));
    if (source->sight == BEHIND_CAMERA)
        return;
    canvas_line(view->canvas, source->x, source->y, view->x, view->y,
                source->sight == SEEN ? colour : dim(colour));
    if (source->sight == SEEN)
        canvas_disc(view->canvas, source->x, source->y, radius, colour);
}

static void mark_pixel(const struct view *view)
{
    static const struct colour ink = {255, 255, 255};
    float reach = fmaxf(4.0f, (float)view->canvas->width / 60.0f);
    for (int side = -1; side <= 1; side += 2) {
        float near = 0.4f * (float)side * reach, far = (float)side * reach;
        canvas_line(view->canvas, view->x + near, view->y, view->x + far, view->y, ink);
        canvas_line(view->canvas, view->x, view->y + near, view->x, view->y + far, ink);
    }
}

/* In the order in which they shine, so that the brightest are on top. */
static void draw_picture(const struct render *render, const struct debug_options *options,
                         const struct pixel_light *light, struct canvas *canvas)
{
    size_t most = options->count ? options->count : MOST_SOURCES;
    size_t drawn = light->source_count < most ? light->source_count : most;
    double brightest = drawn > 0 ? (double)ps_luminance(light->sources[0].irradiance) : 0.0;
    const struct view view = {
        .scale = {options->top > 0.0 ? options->top : legend_top(brightest), DARKEST},
        .x = (float)options->pixel[0] + 0.5f,
        .y = (float)options->pixel[1] + 0.5f,
        .canvas = canvas,
    };
    size_t bottom = render->film.height;
    char title[160];
    backdrop_draw(render, options->exposure, canvas);
    for (size_t i = drawn; i > 0; i--)
        draw_source(&view, &light->sources[i - 1]);
    mark_pixel(&view);
    canvas_fill(canvas, (struct rectangle){0, bottom, canvas->width, canvas->height - bottom},
                (struct colour){0, 0, 0});
    snprintf(title, sizeof title, "W/m2 at (%u, %u): %.3g by %zu of %llu photons",
             options->pixel[0], options->pixel[1], (double)ps_luminance(light->irradiance),
             light->source_count, (unsigned long long)light->photon_count);
    legend_draw_scale(canvas, bottom, title, &view.scale);
}

static ps_result draw(struct render *render, const struct debug_options *options, int part,
                      struct canvas *canvas, struct error *error)
{
    (void)part;
    size_t width = render->film.width, height = render->film.height;
    struct debug_options chosen = *options;
    struct pixel_light light;
    if (!chosen.has_pixel) {
        chosen.pixel[0] = (uint32_t)width / 2;
        chosen.pixel[1] = (uint32_t)height / 2;
    }
    ps_result result = pixel_light_find(render, chosen.pixel[0], chosen.pixel[1], &light, error);
    if (result == PS_OK)
        result = canvas_create(canvas, width, height + legend_height(width), error);
    if (result == PS_OK)
        draw_picture(render, &chosen, &light, canvas);
    pixel_light_release(&light);
    return result;
}

const struct debug_view debug_pixel = {.name = "pixel", .draw = draw};
