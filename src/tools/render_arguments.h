/* render_arguments.h: the command line of `debug` and `check` as render options, and the way from
 * them to a scene and settings, with all problems printed. */
#ifndef TOOLS_RENDER_ARGUMENTS_H
#define TOOLS_RENDER_ARGUMENTS_H

#include "cli/option_rows.h"
#include "session/render_options.h"

struct render_arguments {
    const char *scene_path; /* borrowed; for the caller, since operands differ */
    struct render_options options;
    bool quiet;
};

/* Picks them from the arguments. False, printed, where one is wrong; to be released in any case. */
bool render_arguments_take(struct render_arguments *taken, const struct argument *arguments,
                           size_t count);
void render_arguments_release(struct render_arguments *taken);

/* Prints what a step of the input had to say. */
void print_problems(const struct scene_input *input);

/* Reads a scene, and lays the options over it. False, printed, where that fails; the input is to be
 * released in any case. */
bool render_arguments_read(const struct render_arguments *taken, const char *path,
                           struct scene_input *input);

/* The same for `scene_path`, and makes its settings; these are to be released on success. */
bool render_arguments_load(const struct render_arguments *taken, struct scene_input *input,
                           struct render_settings *settings);

#endif
