/* view_photons.c: where indirect light comes from: the photons of a pass as dots (Hoet 2014, figure
 * 2). After stratification, so that merged ones are seen as what they became. Those that something
 * hides are left out: drawn through walls, all that is behind a picture would lie on it.
 */
#include "debug/backdrop.h"
#include "debug/debug.h"
#include "debug/id_colour.h"
#include "debug/legend.h"
#include "debug/project.h"
#include "debug/selection.h"
#include <psplat/math.h>
#include <stdio.h>

#define MOST_DOTS 20000
#define MOST_BOUNCES 9u /* with a colour of their own; later ones share it */
#define DARKEST 0.3     /* see legend_scale */

struct dot {
    float x, y, power;
    unsigned bounce;
};

static ps_result collect(struct render *render, struct selection *dots, uint64_t *photons,
                         struct error *error)
{
    const ps_photon *batch;
    size_t n;
    const ps_host *host = own_host(render);
    *photons = 0;
    do {
        ps_result result = photon_stream_next(&render->photons, &batch, &n, error);
        if (result != PS_OK)
            return result;
        for (size_t i = 0; i < n; i++) {
            struct dot dot = {.power = ps_luminance(batch[i].power), .bounce = batch[i].bounce};
            if (project_visible(render, batch[i].position, batch[i].normal, &dot.x, &dot.y))
                selection_offer(dots, &dot);
        }
        *photons += n;
        host->progress(host, photon_stream_progress(&render->photons));
    } while (n > 0);
    selection_finish(dots);
    return PS_OK;
}

static unsigned bounce_of(const struct dot *dot)
{
    return dot->bounce < MOST_BOUNCES ? dot->bounce : MOST_BOUNCES;
}

struct extent {
    float power;
    unsigned bounce;
};

static struct extent largest_of(const struct selection *dots)
{
    struct extent largest = {0.0f, 1};
    for (size_t i = 0; i < dots->count; i++) {
        const struct dot *dot = selection_item(dots, i);
        largest.power = fmaxf(largest.power, dot->power);
        largest.bounce = bounce_of(dot) > largest.bounce ? bounce_of(dot) : largest.bounce;
    }
    return largest;
}

/* In pixels: the fewer dots, the larger, so that they cover a tenth of the picture, but no more
 * than a point should be. */
static float radius_of(size_t dots, const struct canvas *canvas)
{
    float area = 0.1f * (float)(canvas->width * canvas->height) / (float)(dots > 0 ? dots : 1);
    float wanted = sqrtf(area / PS_PI), across = (float)canvas->width;
    return fmaxf(fminf(wanted, across / 160.0f), fmaxf(0.75f, across / 800.0f));
}

static void draw_dots(const struct selection *dots, bool by_bounce,
                      const struct legend_scale *scale, struct canvas *canvas)
{
    float radius = radius_of(dots->count, canvas);
    for (size_t i = 0; i < dots->count; i++) {
        const struct dot *dot = selection_item(dots, i);
        canvas_disc(canvas, dot->x, dot->y, radius,
                    by_bounce ? series_colour(bounce_of(dot))
                              : legend_colour(scale, (double)dot->power));
    }
}

static void draw_picture(const struct render *render, const struct debug_options *options,
                         const struct selection *dots, uint64_t photons, struct canvas *canvas)
{
    struct extent largest = largest_of(dots);
    struct legend_scale scale = {
        .top = options->top > 0.0 ? options->top : legend_top((double)largest.power),
        .darkest = DARKEST,
    };
    size_t bottom = render->film.height;
    char title[128];
    snprintf(title, sizeof title, "%s  %zu dots: %llu of %llu photons seen",
             options->by_bounce ? "bounce" : "power (W)", dots->count,
             (unsigned long long)dots->offered, (unsigned long long)photons);
    backdrop_draw(render, options->exposure, canvas);
    draw_dots(dots, options->by_bounce, &scale, canvas);
    if (options->by_bounce)
        legend_draw_series(canvas, bottom, title, largest.bounce);
    else
        legend_draw_scale(canvas, bottom, title, &scale);
}

static ps_result draw(struct render *render, const struct debug_options *options, int part,
                      struct canvas *canvas, struct error *error)
{
    (void)part;
    size_t width = render->film.width, height = render->film.height;
    struct selection dots;
    uint64_t photons;
    ps_result result = selection_create(&dots, options->count ? options->count : MOST_DOTS,
                                        sizeof(struct dot), error);
    if (result != PS_OK)
        return result;
    result = collect(render, &dots, &photons, error);
    if (result == PS_OK)
        result = canvas_create(canvas, width, height + legend_height(width), error);
    if (result == PS_OK)
        draw_picture(render, options, &dots, photons, canvas);
    selection_release(&dots);
    return result;
}

const struct debug_view debug_photons = {.name = "photons", .draw = draw};
