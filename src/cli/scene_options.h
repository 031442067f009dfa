/* scene_options.h: the options of `render` and `check` that change what a scene says as it is read.
 */
#ifndef CLI_SCENE_OPTIONS_H
#define CLI_SCENE_OPTIONS_H

#include "cli/command.h"
#include "parser/psd.h"

/* Their rows for a command's table. */
#define SCENE_OPTIONS                                                                              \
    {0, "param", "NAME=VALUE", "give a parameter of the scene a value"},                           \
        {0, "set", "KEY.KEY=VALUE", "set a value in the scene; items of lists count from 0"},      \
        {0, "camera", "NAME", "look through another camera of the scene"},                         \
        {0, "restrict", "DIR", "refuse files outside of DIR to the scene"},                        \
    {                                                                                              \
        0, "allow-scene-plugins", NULL, "let the scene run plugins that it names by a path"        \
    }

struct scene_options {
    struct psd_options psd;
    const char *camera; /* NULL: the first */
    const char **words; /* owned: those of `psd` */
    char *folder;       /* owned: that of `psd`; NULL: any */
};

/* Picks them from the arguments, whose values must outlive this. False, printed, where one is wrong; to
 * be released in any case. */
bool scene_options_take(struct scene_options *options, const struct argument *arguments,
                        size_t count);
void scene_options_release(struct scene_options *options);

/* Puts the camera that was asked for first. Prints what is wrong if there is none of that name. */
bool scene_options_choose_camera(const struct scene_options *options,
                                 struct scene_description *description);

/* Calls back for each word of a command that gives the same options. */
void scene_options_each_word(const struct scene_options *options,
                             void (*each)(void *user, const char *word), void *user);

#endif
