#include "session/render_options.h"

#include "base/param.h"
#include "base/suggestion.h"
#include "parser/schema/schema.h"
#include "session/option_value.h"
#include "session/preview.h"
#include "session/tiled_render.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct render_options render_options_init(void)
{
    return (struct render_options){
        .job = job_options_init(),
        .seed = -1,
        .threads = -1,
        .batch = -1,
        .direct_resolution = -1,
        .exposure = NAN,
        .direct = -1,
    };
}

void render_options_release(struct render_options *options)
{
    scene_options_release(&options->scene);
    output_list_release(&options->output);
    job_options_release(&options->job);
    word_list_release(&options->plugins);
    free(options->stats);
    free(options->isa);
    free(options->bounces);
    free(options->quality);
    *options = render_options_init();
}

/* --- one function for each option
 * ------------------------------------------------------------------- */

static ps_result set_parameter(struct render_options *options, const char *value,
                               struct error *error)
{
    return scene_options_add_parameter(&options->scene, value, error);
}

static ps_result set_set(struct render_options *options, const char *value, struct error *error)
{
    return scene_options_add_set(&options->scene, options->scene.sets.count, value, error);
}

static ps_result set_camera(struct render_options *options, const char *value, struct error *error)
{
    if (!value[0])
        return error_set(error, PS_ERROR_INVALID, "--camera: a name is missing");
    return word_replace(&options->scene.camera, value, error);
}

static ps_result set_cache(struct render_options *options, const char *value, struct error *error)
{
    return scene_options_cache(&options->scene, value, error);
}

static ps_result set_texture_memory(struct render_options *options, const char *value,
                                    struct error *error)
{
    return option_bytes("texture-memory", value, &options->scene.psd.texture_memory, error);
}

static ps_result set_restrict(struct render_options *options, const char *value,
                              struct error *error)
{
    return scene_options_restrict(&options->scene, value, error);
}

static ps_result set_allow_plugins(struct render_options *options, const char *value,
                                   struct error *error)
{
    (void)value;
    return scene_options_allow_plugins(&options->scene, error);
}

static ps_result set_plugin(struct render_options *options, const char *value, struct error *error)
{
    ps_kind kind;
    struct strategy_choice choice;
    ps_result result = option_plugin(value, &kind, &choice, error);
    if (result != PS_OK)
        return result;
    strategy_choice_release(&choice);
    return word_list_insert(&options->plugins, options->plugins.count, value, error);
}

static ps_result set_size(struct render_options *options, const char *value, struct error *error)
{
    return option_size(value, &options->width, &options->height, error);
}

static ps_result set_crop(struct render_options *options, const char *value, struct error *error)
{
    struct rectangle crop;
    ps_result result = option_rectangle("crop", value, &crop, error);
    if (result != PS_OK)
        return result;
    if (crop.width == 0 || crop.height == 0)
        return error_set(error, PS_ERROR_INVALID,
                         "--crop: a part has at least one pixel, '%.500s' has none", value);
    options->crop = crop;
    return PS_OK;
}

static ps_result set_tile(struct render_options *options, const char *value, struct error *error)
{
    double side;
    ps_result result = option_whole_number("tile", value, TILE_STEP, 65536, &side, error);
    if (result != PS_OK)
        return result;
    if (fmod(side, TILE_STEP) != 0)
        return error_set(error, PS_ERROR_INVALID, "--tile: %s is no multiple of %d", value,
                         TILE_STEP);
    options->tile = side;
    return PS_OK;
}

/* As the render section of a file reads it, which is tried on a description that nobody uses. */
static ps_result set_word(const char *key, const char *value, char **word, struct error *error)
{
    struct param_table table = schema_table(schema_only("render"));
    struct render_description unused = {0};
    struct error reason;
    if (param_set(param_find(&table, key), &unused, value, &reason) != PS_OK)
        return error_set(error, PS_ERROR_INVALID, "--%s: %.4000s", key, reason.text);
    return word_replace(word, value, error);
}

static ps_result set_quality(struct render_options *options, const char *value, struct error *error)
{
    return set_word("quality", value, &options->quality, error);
}

static ps_result set_bounces(struct render_options *options, const char *value, struct error *error)
{
    return set_word("bounces", value, &options->bounces, error);
}

static ps_result set_passes(struct render_options *options, const char *value, struct error *error)
{
    return pass_range_parse(value, &options->passes, error);
}

static ps_result set_seed(struct render_options *options, const char *value, struct error *error)
{
    return option_whole_number("seed", value, 0, 9007199254740992.0, &options->seed, error);
}

static ps_result set_threads(struct render_options *options, const char *value, struct error *error)
{
    return option_whole_number("threads", value, 1, 1024, &options->threads, error);
}

static ps_result set_isa(struct render_options *options, const char *value, struct error *error)
{
    struct error reason;
    if (settings_check_isa(value, &reason) != PS_OK)
        return error_set(error, PS_ERROR_INVALID, "--isa: %.1000s", reason.text);
    return word_replace(&options->isa, value, error);
}

static ps_result set_batch(struct render_options *options, const char *value, struct error *error)
{
    return option_whole_number("batch", value, 1, 4096, &options->batch, error);
}

static ps_result set_direct(struct render_options *options, const char *value, struct error *error)
{
    bool maps = strcmp(value, "shadowmap") == 0;
    if (!maps && strcmp(value, "rays") != 0)
        return error_set(error, PS_ERROR_INVALID,
                         "--direct: expected rays or shadowmap, got '%.500s'", value);
    options->direct = maps ? DIRECT_SHADOWMAP : DIRECT_RAYS;
    return PS_OK;
}

static ps_result set_direct_resolution(struct render_options *options, const char *value,
                                       struct error *error)
{
    return option_whole_number("direct-resolution", value, 1, 8192, &options->direct_resolution,
                               error);
}

static ps_result set_exposure(struct render_options *options, const char *value,
                              struct error *error)
{
    return option_exposure(value, &options->exposure, error);
}

static ps_result set_memory_limit(struct render_options *options, const char *value,
                                  struct error *error)
{
    return option_bytes("memory-limit", value, &options->scene.psd.memory_limit, error);
}

static ps_result set_layers(struct render_options *options, const char *value, struct error *error)
{
    return output_options_set(&options->output.options, "layers", value, error);
}

static ps_result set_compression(struct render_options *options, const char *value,
                                 struct error *error)
{
    return output_options_set(&options->output.options, "compression", value, error);
}

static ps_result set_output(struct render_options *options, const char *value, struct error *error)
{
    return output_list_add(&options->output, value, error);
}

static ps_result set_stats(struct render_options *options, const char *value, struct error *error)
{
    return word_replace(&options->stats, value, error);
}

static ps_result set_time(struct render_options *options, const char *value, struct error *error)
{
    return option_time("time", value, &options->job.seconds, error);
}

static ps_result set_error(struct render_options *options, const char *value, struct error *error)
{
    return option_percent("error", value, &options->job.error, error);
}

static ps_result set_write_every(struct render_options *options, const char *value,
                                 struct error *error)
{
    return option_time("write-every", value, &options->job.write_every, error);
}

static ps_result set_checkpoint(struct render_options *options, const char *value,
                                struct error *error)
{
    return job_options_set_checkpoint(&options->job, value, error);
}

static ps_result set_checkpoint_every(struct render_options *options, const char *value,
                                      struct error *error)
{
    return option_time("checkpoint-every", value, &options->job.checkpoint_every, error);
}

static ps_result set_resume(struct render_options *options, const char *value, struct error *error)
{
    (void)value;
    (void)error;
    options->job.resume = true;
    return PS_OK;
}

static ps_result set_mpi(struct render_options *options, const char *value, struct error *error)
{
    (void)value;
    (void)error;
    options->job.mpi = true;
    return PS_OK;
}

static ps_result set_preview(struct render_options *options, const char *value, struct error *error)
{
    (void)value;
    return options->preview ? PS_OK : preview_apply(options, error);
}

static const struct row {
    const char *name;
    bool is_flag;
    ps_result (*set)(struct render_options *options, const char *value, struct error *error);
} rows[] = {
    /* the scene as it is read */
    {"param", false, set_parameter},
    {"set", false, set_set},
    {"camera", false, set_camera},
    {"restrict", false, set_restrict},
    {"cache", false, set_cache},
    {"texture-memory", false, set_texture_memory},
    {"allow-scene-plugins", true, set_allow_plugins},
    /* what it is rendered with */
    {"plugin", false, set_plugin},
    {"size", false, set_size},
    {"crop", false, set_crop},
    {"tile", false, set_tile},
    {"quality", false, set_quality},
    {"bounces", false, set_bounces},
    {"passes", false, set_passes},
    {"seed", false, set_seed},
    {"threads", false, set_threads},
    {"isa", false, set_isa},
    {"batch", false, set_batch},
    {"direct", false, set_direct},
    {"direct-resolution", false, set_direct_resolution},
    {"exposure", false, set_exposure},
    {"memory-limit", false, set_memory_limit},
    {"preview", true, set_preview},
    /* when it ends, and what is kept */
    {"time", false, set_time},
    {"error", false, set_error},
    {"checkpoint", false, set_checkpoint},
    {"checkpoint-every", false, set_checkpoint_every},
    {"resume", true, set_resume},
    {"mpi", true, set_mpi},
    /* what is written */
    {"output", false, set_output},
    {"layers", false, set_layers},
    {"compression", false, set_compression},
    {"write-every", false, set_write_every},
    {"stats", false, set_stats},
};

#define ROWS (sizeof rows / sizeof rows[0])

static const struct row *find(const char *name)
{
    for (size_t i = 0; i < ROWS; i++)
        if (strcmp(rows[i].name, name) == 0)
            return &rows[i];
    return NULL;
}

bool render_options_has(const char *name)
{
    return find(name) != NULL;
}

bool render_options_is_flag(const char *name)
{
    const struct row *row = find(name);
    return row && row->is_flag;
}

static ps_result unknown(const char *name, struct error *error)
{
    struct suggestion suggestion = suggestion_start(name);
    char hint[SUGGESTION_TEXT];
    for (size_t i = 0; i < ROWS; i++)
        suggestion_consider(&suggestion, rows[i].name);
    suggestion_text(&suggestion, hint);
    return error_set(error, PS_ERROR_INVALID, "unknown option '%.200s'%s", name, hint);
}

ps_result render_options_set(struct render_options *options, const char *name, const char *value,
                             struct error *error)
{
    const struct row *row = find(name);
    if (!row)
        return unknown(name, error);
    if (row->is_flag != !value)
        return error_set(error, PS_ERROR_INVALID, "--%s: %s", name,
                         value ? "it takes no value" : "a value is missing");
    return row->set(options, value, error);
}
