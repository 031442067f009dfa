/* crop.c: whether a part of the picture can be rendered alone, and what of it may not match the
 * whole.
 *
 * A part's film is that of the whole picture, bit for bit: random numbers go by pixels of the
 * picture, and its window holds the tiles that means over neighbours look at (film/gbuffer.h). An
 * estimator that cannot keep to that is refused. Of what makes a picture of the film, a filter that
 * reaches past the part's border, or a number that follows from all pixels, is another one than in
 * the whole: there is a warning. Where parts make up a picture (render_run_parts), only the
 * denoiser may be such a filter, and it gets a margin.
 */
#include "pipeline/render.h"
#include "pipeline/stages.h"
#include "plugin/shared_params.h"

#include <stdio.h>

/* By which option a part is rendered. */
static const char *option_of(const struct render_settings *settings)
{
    return settings->tile > 0 ? "--tile" : "--crop";
}

ps_result render_check_crop(const struct render_settings *settings, size_t width, size_t height,
                            struct error *error)
{
    const struct rectangle *crop = &settings->crop;
    const struct strategy_type *estimator = settings->strategies[PS_ESTIMATOR].type;
    if (crop->width == 0)
        return PS_OK;
    if (!rectangle_fits(*crop, width, height))
        return error_set(error, PS_ERROR_INVALID,
                         "--crop: %zu,%zu,%zu,%zu reaches out of the picture of %zux%zu pixels",
                         crop->x, crop->y, crop->width, crop->height, width, height);
    if (!(estimator->table.estimator.flags & PS_ESTIMATOR_CROPS))
        return error_set(error, PS_ERROR_INVALID,
                         "%s: estimator %.80s does not say that it can render a part of a "
                         "picture (PS_ESTIMATOR_CROPS); psplat(1) tells which cannot",
                         option_of(settings), estimator->name);
    return PS_OK;
}

static bool goes_by_others(const struct render_settings *settings, ps_kind kind)
{
    const struct strategy *strategy = &settings->strategies[kind];
    const union strategy_table *table = &strategy->type->table;
    if (kind == PS_NORMALIZATION)
        return !(table->normalization.flags & PS_NORMALIZATION_CROPS);
    if (kind == PS_DENOISER)
        return table->denoiser.filter != NULL;
    if (!settings->display)
        return false;
    if (kind == PS_BLOOM)
        return table->bloom.spread != NULL;
    return ((const struct tonemap_params *)strategy_shared(strategy))->exposure.choice >= 0;
}

ps_result render_check_parts(const struct render_settings *settings, size_t width, size_t height,
                             struct error *error)
{
    ps_result result = render_check_crop(settings, width, height, error);
    for (int kind = PS_NORMALIZATION; kind < PS_KINDS && result == PS_OK; kind++)
        if (kind != PS_DENOISER && goes_by_others(settings, (ps_kind)kind))
            result = error_set(error, PS_ERROR_INVALID,
                               "%s: %s %.80s goes by all of the picture, of which there are parts",
                               option_of(settings), kinds[kind].name,
                               settings->strategies[kind].type->name);
    return result;
}

void crop_warn(const struct render *render)
{
    const struct film *film = &render->film;
    const ps_host *host = own_host(render);
    if (render->parts > 1 ||
        (film->width >= film->window.picture_width && film->height >= film->window.picture_height))
        return;
    for (int kind = PS_NORMALIZATION; kind < PS_KINDS; kind++) {
        char warning[400];
        if (!goes_by_others(render->settings, (ps_kind)kind))
            continue;
        snprintf(warning, sizeof warning,
                 "--crop: %s %.80s may go by other pixels, and sees those of this part alone: "
                 "the picture may differ from that part of the whole",
                 kinds[kind].name, strategy_in(render, (ps_kind)kind)->type->name);
        host->log(host, PS_LOG_WARNING, warning);
    }
}
