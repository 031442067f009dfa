/* handle_measures.c: pixels, comparisons and the reference. */
#include "explore/comparison.h"
#include "explore/handlers.h"
#include "explore/state.h"

#include <stdlib.h>
#include <string.h>

/* --- pixels
 * ------------------------------------------------------------------------------------------ */

struct pixel {
    struct json_writer *writer;
    size_t index;
};

static void write_samples(void *user, const struct shown_layer *layer)
{
    const struct pixel *pixel = user;
    json_writer_key(pixel->writer, layer->name);
    json_writer_open(pixel->writer, '[');
    for (size_t c = 0; c < layer->channel_count; c++)
        json_number_write(pixel->writer, (double)layer->planes[c][pixel->index]);
    json_writer_close(pixel->writer, '[');
}

static char *pixel_text(const struct shown_picture *shown, size_t index)
{
    struct json_buffer buffer;
    struct pixel pixel = {.writer = &buffer.writer, .index = index};
    if (!json_buffer_begin(&buffer))
        return NULL;
    json_writer_open(&buffer.writer, '{');
    json_writer_number_of(&buffer.writer, "picture", (double)shown_picture_number(shown));
    json_writer_open_of(&buffer.writer, "layers", '{');
    shown_picture_each_layer(shown, write_samples, &pixel);
    json_writer_close(&buffer.writer, '{');
    json_writer_close(&buffer.writer, '{');
    return json_buffer_end(&buffer);
}

bool handle_get_pixel(const struct route_request *request, const char *rest)
{
    int view = handle_view_named(rest);
    size_t x, y;
    struct shown_picture *shown = view < 0 ? NULL : explorer_picture(request->explorer, view);
    bool found = shown && handle_coordinate(request, "x", shown_picture_width(shown), &x) &&
                 handle_coordinate(request, "y", shown_picture_height(shown), &y);
    bool good = found ? answer_json(request->connection, MHD_HTTP_OK,
                                    pixel_text(shown, y * shown_picture_width(shown) + x))
                      : handle_unknown(request);
    shown_picture_release(shown);
    return good;
}

/* --- comparisons
 * ------------------------------------------------------------------------------------- */

/* What is compared with what; both pictures are to be released. */
struct comparison {
    const char *layer;
    struct shown_picture *test, *reference; /* NULL: not there */
};

static struct shown_picture *picture_named(const struct route_request *request, const char *name)
{
    struct explorer *explorer = request->explorer;
    int view = handle_view_named(name);
    if (view >= 0)
        return explorer_picture(explorer, view);
    if (strcmp(name, "reference") != 0)
        return NULL;
    pthread_mutex_lock(&explorer->lock);
    struct shown_picture *shown = reference_picture(explorer);
    pthread_mutex_unlock(&explorer->lock);
    return shown;
}

static bool has_second_view(struct explorer *explorer)
{
    pthread_mutex_lock(&explorer->lock);
    bool present = explorer->views[VIEW_B].is_present;
    pthread_mutex_unlock(&explorer->lock);
    return present;
}

static struct comparison comparison_of(const struct route_request *request)
{
    const char *layer = handle_argument(request, "layer"), *of = handle_argument(request, "of");
    const char *against = handle_argument(request, "against");
    if (!against)
        against = has_second_view(request->explorer) ? "b" : "reference";
    return (struct comparison){
        .layer = layer ? layer : "picture",
        .test = picture_named(request, of ? of : "a"),
        .reference = picture_named(request, against),
    };
}

static void comparison_release(struct comparison *comparison)
{
    shown_picture_release(comparison->test);
    shown_picture_release(comparison->reference);
}

static char *comparison_text(const struct comparison *comparison, ps_result *result,
                             struct error *error)
{
    struct json_buffer buffer;
    if (!json_buffer_begin(&buffer))
        return NULL;
    struct json_writer *writer = &buffer.writer;
    json_writer_open(writer, '{');
    json_writer_open_of(writer, "pictures", '[');
    json_writer_number(writer, (double)shown_picture_number(comparison->test));
    json_writer_number(writer, (double)shown_picture_number(comparison->reference));
    json_writer_close(writer, '[');
    json_writer_key(writer, "metrics");
    *result =
        comparison_write(comparison->test, comparison->reference, comparison->layer, writer, error);
    json_writer_close(writer, '{');
    return json_buffer_end(&buffer);
}

bool handle_get_compare(const struct route_request *request, const char *rest)
{
    struct comparison comparison = comparison_of(request);
    ps_result result = PS_OK;
    struct error error;
    bool good;
    (void)rest;
    if (!comparison.test || !comparison.reference) {
        good = handle_unknown(request);
    } else {
        char *text = comparison_text(&comparison, &result, &error);
        if (result == PS_OK) {
            good = answer_json(request->connection, MHD_HTTP_OK, text);
        } else {
            free(text);
            good = handle_change(request, result, error.text);
        }
    }
    comparison_release(&comparison);
    return good;
}

bool handle_get_compare_map(const struct route_request *request, const char *rest)
{
    struct comparison comparison = comparison_of(request);
    const char *metric = handle_argument(request, "metric");
    struct error error;
    float *map;
    bool good;
    (void)rest;
    if (!comparison.test || !comparison.reference) {
        good = handle_unknown(request);
    } else {
        ps_result result = comparison_map(comparison.test, comparison.reference, comparison.layer,
                                          metric ? metric : "flip", &map, &error);
        good = result == PS_OK ? answer_map(request->connection, comparison.test, map)
                               : handle_change(request, result, error.text);
        free(map);
    }
    comparison_release(&comparison);
    return good;
}

/* --- the reference
 * ----------------------------------------------------------------------------------- */

bool handle_get_history(const struct route_request *request, const char *rest)
{
    (void)rest;
    return answer_json(request->connection, MHD_HTTP_OK, state_write_history(request->explorer));
}

static ps_result put_file(struct explorer *explorer, const struct json *file, struct error *error)
{
    char *path = file->kind == JSON_STRING ? json_text_copy(file) : NULL;
    if (!path)
        return error_set(error, PS_ERROR_INVALID, "file: expected a path");
    ps_result result = reference_put_file(explorer, path, error);
    free(path);
    return result;
}

static ps_result put_view(struct explorer *explorer, const struct json *view, struct error *error)
{
    char *name = view->kind == JSON_STRING ? json_text_copy(view) : NULL;
    int index = name ? handle_view_named(name) : -1;
    free(name);
    if (index < 0)
        return error_set(error, PS_ERROR_INVALID, "view: expected \"a\" or \"b\"");
    return reference_put_view(explorer, index, error);
}

static ps_result put_paths(struct explorer *explorer, const struct json *paths, struct error *error)
{
    size_t samples;
    if (!json_size(paths, "samples", 256, &samples) || samples < 1 ||
        samples > MOST_REFERENCE_SAMPLES)
        return error_set(error, PS_ERROR_INVALID, "samples: expected a whole number 1..%d",
                         MOST_REFERENCE_SAMPLES);
    return reference_put_paths(explorer, (uint32_t)samples, error);
}

static ps_result put_reference(struct explorer *explorer, const struct json *root,
                               struct error *error)
{
    const struct json *file = json_member(root, "file"), *view = json_member(root, "view");
    const struct json *paths = json_member(root, "path_tracer");
    if (!file + !view + !paths != 2)
        return error_set(error, PS_ERROR_INVALID,
                         "expected one of \"file\", \"view\" and \"path_tracer\"");
    return file   ? put_file(explorer, file, error)
           : view ? put_view(explorer, view, error)
                  : put_paths(explorer, paths, error);
}

bool handle_put_reference(const struct route_request *request, const char *rest)
{
    struct arena arena = {0};
    struct json *root;
    struct error error;
    (void)rest;
    ps_result result = handle_read_body(request, &arena, &root, &error);
    if (result == PS_OK)
        result = put_reference(request->explorer, root, &error);
    arena_release(&arena);
    return handle_change(request, result, error.text);
}

bool handle_delete_reference(const struct route_request *request, const char *rest)
{
    (void)rest;
    reference_delete(request->explorer);
    return handle_change(request, PS_OK, "");
}
