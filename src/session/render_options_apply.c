/* render_options_apply.c: options laid over a scene, and what they make of it. */
#include "base/parallel.h"
#include "base/param.h"
#include "parser/schema/schema.h"
#include "pipeline/render.h"
#include "session/preview.h"
#include "session/render_options.h"
#include "session/tiled_render.h"
#include <math.h>

#define DEFAULT_BATCH 4096

/* It was tried before. */
static void apply_word(const char *key, const char *word, struct render_description *render)
{
    struct error error;
    struct param_table table = schema_table(schema_only("render"));
    if (word)
        param_set(param_find(&table, key), render, word, &error);
}

/* Tiles are done one after the other, so that there is no picture, and no film, before the last. */
ps_result render_options_check(const struct render_options *options, struct error *error)
{
    const struct job_options *job = &options->job;
    const char *other = job->checkpoint                ? "--checkpoint"
                        : job->mpi                     ? "--mpi"
                        : job_options_have_budget(job) ? "--time and --error"
                        : isfinite(job->write_every)   ? "--write-every"
                                                       : NULL;
    if (options->tile > 0 && other)
        return error_set(error, PS_ERROR_INVALID, "--tile does not go with %s", other);
    return job_options_check(job, error);
}

ps_result render_options_check_files(const struct render_options *options, struct error *error)
{
    ps_result result = output_list_check(&options->output, error);
    if (result != PS_OK)
        return result;
    bool good = (!options->stats || output_check(options->stats, error)) &&
                (!options->job.checkpoint || output_check(options->job.checkpoint, error));
    return good ? PS_OK : PS_ERROR_IO;
}

ps_result render_options_check_not_input(const struct render_options *options,
                                         const struct scene_description *description,
                                         struct error *error)
{
    ps_result result = output_list_check_not_input(&options->output, description, error);
    if (result != PS_OK || !options->stats)
        return result;
    return output_check_not_input(options->stats, "--stats", description, error) ? PS_OK
                                                                                 : PS_ERROR_INVALID;
}

bool render_options_keep_film(const struct render_options *options)
{
    return options->job.checkpoint || options->job.mpi;
}

ps_result render_options_apply(const struct render_options *options, struct scene_input *input)
{
    struct scene_description *description = &input->description;
    for (size_t i = 0; i < options->plugins.count; i++) {
        ps_result result = scene_input_override(input, options->plugins.words[i]);
        if (result != PS_OK)
            return result;
    }
    if (options->seed >= 0)
        description->render.seed = (int64_t)options->seed;
    if (options->direct_resolution > 0)
        description->render.direct_resolution = (int64_t)options->direct_resolution;
    if (options->preview)
        preview_shrink(&description->image);
    if (options->width > 0) {
        description->image.width = options->width;
        description->image.height = options->height;
    }
    if (!isnan(options->exposure))
        description->image.exposure = options->exposure;
    apply_word("bounces", options->bounces, &description->render);
    apply_word("quality", options->quality, &description->render);
    if (options->direct >= 0)
        description->render.direct = options->direct;
    return PS_OK;
}

/* The part that is asked for; none where that is all of the picture. */
static struct rectangle crop_of(const struct render_options *options,
                                const struct image_description *image)
{
    bool all = options->crop.width == (size_t)image->width &&
               options->crop.height == (size_t)image->height;
    return all && options->crop.x == 0 && options->crop.y == 0 ? (struct rectangle){0}
                                                               : options->crop;
}

ps_result render_options_resolve(const struct render_options *options,
                                 const struct scene_description *description,
                                 struct diagnostics *sink, struct render_settings *settings)
{
    uint32_t threads =
        options->threads > 0 ? (uint32_t)options->threads : parallel_processor_count();
    size_t batch = options->batch > 0 ? (size_t)options->batch : DEFAULT_BATCH;
    ps_result result = scene_input_resolve(&description->render, threads, batch, sink, settings);
    if (result != PS_OK)
        return result;
    settings->isa = options->isa;
    settings->crop = crop_of(options, &description->image);
    settings->tile = (uint32_t)options->tile;
    settings->memory_limit = options->scene.psd.memory_limit;
    if (options->passes.is_given) {
        settings->first_pass = options->passes.first;
        settings->passes = options->passes.end;
    }
    return PS_OK;
}

void render_options_adapt_preview(const struct render_options *options, const struct scene *scene,
                                  struct render_settings *settings)
{
    if (options->preview && scene_chooses_lights(scene))
        settings->discontinuity_buffer = false;
}

ps_result render_options_check_size(const struct render_options *options,
                                    const struct image_description *image,
                                    const struct render_settings *settings, struct error *error)
{
    size_t width = (size_t)image->width, height = (size_t)image->height;
    struct render_settings part = *settings;
    if (part.tile > 0 && part.crop.width > 0)
        return error_set(error, PS_ERROR_INVALID, "--tile does not go with --crop");
    ps_result result = part.tile > 0 ? tiled_render_prepare(&part, width, height, error)
                                     : render_check_crop(&part, width, height, error);
    bool keeps_film = render_options_keep_film(options);
    return result == PS_OK ? render_check_memory(&part, width, height, keeps_film, error) : result;
}
