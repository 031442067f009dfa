/* view.h: one view of the scene: options, and a render by them that goes on as a picture that gets
 * better. */
#ifndef EXPLORE_VIEW_H
#define EXPLORE_VIEW_H

#include "explore/cpu_time.h"
#include "explore/history.h"
#include "explore/option_list.h"
#include "explore/shown_picture.h"
#include "explore/watched_files.h"
#include <pthread.h>
#include <stdatomic.h>

struct explorer;

#define STAGE_LENGTH 64

/* A step that can fail, and how it did. */
struct view_failure {
    bool failed;
    psplat_error error;
};

struct view {
    struct explorer *explorer;
    bool has_thread;
    pthread_t thread;
    char name[THREAD_NAME_LENGTH]; /* of its threads */
    /* For others to be measured by: without a preview, and other threads go before its. */
    bool is_behind;

    /* What is asked for. Each change of it counts, so that a render finds out that it is no longer
     * wanted. */
    bool is_present;
    struct option_list options;
    uint32_t passes;
    psplat_scene *loaded; /* that a request loaded with these; NULL: the view loads it */
    atomic_uint changes;
    unsigned seen; /* how many the thread has dealt with */

    /* What came of it. */
    struct watched_files files;
    char *facts; /* JSON: members of an object, of scene_facts.h; NULL: nothing was loaded yet */
    struct view_failure load, render;
    struct shown_picture *shown; /* NULL: none yet */
    uint32_t shown_passes;       /* 0: it is of what was asked for before */
    double shown_cpu_seconds;    /* that these took */
    bool shows_preview;
    char stage[STAGE_LENGTH]; /* "": nothing goes on */
    double fraction;
    double seconds, cpu_seconds; /* that the passes have taken so far */
    struct history history;
};

/* Starts its thread. PS_ERROR_MEMORY where there is none to be had. */
ps_result view_start(struct view *view, const char *name);

/* After the explorer was told to stop: waits for the thread. */
void view_join(struct view *view);

/* Frees what it holds; without a thread. */
void view_release(struct view *view);

/* What is asked for has changed. Under the lock. */
void view_change(struct view *view);

/* Drops what it shows. Under the lock. */
void view_clear(struct view *view);

/* Measures its history by the reference: what was not yet, or all. */
void view_measure(struct view *view, bool anew);

#endif
