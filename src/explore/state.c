#include "explore/state.h"

#include "base/shell_word.h"
#include "explore/explorer.h"
#include "explore/json_text.h"
#include <stdlib.h>

static void write_error(struct json_writer *writer, const char *key,
                        const struct view_failure *failure)
{
    const psplat_error *error = &failure->error;
    if (!failure->failed) {
        json_writer_raw_of(writer, key, "null");
        return;
    }
    json_writer_open_of(writer, key, '{');
    json_text_write_of(writer, "message", error->message);
    json_text_write_of(writer, "file", error->file[0] ? error->file : NULL);
    json_writer_number_of(writer, "line", error->line);
    json_writer_number_of(writer, "column", error->column);
    json_writer_close(writer, '{');
}

/* That makes the picture that is shown; while that is a preview, the one that is to come. */
static void write_command(const struct explorer *explorer, const struct view *view,
                          struct json_writer *writer)
{
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    if (!stream)
        return;
    fputs("psplat render ", stream); /* the scene may have the name of another command */
    shell_word_print_path(stream, explorer->path);
    option_list_print(&explorer->fixed, stream);
    option_list_print(&view->options, stream);
    bool is_shown = view->shown_passes > 0 && !view->shows_preview;
    fprintf(stream, " --passes %u", (unsigned)(is_shown ? view->shown_passes : view->passes));
    fclose(stream);
    json_text_write_of(writer, "command", text);
    free(text);
}

static void write_layer(void *user, const struct shown_layer *layer)
{
    struct json_writer *writer = user;
    json_writer_open(writer, '{');
    json_text_write_of(writer, "name", layer->name);
    json_writer_number_of(writer, "channels", (double)layer->channel_count);
    json_writer_close(writer, '{');
}

static void write_picture(const struct shown_picture *shown, struct json_writer *writer)
{
    json_writer_number_of(writer, "picture", shown ? (double)shown_picture_number(shown) : 0.0);
    json_writer_number_of(writer, "width", shown ? (double)shown_picture_width(shown) : 0.0);
    json_writer_number_of(writer, "height", shown ? (double)shown_picture_height(shown) : 0.0);
    json_writer_open_of(writer, "layers", '[');
    if (shown)
        shown_picture_each_layer(shown, write_layer, writer);
    json_writer_close(writer, '[');
}

static void write_view(const struct explorer *explorer, const struct view *view,
                       struct json_writer *writer)
{
    if (!view->is_present) {
        json_writer_raw(writer, "null");
        return;
    }
    json_writer_open(writer, '{');
    json_writer_key(writer, "options");
    option_list_write(&view->options, writer);
    write_command(explorer, view, writer);
    json_writer_text_of(writer, "stage", view->stage);
    json_number_write_of(writer, "fraction", view->fraction);
    json_writer_number_of(writer, "passes", view->shown_passes);
    json_writer_number_of(writer, "passes_wanted", view->passes);
    json_writer_raw_of(writer, "preview", view->shows_preview ? "true" : "false");
    json_number_write_of(writer, "seconds", view->seconds);
    json_number_write_of(writer, "cpu_seconds", view->cpu_seconds);
    write_picture(view->shown, writer);
    if (view->facts)
        json_writer_raw(writer, view->facts);
    write_error(writer, "error", &view->render);
    json_writer_close(writer, '{');
}

static const struct view_failure *scene_failure(const struct explorer *explorer)
{
    for (size_t i = VIEW_A; i <= VIEW_B; i++)
        if (explorer->views[i].is_present && explorer->views[i].load.failed)
            return &explorer->views[i].load;
    return &explorer->views[VIEW_A].load;
}

char *state_write_history(struct explorer *explorer)
{
    struct json_buffer buffer;
    if (!json_buffer_begin(&buffer))
        return NULL;
    pthread_mutex_lock(&explorer->lock);
    json_writer_open(&buffer.writer, '{');
    json_writer_key(&buffer.writer, "a");
    history_write(&explorer->views[VIEW_A].history, &buffer.writer);
    json_writer_key(&buffer.writer, "b");
    history_write(&explorer->views[VIEW_B].history, &buffer.writer);
    json_writer_close(&buffer.writer, '{');
    pthread_mutex_unlock(&explorer->lock);
    return json_buffer_end(&buffer);
}

char *state_write(struct explorer *explorer, uint64_t *serial)
{
    struct json_buffer buffer;
    if (!json_buffer_begin(&buffer))
        return NULL;
    struct json_writer *writer = &buffer.writer;
    pthread_mutex_lock(&explorer->lock);
    *serial = explorer->serial;
    json_writer_open(writer, '{');
    json_writer_number_of(writer, "serial", (double)explorer->serial);
    json_writer_number_of(writer, "catalogue", (double)explorer->catalogue);
    json_writer_open_of(writer, "views", '{');
    json_writer_key(writer, "a");
    write_view(explorer, &explorer->views[VIEW_A], writer);
    json_writer_key(writer, "b");
    write_view(explorer, &explorer->views[VIEW_B], writer);
    json_writer_close(writer, '{');
    write_error(writer, "scene_error", scene_failure(explorer));
    json_writer_key(writer, "reference");
    reference_write(explorer, writer);
    json_writer_close(writer, '{');
    pthread_mutex_unlock(&explorer->lock);
    return json_buffer_end(&buffer);
}
