#include "support/stratify.h"

#include "base/sample.h"
#include "render/settings.h"
#include "stratify/cells.h"
#include "stratify/stratify.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static struct stage *stage_on(const ps_host *host)
{
    return host->core;
}

static void *take(const ps_host *host, size_t bytes, const char *what)
{
    struct stage *stage = stage_on(host);
    if (stage->out_of_memory)
        return NULL;
    stage->allocations++;
    statistics_add_bytes(&stage->statistics, what, (double)bytes);
    return aligned_alloc(64, (bytes + 63) / 64 * 64);
}

static void give_back(const ps_host *host, void *memory)
{
    stage_on(host)->allocations -= memory != NULL;
    free(memory);
}

static void draw(const ps_host *host, uint32_t stream, uint32_t set, const uint64_t *indices,
                 size_t n, float (*samples)[4])
{
    for (size_t i = 0; i < n; i++)
        sample_point(sample_key(stage_on(host)->seed, stream, set), indices[i], samples[i]);
}

static void bounds(const ps_host *host, ps_vec3 *center, float *radius)
{
    *center = (ps_vec3){0, 0, 0};
    *radius = stage_on(host)->radius;
}

static void look(const ps_host *host, ps_camera *camera)
{
    camera->position = stage_on(host)->camera;
    camera->forward = (ps_vec3){0, 0, 1};
}

static const void *extend(const ps_host *host, const char *name)
{
    (void)host;
    return strcmp(name, PS_CELLS_EXTENSION) == 0 ? &cells_service : NULL;
}

static ps_result refuse(const ps_host *host, ps_result result, const char *why)
{
    (void)host;
    print_message("%s\n", why);
    return result;
}

static void add_up(const ps_host *host, const char *counter, double amount)
{
    statistics_count(&stage_on(host)->statistics, counter, amount);
}

struct stage stage_of(float radius)
{
    struct stage stage = {.radius = radius, .seed = 1};
    statistics_init(&stage.statistics);
    return stage;
}

void stage_release(struct stage *stage)
{
    statistics_destroy(&stage->statistics);
}

ps_photon stratify_photon(ps_vec3 position, float power, uint64_t path)
{
    return (ps_photon){.position = position,
                       .normal = {0, 1, 0},
                       .direction = {0, 1, 0},
                       .power = {power, power, power},
                       .bounce = 1,
                       .merged = 1,
                       .path = path};
}

static ps_host host_of(struct stage *stage)
{
    return (ps_host){
        .size = sizeof(ps_host),
        .abi_minor = PS_ABI_MINOR,
        .core = stage,
        .allocate = take,
        .release = give_back,
        .samples = draw,
        .scene_bounds = bounds,
        .count = add_up,
        .camera = look,
        .extension = extend,
        .fail = refuse,
    };
}

static void create(struct loader *loader, const char *text, struct strategy *strategy)
{
    struct strategy_choice choice;
    struct error error;
    assert_int_equal(settings_parse_choice(text, &choice, &error), PS_OK);
    if (strategy_create(loader, PS_STRATIFICATION, choice.name, 1.0, strategy, &error) != PS_OK)
        fail_msg("%s", error.text);
    struct param_table table = strategy_type_params(strategy->type);
    for (size_t i = 0; i < choice.parameter_count; i++) {
        const ps_param *row = param_find(&table, choice.parameters[i].key);
        assert_non_null(row);
        if (param_set(row, strategy->state, choice.parameters[i].value, &error) != PS_OK)
            fail_msg("%s: %s", text, error.text);
    }
    strategy_choice_release(&choice);
}

/* A strategy that was started on a stage. */
struct running {
    struct loader *loader;
    struct strategy strategy;
    ps_host host;
    ps_pass pass;
};

static void start(struct stage *stage, const char *choice, struct running *running)
{
    struct error error;
    running->host = host_of(stage);
    running->pass = (ps_pass){.size = sizeof(ps_pass), .number = stage->pass, .seed = stage->seed};
    statistics_destroy(&stage->statistics);
    statistics_init(&stage->statistics);
    assert_int_equal(loader_create(&running->loader, &error), PS_OK);
    create(running->loader, choice, &running->strategy);
    assert_int_equal(strategy_start(&running->strategy, &running->host), PS_OK);
}

static void stop(struct stage *stage, struct running *running)
{
    assert_int_equal(stage->allocations, 0);
    strategy_release(&running->strategy);
    loader_destroy(running->loader);
}

size_t stratify_photons(struct stage *stage, const char *choice, ps_photon *photons, size_t n)
{
    struct running running;
    start(stage, choice, &running);
    stage->result = stratify(&running.strategy, &running.host, &running.pass, photons, &n);
    stop(stage, &running);
    return n;
}

bool stratify_cells(struct stage *stage, const char *choice, const ps_photon *photons, size_t n,
                    uint64_t *numbers)
{
    struct running running;
    start(stage, choice, &running);
    bool has_cells = running.strategy.type->table.stratification.find_strata != NULL;
    ps_vec3 *points = calloc(n + 1, sizeof *points);
    ps_photon *copies = calloc(n + 1, sizeof *copies);
    assert_non_null(points);
    assert_non_null(copies);
    for (size_t i = 0; i < n; i++) {
        copies[i] = photons[i];
        points[i] = photons[i].position;
    }
    if (has_cells)
        stage->result = stratify_numbers(&running.strategy, &running.host, &running.pass, copies, n,
                                         points, n, numbers);
    free(points);
    free(copies);
    stop(stage, &running);
    return has_cells;
}

bool stratification_refuses(struct stage *stage, const char *choice)
{
    struct loader *loader;
    struct strategy strategy;
    struct error error;
    ps_host host = host_of(stage);
    assert_int_equal(loader_create(&loader, &error), PS_OK);
    create(loader, choice, &strategy);
    bool refused = strategy_start(&strategy, &host) != PS_OK;
    strategy_release(&strategy);
    loader_destroy(loader);
    return refused;
}
