#include "render/settings.h"

#include "settings/quality.h"
#include "splat/kernel.h"

#include <stdio.h>
#include <string.h>

static const struct origin nowhere = {.file = NULL};

struct resolution {
    struct loader *loader;
    settings_report report;
    void *user;
    double effort;
    ps_result result; /* the first failure's */
};

static void fail(struct resolution *resolution, ps_result result, const struct origin *origin,
                 const char *message)
{
    if (resolution->result == PS_OK)
        resolution->result = result;
    resolution->report(resolution->user, origin, message);
}

static void report_unknown(struct resolution *resolution, const struct strategy *strategy,
                           const struct parameter_text *parameter)
{
    char message[512];
    const struct strategy_type *type = strategy->type;
    struct param_table table = strategy_type_params(type);
    struct suggestion suggestion = param_suggest(&table, parameter->key);
    char hint[SUGGESTION_TEXT];
    suggestion_text(&suggestion, hint);
    snprintf(message, sizeof message, "unknown parameter '%.80s' of %s %s%s", parameter->key,
             kinds[type->kind].name, type->name, hint);
    fail(resolution, PS_ERROR_INVALID, &parameter->key_origin, message);
}

static void set_parameter(struct resolution *resolution, struct strategy *strategy,
                          const struct parameter_text *parameter)
{
    struct param_table table = strategy_type_params(strategy->type);
    const ps_param *row = param_find(&table, parameter->key);
    struct error error;
    if (!row) {
        report_unknown(resolution, strategy, parameter);
        return;
    }
    ps_result result = param_set(row, strategy->state, parameter->value, &error);
    if (result != PS_OK) {
        char message[sizeof error.text + 128];
        snprintf(message, sizeof message, "%s %s: %s: %s", kinds[strategy->type->kind].name,
                 strategy->type->name, row->name, error.text);
        fail(resolution, result, &parameter->value_origin, message);
    }
}

static bool was_given(const struct strategy_choice *choice, const char *key)
{
    for (size_t i = 0; i < choice->parameter_count; i++)
        if (strcmp(choice->parameters[i].key, key) == 0)
            return true;
    return false;
}

static void check_required(struct resolution *resolution, const struct strategy *strategy,
                           const struct strategy_choice *choice)
{
    struct param_table table = strategy_type_params(strategy->type);
    for (size_t i = 0; i < table.count; i++) {
        const ps_param *row = param_row(&table, i);
        if (row->default_value || was_given(choice, row->name))
            continue;
        char message[256];
        snprintf(message, sizeof message, "%s %s needs its parameter '%s'",
                 kinds[strategy->type->kind].name, strategy->type->name, row->name);
        fail(resolution, PS_ERROR_INVALID, &choice->origin, message);
    }
}

static void resolve_choice(struct resolution *resolution, ps_kind kind,
                           const struct strategy_choice *choice, struct strategy *strategy)
{
    struct error error;
    const char *name = choice->name ? choice->name : kinds[kind].default_strategy;
    ps_result result =
        strategy_create(resolution->loader, kind, name, resolution->effort, strategy, &error);
    if (result != PS_OK) {
        fail(resolution, result, choice->name ? &choice->origin : &nowhere, error.text);
        return;
    }
    for (size_t i = 0; i < choice->parameter_count; i++)
        set_parameter(resolution, strategy, &choice->parameters[i]);
    check_required(resolution, strategy, choice);
}

ps_result settings_choose_kernel(const struct render_settings *settings,
                                 struct kernel_variant *kernel, struct error *error)
{
    return kernel_choose(settings->isa, kernel)
               ? PS_OK
               : error_set(error, PS_ERROR_INVALID, "this processor has no instruction set '%s'",
                           settings->isa);
}

ps_result settings_check_isa(const char *isa, struct error *error)
{
    const struct render_settings settings = {.isa = isa};
    struct kernel_variant unused;
    return settings_choose_kernel(&settings, &unused, error);
}

ps_result settings_resolve(struct loader *loader, const struct render_description *description,
                           uint32_t threads, size_t batch, settings_report report, void *user,
                           struct render_settings *settings)
{
    enum quality quality = (enum quality)description->quality;
    *settings = (struct render_settings){
        .passes = description->passes.choice >= 0 ? quality_passes(quality)
                                                  : (uint32_t)description->passes.number,
        .bounces = description->bounces.choice >= 0 ? PS_ALL_BOUNCES
                                                    : (uint32_t)description->bounces.number,
        .discontinuity_buffer = description->discontinuity_buffer != 0,
        .aa_samples = (uint32_t)description->aa_samples,
        .seed = (uint64_t)description->seed,
        .batch = batch,
        .direct = (enum direct_light)description->direct,
        .direct_resolution = (uint32_t)description->direct_resolution,
        .indirect_exposure = description->indirect_exposure,
        .ambient = description->ambient,
    };
    struct resolution resolution = {loader, report, user, quality_effort(quality), PS_OK};
    for (int kind = 0; kind < PS_KINDS; kind++)
        resolve_choice(&resolution, (ps_kind)kind, &description->strategies[kind],
                       &settings->strategies[kind]);
    struct error error;
    ps_result result = workers_create(threads, &settings->workers, &error);
    if (result != PS_OK)
        fail(&resolution, result, &nowhere, error.text);
    if (resolution.result != PS_OK)
        settings_release(settings);
    return resolution.result;
}

void settings_release(struct render_settings *settings)
{
    for (int kind = 0; kind < PS_KINDS; kind++)
        strategy_release(&settings->strategies[kind]);
    workers_destroy(settings->workers);
}
