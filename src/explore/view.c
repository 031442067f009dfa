#include "explore/view.h"

#include "base/clock.h"
#include "explore/explorer.h"
#include "explore/scene_facts.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

/* Between what is told of progress, and between pictures of passes that take less. */
#define TELL_SECONDS 0.1
#define SHOW_SECONDS 0.5

/* What a picture costs, with its denoiser, is at most this share of the time. */
#define SHOW_SHARE 0.2

#define BEHIND_NICE 15

/* Of the first preview, and of the second. That may take some time, and more where the first pass
 * takes long. */
#define FIRST_PIXELS 10000.0
#define MOST_PIXELS 230400.0
#define PREVIEW_SECONDS 0.5
#define MOST_PREVIEW_SECONDS 2.0
#define PREVIEW_SHARE 0.03 /* of the first pass */

/* One render of a view. */
struct work {
    struct view *view;
    struct explorer *explorer;
    unsigned change; /* that it is for */
    bool is_preview;
    double start, cpu_start;
    double seconds, cpu_seconds; /* since then, without what pictures took */
    double timed, told, shown;   /* when something was, last */
    const char *stage;           /* that was told of */
    double show_cost;            /* seconds that the last picture took */
};

static int index_of(const struct view *view)
{
    return (int)(view - view->explorer->views);
}

static bool is_over(const struct work *work)
{
    return atomic_load(&work->explorer->stopping) ||
           atomic_load(&work->view->changes) != work->change;
}

static int was_cancelled(void *user)
{
    return is_over(user);
}

static void set_stage(struct view *view, const char *stage, double fraction)
{
    snprintf(view->stage, sizeof view->stage, "%s", stage);
    view->fraction = fraction;
    explorer_tell(view->explorer);
}

/* While its threads are there. Outside of the lock: the system has much to look up. */
static void take_time(struct work *work)
{
    work->timed = clock_seconds();
    work->seconds = work->timed - work->start;
    work->cpu_seconds = cpu_time_of_threads(work->view->name) - work->cpu_start;
}

/* Under the lock. */
static void set_time(const struct work *work)
{
    if (work->is_preview)
        return;
    work->view->seconds = work->seconds;
    work->view->cpu_seconds = work->cpu_seconds;
}

static void show_progress(void *user, const psplat_progress *progress)
{
    struct work *work = user;
    double now = clock_seconds();
    bool is_new = !work->stage || strcmp(progress->stage, work->stage) != 0;
    if ((now - work->told < TELL_SECONDS && !is_new) || is_over(work))
        return;
    work->told = now;
    work->stage = progress->stage;
    if (now - work->timed >= TELL_SECONDS)
        take_time(work);
    pthread_mutex_lock(&work->explorer->lock);
    set_time(work);
    set_stage(work->view, work->is_preview ? "preview" : progress->stage, progress->fraction);
    pthread_mutex_unlock(&work->explorer->lock);
}

/* Outside of the lock: on copies. */
void view_measure(struct view *view, bool anew)
{
    struct explorer *explorer = view->explorer;
    pthread_mutex_lock(&explorer->measuring);
    pthread_mutex_lock(&explorer->lock);
    struct shown_picture *shown = reference_picture(explorer);
    struct history history = history_copy(&view->history);
    pthread_mutex_unlock(&explorer->lock);
    struct picture_sample *reference = shown ? picture_sample_create(shown) : NULL;
    if (reference && history.count > 0) {
        history_measure(&history, reference, anew);
        pthread_mutex_lock(&explorer->lock);
        struct shown_picture *now = reference_picture(explorer);
        if (now == shown) /* or another has come since, and measures by itself */
            history_take_errors(&view->history, &history);
        shown_picture_release(now);
        explorer_tell(explorer);
        pthread_mutex_unlock(&explorer->lock);
    }
    pthread_mutex_unlock(&explorer->measuring);
    history_clear(&history);
    picture_sample_release(reference);
    shown_picture_release(shown);
}

/* A new picture is measured by the reference; all by one that is a new reference. */
static void measure(struct view *view)
{
    struct explorer *explorer = view->explorer;
    if (view->is_behind) {
        view_measure(&explorer->views[VIEW_A], true);
        view_measure(&explorer->views[VIEW_B], true);
    } else {
        view_measure(view, false);
    }
}

/* Puts a picture in place; false, and nothing has changed, where it is no longer wanted. Under the
 * lock. */
static bool put_in_place(const struct work *work, struct shown_picture *shown, uint32_t passes,
                         struct picture_sample *sample)
{
    struct view *view = work->view;
    if (is_over(work))
        return false;
    set_time(work);
    view->shown = shown;
    view->shown_passes = passes;
    view->shows_preview = work->is_preview;
    if (sample)
        history_add(&view->history, passes, view->cpu_seconds, sample);
    explorer_tell(work->explorer);
    return true;
}

static uint64_t next_number(struct explorer *explorer)
{
    pthread_mutex_lock(&explorer->lock);
    uint64_t number = ++explorer->pictures;
    pthread_mutex_unlock(&explorer->lock);
    return number;
}

/* Takes the picture over. */
static void show(struct work *work, psplat_picture *picture, uint32_t passes)
{
    struct explorer *explorer = work->explorer;
    struct view *view = work->view;
    struct shown_picture *shown = shown_picture_create(picture, next_number(explorer));
    bool has_history = shown && !work->is_preview && !view->is_behind;
    struct picture_sample *sample = has_history ? picture_sample_create(shown) : NULL;
    pthread_mutex_lock(&explorer->lock);
    struct shown_picture *last = view->shown;
    bool is_shown = shown && put_in_place(work, shown, passes, sample);
    pthread_mutex_unlock(&explorer->lock);
    shown_picture_release(is_shown ? last : shown);
    if (!is_shown)
        picture_sample_release(sample);
    else if (!work->is_preview)
        measure(view);
}

/* The first passes are waited for; of later ones the differences get smaller. */
static bool is_worth_showing(const struct work *work, uint32_t passes)
{
    double pause = fmax(SHOW_SECONDS, work->show_cost / SHOW_SHARE);
    bool is_power = (passes & (passes - 1)) == 0; /* which the history keeps */
    return is_power || clock_seconds() - work->shown >= pause;
}

static void show_passes(void *user, psplat_rendering *rendering, uint32_t passes)
{
    struct work *work = user;
    psplat_picture *picture;
    if (is_over(work) || !is_worth_showing(work, passes))
        return;
    double start = clock_seconds(), cpu_start = cpu_time_of_threads(work->view->name);
    take_time(work);
    psplat_rendering_picture(rendering, &picture, NULL);
    if (picture)
        show(work, picture, passes);
    work->shown = clock_seconds();
    work->show_cost = work->shown - start;
    work->start += work->show_cost; /* passes are what is timed */
    work->cpu_start += cpu_time_of_threads(work->view->name) - cpu_start;
}

static ps_result render(struct work *work, const psplat_scene *scene, uint32_t passes,
                        psplat_error *error)
{
    const psplat_callbacks callbacks = {
        .size = sizeof callbacks,
        .user = work,
        .progress = show_progress,
        .cancelled = was_cancelled,
        .pass = show_passes,
    };
    psplat_picture *picture = NULL;
    work->stage = NULL;
    work->start = work->shown = clock_seconds();
    work->cpu_start = cpu_time_of_threads(work->view->name);
    work->seconds = work->cpu_seconds = 0.0;
    ps_result result = psplat_render(scene, &callbacks, &picture, error);
    take_time(work);
    if (picture && result != PS_CANCELLED)
        show(work, picture, passes);
    else
        psplat_picture_destroy(picture);
    return result;
}

static double pixels_of(const psplat_picture *picture)
{
    return (double)psplat_picture_width(picture) * (double)psplat_picture_height(picture);
}

/* Returns the time that it took; 0 where there is none. What goes wrong, the render tells. */
static double show_preview(struct work *work, const psplat_scene *scene, double pixels)
{
    const psplat_callbacks callbacks = {.size = sizeof callbacks,
                                        .user = work,
                                        .progress = show_progress,
                                        .cancelled = was_cancelled};
    psplat_picture *picture = NULL;
    double start = clock_seconds();
    work->stage = NULL;
    if (psplat_preview(scene, (size_t)pixels, &callbacks, &picture, NULL) != PS_OK)
        return 0.0;
    double seconds = clock_seconds() - start;
    bool is_all = pixels_of(picture) < 0.5 * pixels;
    show(work, picture, 1);
    return is_all ? 0.0 : seconds;
}

/* How many pixels the second may have, where the first took so long. */
static double pixels_of_second(const psplat_scene *scene, double seconds)
{
    double pixel = seconds / FIRST_PIXELS;
    double pass = pixel * scene_facts_pixels(scene);
    double most = fmin(fmax(PREVIEW_SHARE * pass, PREVIEW_SECONDS), MOST_PREVIEW_SECONDS);
    return fmin(most / pixel, MOST_PIXELS);
}

/* One at once, and, where there is time for many more pixels, another. */
static void render_preview(struct work *work, const psplat_scene *scene)
{
    work->is_preview = true;
    double seconds = show_preview(work, scene, FIRST_PIXELS);
    double pixels = seconds > 0.0 ? pixels_of_second(scene, seconds) : 0.0;
    if (pixels > 2.0 * FIRST_PIXELS && !is_over(work))
        show_preview(work, scene, pixels);
    work->is_preview = false;
}

static void note_end(struct work *work, ps_result result, const psplat_error *error)
{
    struct view *view = work->view;
    if (is_over(work))
        return;
    view->render.failed = result != PS_OK;
    if (result != PS_OK)
        view->render.error = *error;
    set_stage(view, "", result == PS_OK ? 1.0 : 0.0);
}

/* The scene, where no request has loaded it. NULL, noted, where it can't be. */
static psplat_scene *load(struct work *work, const struct option_list *options, uint32_t passes)
{
    struct explorer *explorer = work->explorer;
    struct view *view = work->view;
    psplat_scene *scene = NULL;
    psplat_error error;
    struct timespec began;
    clock_gettime(CLOCK_REALTIME, &began);
    ps_result result = explorer_load(explorer, index_of(view), options, passes, &scene, &error);
    pthread_mutex_lock(&explorer->lock);
    if (is_over(work)) {
        /* A request has brought another since. */
    } else if (result == PS_OK) {
        explorer_note_scene(explorer, view, scene, began);
        explorer->catalogue++;
    } else {
        view->load = (struct view_failure){.failed = true, .error = error};
        if (error.file[0])
            watched_files_add(&view->files, error.file);
        watched_files_read(&view->files, began);
        set_stage(view, "", 0.0);
    }
    pthread_mutex_unlock(&explorer->lock);
    return scene;
}

static void render_scene(struct work *work, const psplat_scene *scene, uint32_t passes)
{
    struct explorer *explorer = work->explorer;
    psplat_error error = {.message = ""};
    if (!work->view->is_behind)
        render_preview(work, scene);
    ps_result result = is_over(work) ? PS_CANCELLED : render(work, scene, passes, &error);
    pthread_mutex_lock(&explorer->lock);
    note_end(work, result, &error);
    pthread_mutex_unlock(&explorer->lock);
}

/* Does what the view is asked for at present. Holds the lock at its begin and end. */
static void work_once(struct view *view)
{
    struct explorer *explorer = view->explorer;
    struct work work = {.view = view, .explorer = explorer, .change = atomic_load(&view->changes)};
    struct option_list options = {0};
    psplat_scene *scene = view->loaded;
    uint32_t passes = view->passes;
    view->loaded = NULL;
    view->seen = work.change;
    if (!view->is_present || !option_list_append(&options, &view->options)) {
        psplat_scene_destroy(scene);
        return;
    }
    view->seconds = view->cpu_seconds = 0.0;
    history_clear(&view->history);
    set_stage(view, "loading", 0.0);
    pthread_mutex_unlock(&explorer->lock);
    if (!scene)
        scene = load(&work, &options, passes);
    if (scene)
        render_scene(&work, scene, passes);
    psplat_scene_destroy(scene);
    option_list_release(&options);
    pthread_mutex_lock(&explorer->lock);
}

static void *run(void *user)
{
    struct view *view = user;
    struct explorer *explorer = view->explorer;
    pthread_setname_np(pthread_self(), view->name);
    if (view->is_behind) /* on Linux, of the thread and those that it starts */
        setpriority(PRIO_PROCESS, (id_t)gettid(), BEHIND_NICE);
    pthread_mutex_lock(&explorer->lock);
    while (!atomic_load(&explorer->stopping)) {
        if (view->seen == atomic_load(&view->changes))
            pthread_cond_wait(&explorer->work, &explorer->lock);
        else
            work_once(view);
    }
    pthread_mutex_unlock(&explorer->lock);
    return NULL;
}

ps_result view_start(struct view *view, const char *name)
{
    snprintf(view->name, sizeof view->name, "%s", name);
    return pthread_create(&view->thread, NULL, run, view) == 0 ? PS_OK : PS_ERROR_MEMORY;
}

void view_join(struct view *view)
{
    pthread_join(view->thread, NULL);
}

void view_release(struct view *view)
{
    view_clear(view);
    option_list_release(&view->options);
    psplat_scene_destroy(view->loaded);
    watched_files_release(&view->files);
    history_clear(&view->history);
    free(view->facts);
}

void view_change(struct view *view)
{
    atomic_fetch_add(&view->changes, 1);
    view->shown_passes = 0; /* of what is asked for now */
    view->shows_preview = false;
    view->render.failed = false;
    pthread_cond_broadcast(&view->explorer->work);
    set_stage(view, "loading", 0.0);
}

void view_clear(struct view *view)
{
    shown_picture_release(view->shown);
    view->shown = NULL;
    view->shown_passes = 0;
    view->shows_preview = false;
    view->stage[0] = '\0';
    view->load.failed = view->render.failed = false;
    history_clear(&view->history);
}
