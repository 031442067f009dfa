#include "pipeline/planes.h"

static bool may_denoise(const struct render_settings *settings, bool keeps_film)
{
    return keeps_film || settings->strategies[PS_DENOISER].type->table.denoiser.filter;
}

/* Those of surfaces are half of the film's memory, and of the time that adding to it takes. */
static bool wants_surfaces(const struct render_settings *settings, bool keeps_film)
{
    return may_denoise(settings, keeps_film) || !settings->picture_alone;
}

/* Where a denoiser may smooth the direct light: it has noise, which halves of it tell, and nothing
 * else smooths it. Halves of each pass are best, since its samples look at the same places; but one
 * shadow ray, or one sample of gloss, has no halves, and then those of several passes tell more. */
static void add_reflected(struct planes *planes, const struct render_settings *settings,
                          const struct scene *scene)
{
    bool shadows = scene_samples_lights(scene) && !settings->discontinuity_buffer;
    bool halved_shadows = shadows && scene->light_samples > 1;
    bool halved_gloss = planes->gloss && settings->aa_samples > 1;
    bool all_halved = shadows == halved_shadows && planes->gloss == halved_gloss;
    planes->halves_of_pass = halved_shadows || halved_gloss;
    planes->halves_of_passes = planes->sums && !all_halved;
    planes->reflected = planes->halves_of_pass || planes->halves_of_passes;
    planes->reflected_hard = planes->reflected && shadows && scene_has_hard_shadows_apart(scene);
    planes->direct_half |= halved_shadows;
    planes->hard |= planes->reflected_hard;
}

static void add_of_scene(struct planes *planes, const struct render_settings *settings,
                         const struct scene *scene, uint32_t denoiser)
{
    planes->gloss = scene->microfacets && planes->surfaces;
    planes->caustics = scene->microfacets && !planes->splats;
    planes->geometric = (planes->splats || planes->caustics) && scene_has_shading_normals(scene);
    planes->discontinuity_buffer = settings->discontinuity_buffer && scene->has_area_lights;
    /* Halves of the direct light tell its noise from an edge, of which hard shadows have some. */
    planes->direct_half = planes->edges && scene_samples_lights(scene) && scene->light_samples > 1;
    planes->hard = planes->direct_half && scene_has_hard_shadows_apart(scene);
    if (denoiser & PS_DENOISER_DIRECT)
        add_reflected(planes, settings, scene);
}

struct planes planes_wanted(const struct render_settings *settings, const struct scene *scene,
                            bool sums, bool keeps_film)
{
    const struct strategy *strategies = settings->strategies;
    uint32_t estimator = strategies[PS_ESTIMATOR].type->table.estimator.flags;
    uint32_t denoiser =
        keeps_film ? UINT32_MAX : strategies[PS_DENOISER].type->table.denoiser.flags;
    struct planes planes = {
        .sums = sums,
        .surfaces = wants_surfaces(settings, keeps_film),
        .edges = settings->aa_samples > 1,
        .splats = (estimator & PS_ESTIMATOR_SPLATS) != 0,
        .radiance = (estimator & PS_ESTIMATOR_RADIANCE) != 0,
        .ids = (denoiser & PS_DENOISER_IDS) != 0,
        .odd = (denoiser & PS_DENOISER_HALVES) != 0 && sums,
        .variance = (estimator & PS_ESTIMATOR_VARIANCE) && (denoiser & PS_DENOISER_VARIANCE),
    };
    if (scene)
        add_of_scene(&planes, settings, scene, denoiser);
    planes.splatted = planes.caustics && may_denoise(settings, keeps_film);
    return planes;
}

struct rectangle planes_window(const struct render_settings *settings, size_t width, size_t height)
{
    return settings->crop.width > 0 ? settings->crop : (struct rectangle){0, 0, width, height};
}

struct gbuffer planes_layout(const struct render_settings *settings, size_t width, size_t height)
{
    return settings->crop.width > 0
               ? gbuffer_layout_around(settings->crop, settings->aa_samples > 1, width, height)
               : gbuffer_layout(width, height);
}
