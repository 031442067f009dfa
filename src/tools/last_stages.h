/* last_stages.h: settings of the stages that need no scene: those that make a picture of a film, or
 * show one. */
#ifndef TOOLS_LAST_STAGES_H
#define TOOLS_LAST_STAGES_H

#include "render/settings.h"

struct last_stages {
    struct loader *loader;
    struct render_description description;
};

/* The default settings. Whether it succeeds or not, release it, after the settings that are made of
 * it. */
ps_result last_stages_create(struct last_stages *stages, struct error *error);
void last_stages_release(struct last_stages *stages);

/* Lays a choice such as "gaussian:size=7x7" over that of a kind. */
ps_result last_stages_choose(struct last_stages *stages, ps_kind kind, const char *text,
                             struct error *error);

/* Lays the value of --plugin over it, which may be of kinds from `first` on. */
ps_result last_stages_override(struct last_stages *stages, ps_kind first, const char *text,
                               struct error *error);

/* Loads the strategies. Errors that were printed leave no text. */
ps_result last_stages_resolve(struct last_stages *stages, uint32_t threads,
                              struct render_settings *settings, struct error *error);

#endif
