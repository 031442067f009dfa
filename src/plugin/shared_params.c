#include "plugin/shared_params.h"

static const char *const automatic[] = {"auto", NULL};
static const char *const step_back_choices[] = {"auto", "full", NULL};
static const char *const bias_choices[] = {"slope", NULL};
static const char *const representatives[] = {"random", "nearest_mean", "dominant", NULL};

/* The rows of the footprint, by what two of the defaults are. */
#define FOOTPRINT_ROWS(step_back_default, boundary_correction_default)                             \
    PS_NUMBER_OR(                                                                                  \
        struct footprint_params, radius, "auto", 0, INFINITY, PS_PARAM_OPEN_MIN, automatic,        \
        "scene units",                                                                             \
        "radius of a splat; auto: by the scene, its light and the number of light paths"),         \
        PS_NUMBER(struct footprint_params, bandwidth_scale, "0.6", 0, INFINITY, PS_PARAM_EXPERT,   \
                  "",                                                                              \
                  "largest radius that a pixel uses, as a fraction of its distance from the "      \
                  "photon; 0: no limit"),                                                          \
        PS_NUMBER_OR(                                                                              \
            struct footprint_params, depth, "auto", 0, INFINITY,                                   \
            PS_PARAM_OPEN_MIN | PS_PARAM_EXPERT, automatic, "scene units",                         \
            "how far the footprint reaches past the first hit; auto: as the slope there needs"),   \
        PS_NUMBER_OR(struct footprint_params, step_back, step_back_default, 0, INFINITY,           \
                     PS_PARAM_EXPERT, step_back_choices, "scene units",                            \
                     "how far before the first hit the footprint starts; auto: as the slope "      \
                     "there needs; full: at the photon"),                                          \
        PS_NUMBER(struct footprint_params, max_merge_scale, "1.5", 1, INFINITY, PS_PARAM_EXPERT,   \
                  "", "largest factor by which the radius grows where photons were merged"),       \
        PS_ROW(                                                                                    \
            struct footprint_params, boundary_correction, PS_PARAM_BOOL,                           \
            boundary_correction_default, 0, 1, PS_PARAM_EXPERT, NULL, "",                          \
            "divides a full bundle's kernel by the part that walls beside the photon leave of it")

/* Without a test of what is in the way, light leaks through a whole bundle: a footprint is kept
 * short. */
static const ps_param short_footprint[] = {FOOTPRINT_ROWS("auto", "no")};

/* The last two are of depth maps. */
static const ps_param footprint[] = {
    FOOTPRINT_ROWS("full", "yes"),
    PS_INT(struct footprint_params, resolution, "8", 1, PS_MOST_TEXELS, "texels",
           "texels along the side of a depth map"),
    PS_NUMBER_OR(struct footprint_params, bias, "slope", 0, INFINITY, PS_PARAM_EXPERT, bias_choices,
                 "scene units",
                 "depth tolerance; slope: 0.75 texels times the slope of the receiver"),
};
enum { FOOTPRINT_ROW_COUNT = sizeof footprint / sizeof footprint[0], MAP_ROWS = 2 };

static const ps_param merging[] = {
    PS_ROW(struct merge_params, representative, PS_PARAM_CHOICE, "random", 0, 0, PS_PARAM_EXPERT,
           representatives, "",
           "the photon of a stratum that stays; random: by luminance, without bias"),
    PS_NUMBER(struct merge_params, normal_angle, "60", 5, 180, PS_PARAM_EXPERT, "degrees",
              "largest angle between the normal of a stratum's first photon and those of the "
              "others; 180: any"),
};

static const ps_param exposing[] = {
    PS_NUMBER_OR(struct tonemap_params, exposure, "0", -20, 20, 0, automatic, "stops",
                 "brightness, to which that of the image adds; auto: mean luminance becomes 0.18"),
};

static struct param_table rows(const ps_param *first, size_t count)
{
    return (struct param_table){first, count, sizeof *first};
}

struct param_table shared_params(ps_kind kind, const void *table, size_t *struct_size)
{
    const ps_visibility_vtable *visibility = table;
    const ps_stratification_vtable *stratification = table;
    if (kind == PS_STRATIFICATION && stratification->stratify) {
        *struct_size = sizeof(struct merge_params);
        return rows(merging, sizeof merging / sizeof merging[0]);
    }
    if (kind == PS_TONEMAP) {
        *struct_size = sizeof(struct tonemap_params);
        return rows(exposing, sizeof exposing / sizeof exposing[0]);
    }
    *struct_size = kind == PS_VISIBILITY ? sizeof(struct footprint_params) : 0;
    if (kind != PS_VISIBILITY)
        return rows(NULL, 0);
    if (visibility->depth_maps)
        return rows(footprint, FOOTPRINT_ROW_COUNT);
    if (visibility->visible)
        return rows(footprint, FOOTPRINT_ROW_COUNT - MAP_ROWS);
    return rows(short_footprint, sizeof short_footprint / sizeof short_footprint[0]);
}
