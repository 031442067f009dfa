#include "support/inject.h"

#include "host/host.h"
#include "parser/psd.h"
#include "support/render_scene.h"
#include "trace/trace.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* All that an injection needs of a render. */
struct bench {
    struct scene_description description;
    struct scene scene;
    struct loader *loader;
    struct render_settings settings;
    struct render_callbacks callbacks;
    struct statistics *statistics;
    struct render render;
};

static void report(void *user, const struct origin *origin, const char *message)
{
    (void)user;
    (void)origin;
    print_error("%s\n", message);
}

static void choose(struct bench *bench, const char *text)
{
    struct strategy_choice choice;
    struct error error;
    struct render_description *render = &bench->description.render;
    struct strategy_choice *base = &render->strategies[PS_INJECTION];
    const char *bounces = strstr(text, " bounces=");
    char injection[256];
    snprintf(injection, sizeof injection, "%.*s",
             (int)(bounces ? (size_t)(bounces - text) : strlen(text)), text);
    render->bounces = bounces_of(bounces ? strchr(bounces, '=') + 1 : "1");
    assert_int_equal(settings_parse_choice(injection, &choice, &error), PS_OK);
    assert_int_equal(settings_override(base, &choice, &error), PS_OK);
}

static struct bench *bench_create(const char *text, const char *choice, uint32_t threads)
{
    struct bench *bench = calloc(1, sizeof *bench);
    struct diagnostics *sink = diagnostics_create();
    struct error error;
    assert_non_null(bench);
    assert_non_null(sink);
    if (psd_read_text("test.psd", text, strlen(text), sink, &bench->description) != PS_OK) {
        diagnostics_print(sink, stderr);
        fail_msg("the scene has errors");
    }
    diagnostics_destroy(sink);
    choose(bench, choice);
    assert_int_equal(loader_create(&bench->loader, &error), PS_OK);
    assert_int_equal(settings_resolve(bench->loader, &bench->description.render, threads, 4096,
                                      report, NULL, &bench->settings),
                     PS_OK);
    assert_int_equal(scene_create(&bench->description, &bench->scene, NULL, &error), PS_OK);
    bench->statistics = calloc(1, sizeof *bench->statistics);
    assert_non_null(bench->statistics);
    statistics_init(bench->statistics);
    bench->render = (struct render){
        .scene = &bench->scene,
        .settings = &bench->settings,
        .callbacks = &bench->callbacks,
        .statistics = bench->statistics,
        .parts = 1,
    };
    assert_int_equal(trace_create(&bench->scene, NULL, &bench->render.trace, &error), PS_OK);
    host_create(&bench->render);
    return bench;
}

static void discard(struct statistics *statistics)
{
    statistics_destroy(statistics);
    free(statistics);
}

/* Plugins gave back all that they took. */
static void expect_no_memory(const struct statistics *statistics)
{
    for (size_t i = 0; i < statistics->memory.count; i++)
        if (strcmp(statistics->memory.rows[i].name, "photons") != 0)
            assert_true(statistics->memory.rows[i].value == 0);
}

/* Keeps the statistics, which the caller discards. */
static void bench_release(struct bench *bench)
{
    importance_release(&bench->render.importance);
    trace_destroy(bench->render.trace);
    scene_release(&bench->scene);
    settings_release(&bench->settings);
    loader_destroy(bench->loader);
    scene_description_release(&bench->description);
    free(bench);
}

static void keep(struct injected *injected, const ps_photon *photons, size_t n)
{
    size_t count = injected->count + n;
    injected->photons = realloc(injected->photons, (count + 1) * sizeof *photons);
    assert_non_null(injected->photons);
    if (n)
        memcpy(injected->photons + injected->count, photons, n * sizeof *photons);
    injected->count = count;
}

static void collect(struct bench *bench, struct injected *injected)
{
    struct error error;
    const ps_photon *photons;
    struct photon_stream stream;
    size_t n;
    assert_int_equal(photon_stream_create(&bench->render, &stream, &error), PS_OK);
    do {
        if (photon_stream_next(&stream, &photons, &n, &error) != PS_OK)
            fail_msg("%s", error.text);
        keep(injected, photons, n);
    } while (n > 0);
    assert_true(photon_stream_progress(&stream) == 1);
    injected->spread = stream.spread;
    photon_stream_release(&stream);
}

static void start(struct bench *bench, ps_kind kind)
{
    struct error error;
    struct strategy *strategy = &bench->settings.strategies[kind];
    ps_result result = strategy_start(strategy, &bench->render.hosts[kind].host);
    if (render_judge(&bench->render, kind, result, &error) != PS_OK)
        fail_msg("%s", error.text);
}

struct injected inject_text(const char *text, const char *choice, uint32_t pass, uint32_t threads)
{
    struct bench *bench = bench_create(text, choice, threads);
    struct injected injected = {.photons = NULL};
    bench->render.pass = (ps_pass){
        .size = sizeof(ps_pass),
        .number = pass,
        .seed = bench->settings.seed,
        .thread_count = threads,
        .surface_offset = bench->scene.surface_offset,
        .specular = bench->scene.microfacets != NULL,
        .bounces = bench->settings.bounces,
    };
    for (int kind = PS_INJECTION; kind <= PS_STRATIFICATION; kind++)
        start(bench, (ps_kind)kind);
    collect(bench, &injected);
    for (int kind = PS_INJECTION; kind <= PS_STRATIFICATION; kind++)
        strategy_stop(&bench->settings.strategies[kind]);
    expect_no_memory(bench->statistics);
    injected.statistics = bench->statistics;
    bench_release(bench);
    return injected;
}

void injected_release(struct injected *injected)
{
    free(injected->photons);
    discard(injected->statistics);
}

void with_host_of(const char *text, void (*body)(const ps_host *host))
{
    struct bench *bench = bench_create(text, "photon", 1);
    body(own_host(&bench->render));
    discard(bench->statistics);
    bench_release(bench);
}

char *injection_refusal(const char *text, const char *choice)
{
    struct bench *bench = bench_create(text, choice, 1);
    struct error error;
    struct strategy *injection = &bench->settings.strategies[PS_INJECTION];
    ps_result result = strategy_start(injection, &bench->render.hosts[PS_INJECTION].host);
    result = render_judge(&bench->render, PS_INJECTION, result, &error);
    assert_int_equal(result, PS_ERROR_INVALID);
    expect_no_memory(bench->statistics);
    discard(bench->statistics);
    bench_release(bench);
    return strdup(error.text);
}

struct total_power power_of(const struct injected *injected)
{
    struct total_power total = {0, 0, 0};
    for (size_t i = 0; i < injected->count; i++) {
        total.r += (double)injected->photons[i].power.r;
        total.g += (double)injected->photons[i].power.g;
        total.b += (double)injected->photons[i].power.b;
    }
    return total;
}

struct total_power mean_power(const char *text, const char *choice, uint32_t passes)
{
    struct total_power mean = {0, 0, 0};
    for (uint32_t pass = 0; pass < passes; pass++) {
        struct injected injected = inject_text(text, choice, pass, 2);
        struct total_power power = power_of(&injected);
        mean.r += power.r / passes;
        mean.g += power.g / passes;
        mean.b += power.b / passes;
        injected_release(&injected);
    }
    return mean;
}

void expect_power(const char *what, struct total_power power, struct total_power expected,
                  double tolerance)
{
    double r = power.r / expected.r, g = power.g / expected.g, b = power.b / expected.b;
    print_message("%-44s %.5f %.5f %.5f, allowed %.2f %%\n", what, r, g, b, 100 * tolerance);
    assert_true(fabs(r - 1) < tolerance && fabs(g - 1) < tolerance && fabs(b - 1) < tolerance);
}
