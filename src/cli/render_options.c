#include "cli/render_options.h"

#include "base/parallel.h"
#include "base/param.h"
#include "base/text.h"
#include "cli/preview.h"
#include "parser/schema/schema.h"
#include <stdio.h>
#include <string.h>

#define DEFAULT_BATCH 4096

static bool take_option(struct render_options *options, const struct argument *argument)
{
    const char *name = argument->option->name, *value = argument->value;
    if (strcmp(name, "quiet") == 0)
        options->quiet = true;
    else if (strcmp(name, "preview") == 0)
        options->preview = true;
    else if (strcmp(name, "isa") == 0)
        options->isa = value;
    else if (strcmp(name, "size") == 0)
        options->size = value;
    else if (strcmp(name, "exposure") == 0)
        options->exposure = value;
    else if (strcmp(name, "bounces") == 0)
        options->bounces = value;
    else if (strcmp(name, "quality") == 0)
        options->quality = value;
    else if (strcmp(name, "direct") == 0)
        options->direct = value;
    else if (strcmp(name, "direct-resolution") == 0)
        return parse_whole_number(name, value, 1, 8192, &options->direct_resolution);
    else if (strcmp(name, "seed") == 0)
        return parse_whole_number(name, value, 0, 9007199254740992.0, &options->seed);
    else if (strcmp(name, "threads") == 0)
        return parse_whole_number(name, value, 1, 1024, &options->threads);
    else if (strcmp(name, "batch") == 0)
        return parse_whole_number(name, value, 1, 4096, &options->batch);
    return true; /* another's, or one that waits for the scene */
}

bool render_options_take(struct render_options *options, const struct argument *arguments,
                         size_t count)
{
    *options = (struct render_options){
        .seed = -1,
        .threads = -1,
        .batch = -1,
        .direct_resolution = -1,
        .arguments = arguments,
        .argument_count = count,
    };
    for (size_t i = 0; i < count; i++)
        if (arguments[i].option && !take_option(options, &arguments[i]))
            return false;
    return scene_options_take(&options->scene, arguments, count);
}

void render_options_release(struct render_options *options)
{
    scene_options_release(&options->scene);
}

static bool override_size(const char *text, struct image_description *image)
{
    size_t length = strcspn(text, "x");
    double w, h;
    if (!text[length] || !text_part_to_number(text, length, &w) ||
        !text_to_number(text + length + 1, &h) || w < 1 || h < 1 || w > 65536 || h > 65536 ||
        w != (double)(int64_t)w || h != (double)(int64_t)h) {
        fprintf(stderr, "psplat: error: --size: expected WxH, each 1..65536, got '%s'\n", text);
        return false;
    }
    image->width = (int64_t)w;
    image->height = (int64_t)h;
    return true;
}

/* As the render section of a file reads it. */
static bool override_setting(const char *key, const char *text, struct render_description *render)
{
    struct error error;
    struct param_table table = schema_table(schema_only("render"));
    if (!text || param_set(param_find(&table, key), render, text, &error) == PS_OK)
        return true;
    fprintf(stderr, "psplat: error: --%s: %s\n", key, error.text);
    return false;
}

static bool override_direct(const char *text, int32_t *direct)
{
    bool maps = strcmp(text, "shadowmap") == 0;
    if (!maps && strcmp(text, "rays") != 0) {
        fprintf(stderr, "psplat: error: --direct: expected rays or shadowmap, got '%s'\n", text);
        return false;
    }
    *direct = maps ? DIRECT_SHADOWMAP : DIRECT_RAYS;
    return true;
}

/* Lays the command line over the scene. */
static bool override(const struct render_options *options, struct scene_input *input)
{
    struct scene_description *description = &input->description;
    for (size_t i = 0; i < options->argument_count; i++) {
        const struct argument *argument = &options->arguments[i];
        if (argument_is(argument, "plugin") && !scene_input_override(input, argument->value))
            return false;
    }
    if (options->seed >= 0)
        description->render.seed = (int64_t)options->seed;
    if (options->direct_resolution > 0)
        description->render.direct_resolution = (int64_t)options->direct_resolution;
    if (options->preview)
        preview_shrink(&description->image);
    return (!options->size || override_size(options->size, &description->image)) &&
           (!options->exposure ||
            parse_exposure(options->exposure, &description->image.exposure)) &&
           override_setting("bounces", options->bounces, &description->render) &&
           override_setting("quality", options->quality, &description->render) &&
           (!options->direct || override_direct(options->direct, &description->render.direct));
}

bool render_options_load(const struct render_options *options, struct scene_input *input,
                         struct render_settings *settings)
{
    uint32_t threads =
        options->threads > 0 ? (uint32_t)options->threads : parallel_processor_count();
    size_t batch = options->batch > 0 ? (size_t)options->batch : DEFAULT_BATCH;
    if (!scene_input_read(input, options->scene_path, &options->scene) ||
        !override(options, input) || !scene_input_resolve(input, threads, batch, settings))
        return false;
    settings->isa = options->isa;
    return true;
}
