/* scene_options.h: what changes a scene as it is read: parameters, values set in its tree, the
 * camera, limits.
 */
#ifndef SESSION_SCENE_OPTIONS_H
#define SESSION_SCENE_OPTIONS_H

#include "parser/psd.h"
#include "session/word_list.h"

/* Zeroed: nothing. */
struct scene_options {
    struct psd_options psd; /* of the following */
    struct word_list parameters, sets;
    char *folder; /* owned; NULL: any */
    char *cache;  /* owned; NULL: none */
    char *camera; /* owned; NULL: the first */
};

/* "NAME=VALUE", "KEY.KEY=VALUE"; those given later count. PS_ERROR_INVALID: it is nothing such. */
ps_result scene_options_add_parameter(struct scene_options *options, const char *word,
                                      struct error *error);
ps_result scene_options_add_set(struct scene_options *options, size_t index, const char *word,
                                struct error *error);

/* Refuses files outside of a folder to the scene (PS_ERROR_IO: there is none), or lets it run
 * plugins that it names by a path. A plugin can read any file, so that both together make no sense:
 * PS_ERROR_INVALID. */
ps_result scene_options_restrict(struct scene_options *options, const char *path,
                                 struct error *error);
ps_result scene_options_allow_plugins(struct scene_options *options, struct error *error);

/* A folder that keeps what is made of meshes and pictures; it is made where it is not there, its
 * parent is. PS_ERROR_IO. */
ps_result scene_options_cache(struct scene_options *options, const char *path, struct error *error);

void scene_options_release(struct scene_options *options);

/* Puts the camera that was asked for first. PS_ERROR_INVALID, reported, if there is none of that
 * name. */
ps_result scene_options_choose_camera(const struct scene_options *options,
                                      struct scene_description *description,
                                      struct diagnostics *sink);

/* Calls back for each word of a command that gives the same options. */
void scene_options_each_word(const struct scene_options *options,
                             void (*each)(void *user, const char *word), void *user);

#endif
