#include "explore/explorer.h"

#include "base/parallel.h"
#include "explore/catalogue.h"
#include "explore/json_text.h"
#include "explore/scene_facts.h"
#include <stdlib.h>
#include <string.h>

/* --- loading
 * ----------------------------------------------------------------------------------------- */

/* The machine's, shared out among the views. A reference, which lets others go before, does not
 * count. View b is loaded before it is there; a render of view a that goes on then keeps its
 * threads. */
static uint32_t thread_share(struct explorer *explorer, int view)
{
    uint32_t processors = parallel_processor_count();
    pthread_mutex_lock(&explorer->lock);
    bool two = view == VIEW_B || explorer->views[VIEW_B].is_present;
    pthread_mutex_unlock(&explorer->lock);
    return two && processors > 1 ? processors / 2 : processors;
}

/* A number as an option's value. */
static ps_result set_number(psplat_scene *scene, const char *option, uint32_t number,
                            psplat_error *error)
{
    char text[16];
    snprintf(text, sizeof text, "%u", (unsigned)number);
    return psplat_scene_set(scene, option, text, error);
}

static ps_result set_options(struct explorer *explorer, int view, const struct option_list *options,
                             uint32_t passes, psplat_scene *scene, psplat_error *error)
{
    ps_result result = set_number(scene, "threads", thread_share(explorer, view), error);
    if (result == PS_OK)
        result = option_list_set(&explorer->fixed, scene, error);
    if (result == PS_OK)
        result = option_list_set(options, scene, error);
    return result == PS_OK ? set_number(scene, "passes", passes, error) : result;
}

ps_result explorer_load(struct explorer *explorer, int view, const struct option_list *options,
                        uint32_t passes, psplat_scene **scene, psplat_error *error)
{
    psplat_scene *made = psplat_scene_create();
    *scene = NULL;
    if (!made) {
        *error = (psplat_error){.result = PS_ERROR_MEMORY, .message = "out of memory"};
        return PS_ERROR_MEMORY;
    }
    ps_result result = set_options(explorer, view, options, passes, made, error);
    if (result == PS_OK)
        result = psplat_scene_load(made, explorer->path, error);
    if (result != PS_OK)
        psplat_scene_destroy(made);
    else
        *scene = made;
    return result;
}

static void watch_file(void *user, const char *path)
{
    watched_files_add(user, path);
}

static char *facts_of(const psplat_scene *scene)
{
    struct json_buffer buffer;
    if (!json_buffer_begin(&buffer))
        return NULL;
    json_writer_open(&buffer.writer, '{');
    scene_facts_write(scene, &buffer.writer);
    json_writer_close(&buffer.writer, '{');
    char *text = json_buffer_end(&buffer);
    size_t length = text ? strlen(text) : 0;
    if (length < 2)
        return text;
    memmove(text, text + 1, length - 2); /* the members without the brackets */
    text[length - 2] = '\0';
    return text;
}

static char *cameras_of(const psplat_scene *scene)
{
    struct json_buffer buffer;
    if (!json_buffer_begin(&buffer))
        return NULL;
    scene_facts_write_cameras(scene, &buffer.writer);
    return json_buffer_end(&buffer);
}

/* Takes the text over. */
static void note_cameras(struct explorer *explorer, char *cameras)
{
    if (!cameras || !explorer->cameras || strcmp(cameras, explorer->cameras) != 0)
        explorer->catalogue++;
    free(explorer->cameras);
    explorer->cameras = cameras;
}

void explorer_note_scene(struct explorer *explorer, struct view *view, const psplat_scene *scene,
                         struct timespec began)
{
    free(view->facts);
    view->facts = facts_of(scene);
    view->load.failed = false;
    watched_files_release(&view->files);
    watched_files_add(&view->files, explorer->path);
    scene_facts_each_file(scene, watch_file, &view->files);
    watched_files_read(&view->files, began);
    note_cameras(explorer, cameras_of(scene));
    explorer_tell(explorer);
}

/* --- requests
 * ---------------------------------------------------------------------------------------- */

void explorer_tell(struct explorer *explorer)
{
    explorer->serial++;
    pthread_cond_broadcast(&explorer->changed);
}

/* Puts what was asked for, and loaded, in place. */
static void set_view(struct explorer *explorer, int index, struct option_list *options,
                     uint32_t passes, psplat_scene *scene, struct timespec began)
{
    struct view *view = &explorer->views[index];
    pthread_mutex_lock(&explorer->lock);
    struct option_list last = view->options;
    psplat_scene *unused = view->loaded;
    view->is_present = true;
    view->options = *options;
    view->passes = passes;
    view->loaded = scene;
    if (scene)
        explorer_note_scene(explorer, view, scene, began);
    view_change(view);
    if (index == VIEW_A)
        reference_follow(explorer);
    pthread_mutex_unlock(&explorer->lock);
    *options = last;
    psplat_scene_destroy(unused);
}

static bool scene_is_wrong(struct explorer *explorer)
{
    bool wrong = false;
    pthread_mutex_lock(&explorer->lock);
    for (size_t i = VIEW_A; i <= VIEW_B; i++)
        wrong = wrong || explorer->views[i].load.failed;
    pthread_mutex_unlock(&explorer->lock);
    return wrong;
}

/* Where the scene itself is wrong, options can't be judged, and are taken as they are. */
static ps_result load_for(struct explorer *explorer, int view, struct option_list *options,
                          uint32_t passes, psplat_error *error)
{
    psplat_scene *scene;
    struct timespec began;
    clock_gettime(CLOCK_REALTIME, &began);
    ps_result result = explorer_load(explorer, view, options, passes, &scene, error);
    if (result != PS_OK && !(error->file[0] && scene_is_wrong(explorer)))
        return result;
    set_view(explorer, view, options, passes, scene, began);
    return PS_OK;
}

ps_result explorer_put_view(struct explorer *explorer, int view, struct option_list *options,
                            uint32_t passes, psplat_error *error)
{
    pthread_mutex_lock(&explorer->loading);
    ps_result result = load_for(explorer, view, options, passes, error);
    pthread_mutex_unlock(&explorer->loading);
    option_list_release(options);
    return result;
}

void explorer_delete_view(struct explorer *explorer, int index)
{
    struct view *view = &explorer->views[index];
    pthread_mutex_lock(&explorer->lock);
    view->is_present = false;
    view_clear(view);
    view_change(view);
    pthread_mutex_unlock(&explorer->lock);
}

void explorer_watch(struct explorer *explorer)
{
    pthread_mutex_lock(&explorer->lock);
    for (size_t i = 0; i < VIEW_COUNT; i++) {
        struct view *view = &explorer->views[i];
        if (!view->is_present || !watched_files_changed(&view->files))
            continue;
        psplat_scene_destroy(view->loaded); /* it is of the files as they were */
        view->loaded = NULL;
        view_change(view);
    }
    pthread_mutex_unlock(&explorer->lock);
}

struct shown_picture *explorer_picture(struct explorer *explorer, int view)
{
    pthread_mutex_lock(&explorer->lock);
    struct shown_picture *shown = shown_picture_keep(explorer->views[view].shown);
    pthread_mutex_unlock(&explorer->lock);
    return shown;
}

/* --- its life
 * ---------------------------------------------------------------------------------------- */

static void init_locks(struct explorer *explorer)
{
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_cond_init(&explorer->changed, &attributes);
    pthread_condattr_destroy(&attributes);
    pthread_cond_init(&explorer->work, NULL);
    pthread_mutex_init(&explorer->lock, NULL);
    pthread_mutex_init(&explorer->loading, NULL);
    pthread_mutex_init(&explorer->measuring, NULL);
}

static void release(struct explorer *explorer)
{
    for (size_t i = 0; i < VIEW_COUNT; i++)
        view_release(&explorer->views[i]);
    reference_release(&explorer->reference);
    pthread_mutex_destroy(&explorer->measuring);
    pthread_mutex_destroy(&explorer->loading);
    pthread_mutex_destroy(&explorer->lock);
    pthread_cond_destroy(&explorer->work);
    pthread_cond_destroy(&explorer->changed);
    option_list_release(&explorer->fixed);
    free(explorer->cameras);
    free(explorer->kinds);
}

/* The first scene, before there are threads. One whose text is wrong is left to the view, which
 * then has it told. */
static ps_result load_first(struct explorer *explorer, struct option_list *options, uint32_t passes,
                            psplat_error *problem)
{
    struct view *view = &explorer->views[VIEW_A];
    psplat_scene *scene;
    struct timespec began;
    clock_gettime(CLOCK_REALTIME, &began);
    view->is_present = true;
    ps_result result = explorer_load(explorer, VIEW_A, options, passes, &scene, problem);
    if (result != PS_OK && !problem->file[0])
        return result;
    if (result == PS_OK)
        problem->message[0] = '\0';
    view->options = *options;
    view->passes = passes;
    view->loaded = scene;
    *options = (struct option_list){0};
    watched_files_add(&view->files, explorer->path);
    if (scene)
        explorer_note_scene(explorer, view, scene, began);
    atomic_store(&view->changes, 1);
    return PS_OK;
}

static ps_result make_catalogue(struct explorer *explorer, psplat_error *problem)
{
    struct error error;
    ps_result result = catalogue_kinds(&explorer->kinds, &error);
    if (result != PS_OK)
        snprintf(problem->message, sizeof problem->message, "%s", error.text);
    return result;
}

ps_result explorer_create(struct explorer *explorer, const char *path, struct option_list *fixed,
                          struct option_list *options, uint32_t passes, psplat_error *problem)
{
    *problem = (psplat_error){.result = PS_OK};
    memset(explorer, 0, sizeof *explorer);
    explorer->path = path;
    explorer->fixed = *fixed;
    for (size_t i = 0; i < VIEW_COUNT; i++)
        explorer->views[i].explorer = explorer;
    init_locks(explorer);
    ps_result result = make_catalogue(explorer, problem);
    if (result == PS_OK)
        result = load_first(explorer, options, passes, problem);
    option_list_release(options);
    if (result != PS_OK)
        release(explorer);
    return result;
}

ps_result explorer_start(struct explorer *explorer)
{
    static const char *const names[VIEW_COUNT] = {"view a", "view b", "reference"};
    for (size_t i = 0; i < VIEW_COUNT; i++) {
        struct view *view = &explorer->views[i];
        view->is_behind = i == VIEW_REFERENCE;
        view->has_thread = view_start(view, names[i]) == PS_OK;
        if (!view->has_thread)
            return PS_ERROR_MEMORY;
    }
    return PS_OK;
}

void explorer_stop(struct explorer *explorer)
{
    pthread_mutex_lock(&explorer->lock);
    atomic_store(&explorer->stopping, true);
    pthread_cond_broadcast(&explorer->work);
    explorer_tell(explorer);
    pthread_mutex_unlock(&explorer->lock);
}

void explorer_release(struct explorer *explorer)
{
    for (size_t i = 0; i < VIEW_COUNT; i++)
        if (explorer->views[i].has_thread)
            view_join(&explorer->views[i]);
    release(explorer);
}
