/* render_options.h: what `render` and `debug` share: the options that say what a scene is rendered
 * with, and the way from them to settings. */
#ifndef CLI_RENDER_OPTIONS_H
#define CLI_RENDER_OPTIONS_H

#include "cli/scene_input.h"

/* Their rows for a command's table. */
#define RENDER_OPTIONS                                                                             \
    {'p', "plugin", "KIND=NAME[:KEY=VALUE,...]", "use another strategy, or other parameters"},     \
        SCENE_OPTIONS, {0, "size", "WxH", "width and height of the picture in pixels"},            \
        {0, "quality", "NAME",                                                                     \
         "draft, normal, high or final: how many samples, where none are given"},                  \
        {0, "bounces", "N|all", "surfaces that indirect light may meet, for every estimator"},     \
        {0, "seed", "N", "seed of the random numbers"},                                            \
        {'t', "threads", "N", "threads; the picture does not depend on them"},                     \
        {0, "isa", "NAME",                                                                         \
         "instruction set: baseline, avx2 or avx512; default: the best there is"},                 \
        {0, "batch", "N", "splats held in memory at a time; nor on these"},                        \
        {0, "direct", "rays|shadowmap",                                                            \
         "how direct light finds shadows; area lights: by rays alone"},                            \
        {0, "direct-resolution", "N", "pixels along the side of each of these shadow maps"},       \
        {0, "exposure", "STOPS", "brightness of what is shown: a factor of 2^STOPS"},              \
    {                                                                                              \
        'q', "quiet", NULL, "print nothing but errors"                                             \
    }

struct render_options {
    const char *scene_path;
    struct scene_options scene;
    const char *size, *exposure, *isa, *direct;
    double seed, threads, batch, direct_resolution; /* negative: not given */
    const char *bounces, *quality;
    bool quiet;
    bool preview;                     /* see preview_shrink; `size` goes before it */
    const struct argument *arguments; /* borrowed; --plugin waits for the scene */
    size_t argument_count;
};

/* Picks them from the arguments, whose values must outlive this; `scene_path` is for the caller, since
 * operands differ. False, printed, where one is wrong; to be released in any case. */
bool render_options_take(struct render_options *options, const struct argument *arguments,
                         size_t count);
void render_options_release(struct render_options *options);

/* Reads the scene with all options laid over it, and resolves its settings. False, printed, where
 * that fails; the input is to be released in any case, the settings on success. */
bool render_options_load(const struct render_options *options, struct scene_input *input,
                         struct render_settings *settings);

#endif
