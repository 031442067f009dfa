/* strategy.h: a strategy with its parameters: its type and the state that belongs to it. */
#ifndef PLUGIN_STRATEGY_H
#define PLUGIN_STRATEGY_H

#include "base/param.h"
#include "plugin/loader.h"
#include <stdbool.h>

struct strategy {
    char *name;                 /* as it was asked for: a name or a path; owned */
    struct strategy_type *type; /* owned */
    void *state;                /* owned; the plugin's, and behind it what its kind shares */
    const ps_host *host;        /* set between strategy_start and strategy_stop */
};

/* What the strategy's kind shares: a footprint_params or a merge_params, where it has any. */
const void *strategy_shared(const struct strategy *strategy);

/* Loads the strategy of that name and gives it a state with default parameters (see
 * param_set_defaults). Set others with param_set, then start it. */
ps_result strategy_create(struct loader *loader, ps_kind kind, const char *name, double effort,
                          struct strategy *strategy, struct error *error);

/* Runs the plugin's init with the host that it keeps; what it said of a failure, host->fail was
 * told. */
ps_result strategy_start(struct strategy *strategy, const ps_host *host);

/* Runs the plugin's destroy if it was started; the host is not used after that. */
void strategy_stop(struct strategy *strategy);

/* Stops the strategy and frees its state. */
void strategy_release(struct strategy *strategy);

/* "photon:count=25000,bounces=1": name and every parameter. */
void strategy_format(const struct strategy *strategy, char *text, size_t size);

#endif
