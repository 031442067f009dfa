/* display.c: what a display shows of a picture, as the layer `display`: exposure, bloom, tone map.
 *
 * Radiance is multiplied by 2 to the power of two numbers of stops: that of the image (or
 * --exposure), and that of the tone map, which may follow from the picture (image/exposure.h). So
 * the first one corrects what the second finds. The layers of radiance stay as they are. Values are
 * linear, 0..1: the sRGB transfer function belongs to files of bytes.
 */
#include "base/clock.h"
#include "base/parallel.h"
#include "image/exposure.h"
#include "pipeline/render.h"
#include "pipeline/stages.h"
#include "plugin/shared_params.h"
#include <math.h>
#include <string.h>

/* Of what is shown. Brighter light would leave no bits for other pixels in the sums of a blur. */
#define BRIGHTEST 1e15f

static const char *const names[3] = {"display.R", "display.G", "display.B"};

ps_result display_add(struct image *image, struct error *error)
{
    for (int c = 0; c < 3; c++)
        if (!image_add_channel(image, names[c]))
            return error_memory(error, image->width * image->height * sizeof(float),
                                "the layer display");
    return PS_OK;
}

/* --- exposure
 * ----------------------------------------------------------------------------------- */

static double stops_of(const struct render *render, const float *const light[3], size_t pixels)
{
    const struct tonemap_params *params = strategy_shared(strategy_in(render, PS_TONEMAP));
    bool automatic = params->exposure.choice >= 0;
    return render->settings->exposure +
           (automatic ? exposure_automatic(light, pixels) : params->exposure.number);
}

struct exposing {
    const float *const *light;
    const ps_display_view *view;
    float factor;
};

/* What is no number becomes 0. */
static void expose_row(void *user, uint64_t row, uint32_t worker)
{
    const struct exposing *exposing = user;
    float *const shown[3] = {exposing->view->r, exposing->view->g, exposing->view->b};
    size_t width = exposing->view->width, first = row * width;
    (void)worker;
    for (int c = 0; c < 3; c++)
        for (size_t i = first; i < first + width; i++)
            shown[c][i] = fminf(fmaxf(exposing->light[c][i] * exposing->factor, 0.0f), BRIGHTEST);
}

static void expose(const struct render *render, const float *const light[3],
                   const ps_display_view *view)
{
    double stops = stops_of(render, light, (size_t)view->width * view->height);
    struct exposing exposing = {light, view, (float)exp2(stops)};
    parallel_for(render->settings->workers, view->height, expose_row, &exposing);
}

/* --- bloom and tone map
 * ------------------------------------------------------------------------- */

static ps_result run_stage(struct render *render, ps_kind kind, const ps_display_view *view,
                           uint64_t *refused, struct error *error)
{
    const struct strategy *strategy = strategy_in(render, kind);
    const union strategy_table *table = &strategy->type->table;
    ps_result (*stage)(const void *, const ps_host *, const ps_display_view *) =
        kind == PS_BLOOM ? table->bloom.spread : table->tonemap.map;
    size_t pixels = (size_t)view->width * view->height;
    if (!stage)
        return PS_OK;
    ps_result result = stage(strategy->state, strategy->host, view);
    result = render_judge(render, kind, result, error);
    if (result == PS_OK)
        *refused +=
            mend_plane(view->r, pixels) + mend_plane(view->g, pixels) + mend_plane(view->b, pixels);
    return result;
}

static void clip_row(void *user, uint64_t row, uint32_t worker)
{
    const ps_display_view *view = user;
    float *const shown[3] = {view->r, view->g, view->b};
    size_t width = view->width, first = row * width;
    (void)worker;
    for (int c = 0; c < 3; c++)
        for (size_t i = first; i < first + width; i++)
            shown[c][i] = fminf(shown[c][i], 1.0f);
}

/* `failed` becomes the kind that does not do its work. */
static ps_result fill(struct render *render, const float *const light[3], ps_display_view *view,
                      ps_kind *failed, struct error *error)
{
    static const ps_kind kinds_in_order[2] = {PS_BLOOM, PS_TONEMAP};
    uint64_t *refused = &render->refused.pixels[3];
    ps_result result = PS_OK;
    expose(render, light, view);
    for (int i = 0; i < 2 && result == PS_OK; i++) {
        *failed = kinds_in_order[i];
        result = run_stage(render, kinds_in_order[i], view, &refused[i], error);
    }
    parallel_for(render->settings->workers, view->height, clip_row, view);
    return result;
}

static ps_display_view view_of(float *const planes[3], size_t width, size_t height)
{
    return (ps_display_view){
        .size = sizeof(ps_display_view),
        .width = (uint32_t)width,
        .height = (uint32_t)height,
        .r = planes[0],
        .g = planes[1],
        .b = planes[2],
    };
}

static float *plane_of(const struct image *image, const char *name)
{
    size_t i = 0;
    while (strcmp(image->channels[i].name, name) != 0)
        i++;
    return image->channels[i].samples;
}

ps_result display_fill(struct render *render, const float *const light[3], struct image *image,
                       struct error *error)
{
    float *const planes[3] = {plane_of(image, names[0]), plane_of(image, names[1]),
                              plane_of(image, names[2])};
    ps_display_view view = view_of(planes, image->width, image->height);
    ps_kind failed;
    double start = clock_seconds();
    ps_result result = fill(render, light, &view, &failed, error);
    if (result != PS_OK) {
        leave_out(render, failed, result, "is shown without bloom and tone map", error);
        expose(render, light, &view);
        parallel_for(render->settings->workers, view.height, clip_row, &view);
    }
    statistics_add_seconds(render->statistics, "display", clock_seconds() - start);
    return result;
}

ps_result display_show(struct render *render, float *const planes[3], size_t width, size_t height,
                       struct error *error)
{
    const float *const light[3] = {planes[0], planes[1], planes[2]};
    ps_display_view view = view_of(planes, width, height);
    ps_kind failed;
    ps_result result = fill(render, light, &view, &failed, error);
    if (result == PS_CANCELLED)
        error_set(error, result, "%s %.80s was stopped", kinds[failed].name,
                  strategy_in(render, failed)->type->name);
    return result;
}
