/* render_description.h: how a scene is to be rendered, as files and the command line state it.
 *
 * What names of plugins and texts of parameters mean is told by the plugins; see render/settings.h.
 */
#ifndef SETTINGS_RENDER_DESCRIPTION_H
#define SETTINGS_RENDER_DESCRIPTION_H

#include "base/origin.h"
#include <psplat/module.h>

/* A plugin's name (or path) with parameters, still as text: only the plugin's table can check
 * them. */
struct parameter_text {
    char *key, *value; /* owned; vectors are written "[x, y, z]" */
    struct origin key_origin, value_origin;
};

struct strategy_choice {
    char *name; /* NULL: not stated, the default applies; owned */
    struct parameter_text *parameters;
    size_t parameter_count;
    struct origin origin;
};

/* How direct light finds shadows. */
enum direct_light { DIRECT_RAYS, DIRECT_SHADOWMAP };

#define MOST_AA_SAMPLES 1024
#define MOST_LIGHT_CHOICES 256

struct render_description {
    struct strategy_choice strategies[PS_KINDS];
    int32_t quality;             /* enum quality */
    ps_number_or_choice passes;  /* a whole number, or as many as the quality has */
    ps_number_or_choice bounces; /* a whole number, or all */
    int64_t seed;
    int64_t light_samples; /* shadow rays for each area light, pixel and pass */
    int64_t light_choices; /* lights that a point asks at the most */
    /* 1: pixels take in what shadow rays of those around them found. */
    int32_t discontinuity_buffer;
    int64_t aa_samples; /* camera samples of a pixel at an edge, in each pass; 1: as everywhere */
    int32_t direct;     /* enum direct_light */
    int64_t direct_resolution;
    double indirect_exposure; /* factor on the indirect light when it joins the direct light */
    ps_rgb ambient;           /* radiance of pixels that no indirect light reached */
};

/* Frees what a choice owns, and zeroes it. */
void strategy_choice_release(struct strategy_choice *choice);

/* Frees what the choices own. */
void render_description_release(struct render_description *description);

#endif
