/* preview.c: psplat_preview: a picture of few pixels. */
#include "api/rendering.h"
#include "pipeline/planes.h"
#include "session/layers.h"

#include <math.h>

/* The layers that are asked for, and what a display shows. */
static void set_wishes(const psplat_scene *scene, struct render_settings *settings)
{
    const char *layers = output_options_layers(&scene->options.output.options);
    settings->picture_alone = !layers_any(layers);
    settings->no_error_layer = !layers_have_error(layers);
    settings->display = true;
    settings->exposure = scene->input.description.image.exposure;
}

struct preview {
    double pixels;
    psplat_picture **picture;
};

static ps_result run(psplat_rendering *rendering, void *user, struct error *error)
{
    const struct preview *preview = user;
    const struct scene *scene = &rendering->scene->scene;
    const struct render_callbacks callbacks = rendering_callbacks(rendering);
    struct render_settings *settings = &rendering->settings;
    struct image image;
    struct rectangle crop = settings->crop;
    struct rectangle window = planes_window(settings, scene->width, scene->height);
    double all = (double)window.width * (double)window.height;
    double step = fmax(sqrt(all / fmax(preview->pixels, 1.0)), 1.0);
    set_wishes(rendering->scene, settings);
    settings->tile = 0;
    ps_result result =
        render_coarse(scene, settings, step, &callbacks, &rendering->statistics, &image, error);
    settings->crop = crop;
    if (result == PS_OK)
        return rendering_wrap(rendering, &image, 0, preview->picture, error);
    image_release(&image);
    return result;
}

ps_result psplat_preview(const psplat_scene *scene, size_t pixels,
                         const psplat_callbacks *callbacks, psplat_picture **picture,
                         psplat_error *error)
{
    psplat_rendering rendering = {.scene = scene, .is_preview = true};
    struct preview preview = {(double)pixels, picture};
    *picture = NULL;
    return rendering_do(&rendering, callbacks, run, &preview, error);
}
