#include "explore/reference.h"

#include "base/input_file.h"
#include "base/path.h"
#include "explore/explorer.h"
#include "explore/json_text.h"
#include <stdlib.h>
#include <string.h>

/* Random numbers that no view has, so that what both have wrong alike does not look right. */
#define REFERENCE_SEED "6700417"

/* So many of the paths make a pass: pictures come early, and edges get smooth. */
#define SAMPLES_OF_PASS 4

/* --- path tracing
 * ------------------------------------------------------------------------------------ */

static bool add_own(struct option_list *list, uint32_t samples)
{
    char text[64];
    snprintf(text, sizeof text, "estimator=pathtrace:samples=%u", (unsigned)samples);
    return option_list_add(list, "plugin", text) &&
           option_list_add(list, "plugin", "denoiser=none") &&
           option_list_add(list, "seed", REFERENCE_SEED);
}

/* False when out of memory; to be released in any case. */
static bool make_options(const struct option_list *view, uint32_t samples, struct option_list *list)
{
    return option_list_append_scene(list, view) &&
           add_own(list, samples < SAMPLES_OF_PASS ? samples : SAMPLES_OF_PASS);
}

static bool options_are_same(const struct option_list *a, const struct option_list *b)
{
    bool same = a->count == b->count;
    for (size_t i = 0; i < a->count && same; i++)
        same = strcmp(a->items[i].name, b->items[i].name) == 0 &&
               strcmp(a->items[i].value, b->items[i].value) == 0;
    return same;
}

static struct view *paths_of(struct explorer *explorer)
{
    return &explorer->views[VIEW_REFERENCE];
}

/* Nothing is measured by a reference that is not there. */
static void forget_errors(struct explorer *explorer)
{
    for (size_t i = 0; i < VIEW_COUNT; i++)
        history_forget_errors(&explorer->views[i].history);
}

/* False when out of memory. */
static bool start_paths(struct explorer *explorer, uint32_t samples)
{
    struct view *view = paths_of(explorer);
    struct option_list options = {0};
    if (!make_options(&explorer->views[VIEW_A].options, samples, &options)) {
        option_list_release(&options);
        return false;
    }
    option_list_release(&view->options);
    view->options = options;
    view->passes = (samples + SAMPLES_OF_PASS - 1) / SAMPLES_OF_PASS;
    view->is_present = true;
    view_clear(view);
    view_change(view);
    forget_errors(explorer);
    return true;
}

void reference_follow(struct explorer *explorer)
{
    struct option_list options = {0};
    uint32_t samples = explorer->reference.samples;
    if (explorer->reference.kind != REFERENCE_PATHS)
        return;
    if (make_options(&explorer->views[VIEW_A].options, samples, &options) &&
        !options_are_same(&options, &paths_of(explorer)->options))
        start_paths(explorer, samples);
    option_list_release(&options);
}

/* --- putting and deleting
 * ---------------------------------------------------------------------------- */

/* Without a reference. */
static void drop(struct explorer *explorer)
{
    struct view *view = paths_of(explorer);
    reference_release(&explorer->reference);
    if (view->is_present) {
        view->is_present = false;
        view_clear(view);
        view_change(view);
    }
    forget_errors(explorer);
    explorer_tell(explorer);
}

void reference_delete(struct explorer *explorer)
{
    pthread_mutex_lock(&explorer->lock);
    drop(explorer);
    pthread_mutex_unlock(&explorer->lock);
}

/* Takes over the picture and the name. */
static void set_picture(struct explorer *explorer, enum reference_kind kind, char *file,
                        struct shown_picture *shown)
{
    pthread_mutex_lock(&explorer->lock);
    drop(explorer);
    explorer->reference = (struct reference){.kind = kind, .file = file, .shown = shown};
    pthread_mutex_unlock(&explorer->lock);
    for (int i = VIEW_A; i <= VIEW_B; i++)
        view_measure(&explorer->views[i], true);
}

/* Where the scene is, unless it is absolute; to be freed. */
static char *beside_scene(const struct explorer *explorer, const char *path)
{
    char *made = NULL;
    int folder = path[0] == '/' ? 0 : (int)(path_name(explorer->path) - explorer->path);
    return asprintf(&made, "%.*s%s", folder, explorer->path, path) < 0 ? NULL : made;
}

/* As --restrict forbids a scene to read other files. One that is not there is told alike. */
static ps_result check_folder(const struct explorer *explorer, const char *path,
                              struct error *error)
{
    const char *restricted = option_list_value(&explorer->fixed, "restrict");
    if (!restricted)
        return PS_OK;
    char *folder = input_folder_resolve(restricted, error);
    if (!folder)
        return PS_ERROR_INVALID;
    bool allowed = input_file_exists(path, folder);
    free(folder);
    return allowed ? PS_OK
                   : error_set(error, PS_ERROR_INVALID,
                               "%.1000s: no file in the folder that --restrict names", path);
}

ps_result reference_put_file(struct explorer *explorer, const char *path, struct error *error)
{
    struct shown_picture *shown;
    char *found = beside_scene(explorer, path);
    if (!found)
        return error_memory(error, strlen(path), "a name");
    ps_result allowed = check_folder(explorer, found, error);
    if (allowed != PS_OK) {
        free(found);
        return allowed;
    }
    pthread_mutex_lock(&explorer->lock);
    uint64_t number = ++explorer->pictures;
    pthread_mutex_unlock(&explorer->lock);
    ps_result result = shown_picture_read(found, number, &shown, error);
    if (result == PS_OK)
        set_picture(explorer, REFERENCE_FILE, found, shown);
    else
        free(found);
    return result;
}

ps_result reference_put_view(struct explorer *explorer, int view, struct error *error)
{
    struct shown_picture *shown = explorer_picture(explorer, view);
    if (!shown)
        return error_set(error, PS_ERROR_INVALID, "the view has no picture yet");
    set_picture(explorer, REFERENCE_VIEW, NULL, shown);
    return PS_OK;
}

ps_result reference_put_paths(struct explorer *explorer, uint32_t samples, struct error *error)
{
    pthread_mutex_lock(&explorer->lock);
    drop(explorer);
    bool good = start_paths(explorer, samples);
    if (good)
        explorer->reference = (struct reference){.kind = REFERENCE_PATHS, .samples = samples};
    pthread_mutex_unlock(&explorer->lock);
    return good ? PS_OK : error_memory(error, 0, "a reference");
}

struct shown_picture *reference_picture(const struct explorer *explorer)
{
    const struct reference *reference = &explorer->reference;
    return shown_picture_keep(reference->kind == REFERENCE_PATHS
                                  ? explorer->views[VIEW_REFERENCE].shown
                                  : reference->shown);
}

void reference_release(struct reference *reference)
{
    free(reference->file);
    shown_picture_release(reference->shown);
    *reference = (struct reference){.kind = REFERENCE_NONE};
}

/* --- as JSON
 * ----------------------------------------------------------------------------------------- */

static void write_paths(const struct explorer *explorer, struct json_writer *writer)
{
    const struct view *view = &explorer->views[VIEW_REFERENCE];
    const struct view_failure *failure = view->load.failed ? &view->load : &view->render;
    json_writer_number_of(writer, "samples", explorer->reference.samples);
    json_writer_number_of(writer, "passes", view->shows_preview ? 0.0 : view->shown_passes);
    json_writer_number_of(writer, "passes_wanted", view->passes);
    json_writer_text_of(writer, "stage", view->stage);
    json_text_write_of(writer, "error", failure->failed ? failure->error.message : NULL);
}

void reference_write(const struct explorer *explorer, struct json_writer *writer)
{
    static const char *const kinds[] = {
        [REFERENCE_NONE] = "",
        [REFERENCE_FILE] = "file",
        [REFERENCE_VIEW] = "view",
        [REFERENCE_PATHS] = "path_tracer",
    };
    const struct reference *reference = &explorer->reference;
    if (reference->kind == REFERENCE_NONE) {
        json_writer_raw(writer, "null");
        return;
    }
    struct shown_picture *shown = reference_picture(explorer);
    json_writer_open(writer, '{');
    json_writer_text_of(writer, "kind", kinds[reference->kind]);
    json_writer_number_of(writer, "picture", shown ? (double)shown_picture_number(shown) : 0.0);
    json_text_write_of(writer, "file", reference->file);
    if (reference->kind == REFERENCE_PATHS)
        write_paths(explorer, writer);
    json_writer_close(writer, '{');
    shown_picture_release(shown);
}
