#include "support/one_strategy.h"

#include "render/settings.h"
#include "support/workers.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

static struct bare_host *bare_of(const ps_host *host)
{
    return host->core;
}

static void *allocate(const ps_host *host, size_t bytes, const char *what)
{
    (void)what;
    bare_of(host)->live_allocations++;
    return aligned_alloc(64, (bytes + 63) / 64 * 64);
}

static void release(const ps_host *host, void *memory)
{
    bare_of(host)->live_allocations -= memory != NULL;
    free(memory);
}

static void loop(const ps_host *host, uint64_t count, ps_body body, void *user)
{
    parallel_for(bare_of(host)->workers, count, body, user);
}

static void bounds(const ps_host *host, ps_vec3 *center, float *radius)
{
    (void)host;
    *center = (ps_vec3){0, 0, 0};
    *radius = BARE_HOST_RADIUS;
}

static void camera(const ps_host *host, ps_camera *camera)
{
    (void)host;
    *camera = (ps_camera){
        .size = sizeof *camera,
        .projection = PS_ORTHOGRAPHIC,
        .forward = {0, 0, -1},
        .across = {BARE_HOST_PIXEL, 0, 0},
        .down = {0, BARE_HOST_PIXEL, 0},
    };
}

static ps_result refuse(const ps_host *host, ps_result result, const char *why)
{
    struct bare_host *bare = bare_of(host);
    snprintf(bare->why, sizeof bare->why, "%s", why);
    return result;
}

static int32_t cancelled(const ps_host *host)
{
    return bare_of(host)->cancelled;
}

void bare_host_create(struct bare_host *bare, uint32_t threads)
{
    *bare = (struct bare_host){.workers = start_workers(threads)};
    bare->host = (ps_host){
        .size = sizeof(ps_host),
        .abi_minor = PS_ABI_MINOR,
        .core = bare,
        .allocate = allocate,
        .release = release,
        .parallel_for = loop,
        .scene_bounds = bounds,
        .camera = camera,
        .cancelled = cancelled,
        .fail = refuse,
    };
}

void bare_host_release(struct bare_host *bare)
{
    workers_destroy(bare->workers);
}

static void set_parameter(struct strategy *strategy, const struct parameter_text *parameter)
{
    struct param_table table = strategy_type_params(strategy->type);
    const ps_param *row = param_find(&table, parameter->key);
    struct error error;
    assert_non_null(row);
    assert_int_equal(param_set(row, strategy->state, parameter->value, &error), PS_OK);
}

struct strategy strategy_of(const char *text)
{
    const char *wanted;
    struct strategy_choice choice;
    struct loader *loader;
    struct strategy strategy;
    struct error error;
    ps_kind kind = kind_parse(text, &wanted);
    assert_true(kind < PS_KINDS && wanted);
    assert_int_equal(settings_parse_choice(wanted, &choice, &error), PS_OK);
    assert_int_equal(loader_create(&loader, &error), PS_OK);
    assert_int_equal(strategy_create(loader, kind, choice.name, 1.0, &strategy, &error), PS_OK);
    for (size_t i = 0; i < choice.parameter_count; i++)
        set_parameter(&strategy, &choice.parameters[i]);
    strategy_choice_release(&choice);
    loader_destroy(loader);
    return strategy;
}
