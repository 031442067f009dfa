/* render_options.h: the options of a render by their command-line names (psplat(1)), and how they
 * become settings. */
#ifndef SESSION_RENDER_OPTIONS_H
#define SESSION_RENDER_OPTIONS_H

#include "session/job_options.h"
#include "session/output_list.h"
#include "session/pass_range.h"
#include "session/scene_input.h"

/* Owns its words. Made by render_options_init. */
struct render_options {
    struct scene_options scene;
    struct output_list output;
    struct job_options job;
    char *stats;              /* a file; owned; NULL: none */
    struct word_list plugins; /* KIND=NAME[:KEY=VALUE,...]; the later goes before the earlier */
    struct pass_range passes;
    int64_t width, height; /* 0: the scene's, which a preview makes smaller */
    struct rectangle crop; /* see render_settings */
    char *isa;             /* as the following, NULL: not given */
    char *bounces, *quality;
    double tile;                                    /* 0: not given */
    double seed, threads, batch, direct_resolution; /* negative: not given */
    double exposure;                                /* NAN: not given */
    int32_t direct;                                 /* enum direct_light; negative: not given */
    bool preview;
};

struct render_options render_options_init(void);
void render_options_release(struct render_options *options);

/* Whether it is the name of an option, without dashes; and of one that takes no value. */
bool render_options_has(const char *name);
bool render_options_is_flag(const char *name);

/* Gives an option a value (NULL for a flag), which is copied. `param`, `set`, `plugin` and `output`
 * add to those given before; of the others the last counts. `preview` sets other options; a value
 * that is given explicitly, before or after it, overrides them. PS_ERROR_INVALID: there is no such
 * option, or no such value, or it excludes another. */
ps_result render_options_set(struct render_options *options, const char *name, const char *value,
                             struct error *error);

/* PS_ERROR_INVALID where options do not go together; PS_ERROR_IO where a file that is to be written
 * can't be. The second is for the process that writes. */
ps_result render_options_check(const struct render_options *options, struct error *error);
ps_result render_options_check_files(const struct render_options *options, struct error *error);

/* PS_ERROR_INVALID where one of those is a file of the scene; but for a checkpoint: a file that is
 * no film is never replaced. */
ps_result render_options_check_not_input(const struct render_options *options,
                                         const struct scene_description *description,
                                         struct error *error);

/* Whether the render's film is kept. */
bool render_options_keep_film(const struct render_options *options);

/* Applies the options to a scene description that was read with options->scene. What is wrong is in
 * the input's sink. */
ps_result render_options_apply(const struct render_options *options, struct scene_input *input);

/* Makes settings of a description to which the options were applied, and starts the threads.
 * Settings refer to the options. What is wrong is in the sink. */
ps_result render_options_resolve(const struct render_options *options,
                                 const struct scene_description *description,
                                 struct diagnostics *sink, struct render_settings *settings);

/* Takes back what a preview asks of scenes in general, and this one cannot have: where pixels ask
 * some of many lights each, they have nothing to join (discontinuity_buffer.h). */
void render_options_adapt_preview(const struct render_options *options, const struct scene *scene,
                                  struct render_settings *settings);

/* PS_ERROR_INVALID where a part is asked for that can't be rendered alone (render_check_crop);
 * PS_ERROR_MEMORY where a picture takes more than the options allow, or this machine lends. */
ps_result render_options_check_size(const struct render_options *options,
                                    const struct image_description *image,
                                    const struct render_settings *settings, struct error *error);

#endif
