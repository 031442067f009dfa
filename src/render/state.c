#include "render/state.h"

#include "base/clock.h"
#include <stdio.h>
#include <string.h>

uint32_t render_passes_done(const struct render *render)
{
    if (render->sum)
        return pass_set_size(&render->sum->passes);
    return render->unfinished ? 0 : render->film.passes;
}

double render_fraction(const struct render *render, double of_pass)
{
    double of_part = (render_passes_done(render) + of_pass) / settings_pass_count(render->settings);
    return (render->part + of_part) / render->parts;
}

/* The first one counts. */
static void take_reason(struct render *render, ps_result result, const char *why, bool named)
{
    struct failure *failure = &render->failure;
    if (atomic_flag_test_and_set(&failure->taken))
        return;
    failure->result = result;
    failure->named = named;
    snprintf(failure->why, sizeof failure->why, "%.1000s", why);
    atomic_store(&failure->there, true);
}

ps_result render_fail(struct render *render, ps_result result, const char *why)
{
    result = result == PS_OK ? PS_ERROR_INVALID : result;
    take_reason(render, result, why, false);
    return result;
}

ps_result render_pass_on(struct render *render, ps_result result, const struct error *error)
{
    if (result != PS_OK && result != PS_CANCELLED)
        take_reason(render, result, error->text, true);
    return result;
}

ps_result render_judge(struct render *render, ps_kind kind, ps_result result, struct error *error)
{
    struct failure *failure = &render->failure;
    const char *name = strategy_in(render, kind)->type->name;
    if (atomic_load(&failure->there)) {
        result = failure->named ? error_set(error, failure->result, "%s", failure->why)
                                : error_set(error, failure->result, "%s %s: %s", kinds[kind].name,
                                            name, failure->why);
        atomic_store(&failure->there, false);
        atomic_flag_clear(&failure->taken);
        return result;
    }
    if (result == PS_OK || result == PS_CANCELLED)
        return result;
    return error_set(error, result, "%s %s failed%s", kinds[kind].name, name,
                     result == PS_ERROR_MEMORY ? ": out of memory" : "");
}

ps_result render_find_importance(struct render *render, struct error *error)
{
    if (render->has_importance)
        return PS_OK;
    double start = clock_seconds();
    ps_result result = importance_create(own_host(render), &render->pass, render->scene,
                                         &render->importance, error);
    render->has_importance = result == PS_OK;
    statistics_add_seconds(render->statistics, "inject", clock_seconds() - start);
    return result;
}

void render_report_splatter(struct statistics *statistics, const struct splatter *splatter)
{
    statistics_add_seconds(statistics, "maps", splatter->map_seconds);
    statistics_add_seconds(statistics, "bin", splatter->bin_seconds);
    statistics_add_seconds(statistics, "splat", splatter->kernel_seconds);
    statistics_add_seconds(statistics, "join", splatter->join_seconds);
    statistics_count(statistics, "splats", (double)splatter->splats);
    statistics_count(statistics, "map rays", (double)splatter->map_rays);
    statistics_count(statistics, "visibility rays", (double)splatter->exact_tests);
    statistics_count(statistics, "pixel-splat tests", (double)splatter->tests);
    statistics_count(statistics, "pixel-splat tests with weight", (double)splatter->useful_tests);
}

static void report(const struct render *render, ps_kind kind, uint64_t count, const char *what)
{
    char line[300];
    if (count == 0)
        return;
    snprintf(line, sizeof line, "%s %s made %llu %s", kinds[kind].name,
             strategy_in(render, kind)->type->name, (unsigned long long)count, what);
    statistics_count(render->statistics, "refused", (double)count);
    own_host(render)->log(own_host(render), PS_LOG_WARNING, line);
}

void render_report_kept(const struct render *render)
{
    for (int kind = 0; kind < PS_KINDS; kind++) {
        char line[300];
        int64_t blocks = atomic_load(&render->hosts[kind].blocks);
        if (blocks == 0)
            continue;
        snprintf(line, sizeof line, "%s %s kept %lld blocks of memory", kinds[kind].name,
                 strategy_in(render, (ps_kind)kind)->type->name, (long long)blocks);
        statistics_count(render->statistics, "kept blocks", (double)blocks);
        own_host(render)->log(own_host(render), PS_LOG_WARNING, line);
    }
}

void render_report_refused(const struct render *render)
{
    static const char photons[] =
        "photons that are no numbers or have negative power; they are left out";
    static const char pixels[] = "values of pixels that are no numbers or negative; they are 0";
    const struct refused *refused = &render->refused;
    report(render, PS_INJECTION, refused->photons[0], photons);
    report(render, PS_STRATIFICATION, refused->photons[1], photons);
    report(render, PS_ESTIMATOR, refused->pixels[0], pixels);
    report(render, PS_NORMALIZATION, refused->pixels[1], pixels);
    report(render, PS_DENOISER, refused->pixels[2], pixels);
    report(render, PS_BLOOM, refused->pixels[3], pixels);
    report(render, PS_TONEMAP, refused->pixels[4], pixels);
    for (int kind = 0; kind < PS_KINDS; kind++)
        report(render, (ps_kind)kind, atomic_load(&refused->rays[kind]),
               "rays that are no numbers; they meet nothing");
}
