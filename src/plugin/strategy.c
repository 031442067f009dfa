#include "plugin/strategy.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct param_table strategy_params(const ps_descriptor *descriptor)
{
    return (struct param_table){descriptor->params, descriptor->param_count,
                                descriptor->param_size};
}

ps_result strategy_create(struct loader *loader, ps_kind kind, const char *name,
                          struct strategy *strategy, struct error *error)
{
    struct found_strategy found;
    ps_result result = loader_find(loader, kind, name, &found, error);
    if (result != PS_OK)
        return result;
    const ps_descriptor *descriptor = found.descriptor;
    size_t bytes = descriptor->state_size ? (size_t)descriptor->state_size : 1;
    *strategy = (struct strategy){
        .name = strdup(name),
        .descriptor = descriptor,
        .state = calloc(1, bytes),
    };
    if (!strategy->name || !strategy->state) {
        strategy_release(strategy);
        return error_memory(error, bytes, "a plugin's state");
    }
    struct param_table table = strategy_params(descriptor);
    struct error reason;
    result = param_set_defaults(&table, strategy->state, &reason);
    if (result == PS_OK)
        return PS_OK;
    strategy_release(strategy);
    return error_set(error, result, "%s plugin %s has a bad default: %.700s",
                     kinds[descriptor->kind].name, descriptor->name, reason.text);
}

ps_result strategy_start(struct strategy *strategy, const ps_host *host, struct error *error)
{
    const ps_descriptor *descriptor = strategy->descriptor;
    char message[512] = "no reason given";
    if (descriptor->init && descriptor->init(strategy->state, host, message, sizeof message) != 0)
        return error_set(error, PS_ERROR_INVALID, "%s %s: %s", kinds[descriptor->kind].name,
                         descriptor->name, message);
    strategy->host = host;
    return PS_OK;
}

void strategy_stop(struct strategy *strategy)
{
    if (strategy->host && strategy->descriptor->destroy)
        strategy->descriptor->destroy(strategy->state, strategy->host);
    strategy->host = NULL;
}

void strategy_release(struct strategy *strategy)
{
    strategy_stop(strategy);
    if (strategy->state) {
        struct param_table table = strategy_params(strategy->descriptor);
        param_release(&table, strategy->state);
    }
    free(strategy->state);
    free(strategy->name);
    *strategy = (struct strategy){.descriptor = NULL};
}

void strategy_format(const struct strategy *strategy, char *text, size_t size)
{
    struct param_table table = strategy_params(strategy->descriptor);
    size_t used = (size_t)snprintf(text, size, "%s", strategy->name);
    for (size_t i = 0; i < table.count && used < size; i++) {
        const ps_param *row = param_row(&table, i);
        char value[256];
        param_format(row, strategy->state, value, sizeof value);
        used +=
            (size_t)snprintf(text + used, size - used, "%c%s=%s", i ? ',' : ':', row->name, value);
    }
}
