/* render_arguments.h: the command line of `render`, `debug` and `check` as render options, and the way from them to a
 * scene and settings, with all problems printed. */
#ifndef CLI_RENDER_ARGUMENTS_H
#define CLI_RENDER_ARGUMENTS_H

#include "cli/command.h"
#include "session/render_options.h"

/* Rows for a command's table: what changes a scene as it is read. */
#define SCENE_OPTIONS                                                                              \
    {0, "param", "NAME=VALUE", "give a parameter of the scene a value"},                           \
        {0, "set", "KEY.KEY=VALUE", "set a value in the scene; items of lists count from 0"},      \
        {0, "camera", "NAME", "look through another camera of the scene"},                         \
        {0, "restrict", "DIR", "refuse files outside of DIR to the scene"},                        \
        {0, "cache", "DIR", "keep what is made of mesh files in DIR for the next time"},           \
    {                                                                                              \
        0, "allow-scene-plugins", NULL, "let the scene run plugins that it names by a path"        \
    }

/* And what it is rendered with. */
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

struct render_arguments {
    const char *scene_path;        /* borrowed; for the caller, since operands differ */
    struct render_options options; /* but for layers and compression, which output_list.h takes */
    bool quiet;
    const struct transport *transport; /* to processes that take part; borrowed; NULL: none do */
};

/* Picks them from the arguments. False, printed, where one is wrong; to be released in any case. */
bool render_arguments_take(struct render_arguments *taken, const struct argument *arguments,
                           size_t count);
void render_arguments_release(struct render_arguments *taken);

/* Prints what a step of the input had to say. */
void print_problems(const struct scene_input *input);

/* Reads a scene, for all processes that take part, and lays the options over it. False, printed, where that fails; the input is to be released in any
 * case. */
bool render_arguments_read(const struct render_arguments *taken, const char *path,
                           struct scene_input *input);

/* The same for `scene_path`, and makes its settings; these are to be released on success. */
bool render_arguments_load(const struct render_arguments *taken, struct scene_input *input,
                           struct render_settings *settings);

#endif
