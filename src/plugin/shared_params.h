/* shared_params.h: the parameters that all strategies of a kind share, which are psplat's own.
 *
 * A user sets them like any other, as in `visibility=shadowmap:radius=20`; they lie behind the
 * plugin's state, which does not know them. So a new one is there for every plugin, whenever that
 * was built.
 */
#ifndef PLUGIN_SHARED_PARAMS_H
#define PLUGIN_SHARED_PARAMS_H

#include "base/param.h"
#include <psplat/plugin.h>

/* Of visibilities: the footprints of splats (placement/footprint.h), and depth maps where there are
 * any. Scene units. */
struct footprint_params {
    ps_number_or_choice radius;
    double bandwidth_scale;
    ps_number_or_choice depth;
    ps_number_or_choice step_back; /* choices: enum step_back_choice */
    double max_merge_scale;
    int32_t boundary_correction;
    int64_t resolution;
    ps_number_or_choice bias;
};

enum step_back_choice { STEP_BACK_AUTO = 0, STEP_BACK_FULL = 1 };

/* Of stratifications that have strata: how their photons merge (stratify/merge.h). */
struct merge_params {
    int32_t representative; /* enum representative */
    double normal_angle;    /* degrees */
};

/* Of tone maps: what radiance is multiplied by before (pipeline/display.c). */
struct tonemap_params {
    ps_number_or_choice exposure; /* stops; the one choice is auto */
};

enum representative { KEEP_RANDOM = 0, KEEP_NEAREST_MEAN = 1, KEEP_DOMINANT = 2 };

/* What the kind shares, and the size of the struct that it fills; no rows where it shares nothing.
 * `table`: the strategy's, of that kind. */
struct param_table shared_params(ps_kind kind, const void *table, size_t *struct_size);

#endif
