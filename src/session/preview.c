#include "session/preview.h"

#include <math.h>

#define WIDTH 640.0
#define HEIGHT 360.0

static const char *const sets[] = {
    "render.light_samples=2",
    "render.discontinuity_buffer=yes",
    "render.aa_samples=4",
};

static const char *const plugins[] = {
    "injection=photon:count=10000",
    "stratification=none",
    "visibility=shadowmap:radius=auto,resolution=4",
    "estimator=splat:interleave=4,gather_rays=0",
    "denoiser=none",
};

ps_result preview_apply(struct render_options *options, struct error *error)
{
    ps_result result = PS_OK;
    options->preview = true;
    if (!options->passes.is_given)
        options->passes = (struct pass_range){.is_given = true, .end = 1};
    for (size_t i = 0; i < sizeof sets / sizeof sets[0] && result == PS_OK; i++)
        result = scene_options_add_set(&options->scene, i, sets[i], error);
    for (size_t i = 0; i < sizeof plugins / sizeof plugins[0] && result == PS_OK; i++)
        result = word_list_insert(&options->plugins, i, plugins[i], error);
    return result;
}

void preview_shrink(struct image_description *image)
{
    double scale = fmin(WIDTH / (double)image->width, HEIGHT / (double)image->height);
    if (scale >= 1.0)
        return;
    image->width = (int64_t)fmax(1.0, round((double)image->width * scale));
    image->height = (int64_t)fmax(1.0, round((double)image->height * scale));
}
