/* explorer.h: a scene in views that render by themselves, and all that requests may ask of them.
 *
 * Threads: each view has one that renders; requests come in any others. `lock` guards all members
 * but those that say otherwise; whoever changes what a page shows calls explorer_tell under it.
 * Nothing that takes long is done under it: scenes are loaded and pictures made outside, and then
 * put in place.
 */
#ifndef EXPLORE_EXPLORER_H
#define EXPLORE_EXPLORER_H

#include "explore/option_list.h"
#include "explore/reference.h"
#include "explore/view.h"

enum { VIEW_A, VIEW_B, VIEW_REFERENCE, VIEW_COUNT };

#define MOST_VIEW_PASSES 65536
#define DEFAULT_VIEW_PASSES 64

struct explorer {
    const char *path;         /* of the scene; constant, as the following */
    struct option_list fixed; /* options of the command line that hold for every view; owned */
    char *kinds;              /* JSON: kinds of strategy, for the catalogue; owned */
    pthread_mutex_t lock;
    pthread_cond_t changed;    /* on CLOCK_MONOTONIC: `serial` grew, or it stops */
    pthread_cond_t work;       /* a view has something to do, or it stops */
    pthread_mutex_t loading;   /* held while a request loads a scene: one at a time */
    pthread_mutex_t measuring; /* held while a history is measured, before `lock` */
    uint64_t serial;           /* grows with each change of what a page shows */
    uint64_t catalogue;        /* grows when what can be set may have changed */
    uint64_t pictures;         /* how many there were */
    char *cameras; /* JSON: names, of the scene that was read last; NULL: of none. Owned */
    atomic_bool stopping;
    struct view views[VIEW_COUNT];
    struct reference reference;
};

/* Loads the scene with options of both kinds for view a. A scene whose text is wrong is no failure:
 * it may be mended. Then *problem, of any size, is what to print, or "". Takes over the lists, in
 * any case. To be released on success. */
ps_result explorer_create(struct explorer *explorer, const char *path, struct option_list *fixed,
                          struct option_list *options, uint32_t passes, psplat_error *problem);

/* Starts the views' threads. PS_ERROR_MEMORY where there are none to be had; it is to be stopped
 * then, too. */
ps_result explorer_start(struct explorer *explorer);

/* Ends all that goes on, renders too. Requests that wait for changes return. */
void explorer_stop(struct explorer *explorer);

/* After explorer_stop, when no request is left. */
void explorer_release(struct explorer *explorer);

/* Something changed. Under the lock. */
void explorer_tell(struct explorer *explorer);

/* Gives a view, which may be absent, options and a number of passes, and starts it. Takes over what
 * `options` owns, in any case. The error says why not: PS_ERROR_INVALID where the scene does not
 * take the options. */
ps_result explorer_put_view(struct explorer *explorer, int view, struct option_list *options,
                            uint32_t passes, psplat_error *error);

/* Ends a view, which may be absent. */
void explorer_delete_view(struct explorer *explorer, int view);

/* Looks whether files of the scene have changed, and lets the views that read them start anew. */
void explorer_watch(struct explorer *explorer);

/* The picture of a view, to be released; NULL: there is none. */
struct shown_picture *explorer_picture(struct explorer *explorer, int view);

/* Loads the scene for a view. Any thread. */
ps_result explorer_load(struct explorer *explorer, int view, const struct option_list *options,
                        uint32_t passes, psplat_scene **scene, psplat_error *error);

/* Takes over what a scene that was loaded for a view says of itself. Under the lock. */
void explorer_note_scene(struct explorer *explorer, struct view *view, const psplat_scene *scene,
                         struct timespec began);

#endif
