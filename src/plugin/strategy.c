#include "plugin/strategy.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const void *strategy_shared(const struct strategy *strategy)
{
    return (const char *)strategy->state + strategy->type->shared_offset;
}

ps_result strategy_create(struct loader *loader, ps_kind kind, const char *name, double effort,
                          struct strategy *strategy, struct error *error)
{
    struct strategy_type *type;
    ps_result result = loader_find(loader, kind, name, &type, error);
    if (result != PS_OK)
        return result;
    *strategy = (struct strategy){
        .name = strdup(name),
        .type = type,
        .state = calloc(1, type->state_size),
    };
    struct param_table table = strategy_type_params(type);
    result = strategy->name && strategy->state
                 ? param_set_defaults(&table, strategy->state, effort, error)
                 : error_memory(error, type->state_size, "a plugin's state");
    if (result != PS_OK)
        strategy_release(strategy);
    return result;
}

ps_result strategy_start(struct strategy *strategy, const ps_host *host)
{
    ps_result result = strategy->type->init ? strategy->type->init(strategy->state, host) : PS_OK;
    if (result == PS_OK)
        strategy->host = host;
    return result;
}

void strategy_stop(struct strategy *strategy)
{
    if (strategy->host && strategy->type->destroy)
        strategy->type->destroy(strategy->state, strategy->host);
    strategy->host = NULL;
}

void strategy_release(struct strategy *strategy)
{
    strategy_stop(strategy);
    if (strategy->state) {
        struct param_table table = strategy_type_params(strategy->type);
        param_release(&table, strategy->state);
    }
    strategy_type_destroy(strategy->type);
    free(strategy->state);
    free(strategy->name);
    *strategy = (struct strategy){.type = NULL};
}

void strategy_format(const struct strategy *strategy, char *text, size_t size)
{
    struct param_table table = strategy_type_params(strategy->type);
    size_t used = (size_t)snprintf(text, size, "%s", strategy->name);
    for (size_t i = 0; i < table.count && used < size; i++) {
        const ps_param *row = param_row(&table, i);
        char value[256];
        param_format(row, strategy->state, value, sizeof value);
        used +=
            (size_t)snprintf(text + used, size - used, "%c%s=%s", i ? ',' : ':', row->name, value);
    }
}
