/* strategy_type.h: a strategy as its module describes it, in structs of this psplat.
 *
 * A module may have been built with older headers, whose structs are shorter. So its descriptor and
 * table are copied into today's, where what it does not know is 0, and the core looks at the copies
 * alone.
 */
#ifndef PLUGIN_STRATEGY_TYPE_H
#define PLUGIN_STRATEGY_TYPE_H

#include "base/param.h"
#include "plugin/kind.h"
#include <stdbool.h>

union strategy_table {
    ps_injection_vtable injection;
    ps_stratification_vtable stratification;
    ps_visibility_vtable visibility;
    ps_filter_vtable filter;
    ps_estimator_vtable estimator;
    ps_normalization_vtable normalization;
    ps_denoiser_vtable denoiser;
    ps_bloom_vtable bloom;
    ps_tonemap_vtable tonemap;
};

struct strategy_type {
    ps_kind kind;
    const char *name, *version, *summary, *paper; /* the module's, which stays */
    char *file; /* that it comes from; NULL: linked into the program */
    union strategy_table table;
    ps_result (*init)(void *state, const ps_host *host);
    void (*destroy)(void *state, const ps_host *host);
    ps_param *rows; /* of all parameters: those that its kind shares, then its own */
    size_t row_count;
    size_t state_size;    /* the plugin's state, and behind it what the kind shares */
    size_t shared_offset; /* where that begins */
};

/* Whether a module may be used; on failure the message says what is wrong with it. */
bool module_check(const ps_module *module, struct error *error);

/* Takes over one of the descriptors of a module that was checked. PS_ERROR_INVALID: a default is
 * no value of its parameter, or a parameter has the name of one that the kind shares;
 * PS_ERROR_MEMORY. */
ps_result strategy_type_create(const ps_descriptor *descriptor, const char *file,
                               struct strategy_type **type, struct error *error);
void strategy_type_destroy(struct strategy_type *type);

struct param_table strategy_type_params(const struct strategy_type *type);

#endif
