/* handle_views.c: the page, and the views that it shows. */
#include "base/text.h"
#include "explore/catalogue.h"
#include "explore/handlers.h"
#include "explore/page.h"
#include "explore/state.h"

#include <stdlib.h>
#include <string.h>

bool handle_unknown(const struct route_request *request)
{
    return answer_status(request->connection, MHD_HTTP_NOT_FOUND, "no such address\n");
}

const char *handle_argument(const struct route_request *request, const char *name)
{
    return MHD_lookup_connection_value(request->connection, MHD_GET_ARGUMENT_KIND, name);
}

bool handle_coordinate(const struct route_request *request, const char *name, size_t limit,
                       size_t *coordinate)
{
    const char *text = handle_argument(request, name);
    double number;
    if (!text || !text_to_number(text, &number) || number < 0.0 || number >= (double)limit)
        return false;
    *coordinate = (size_t)number;
    return (double)*coordinate == number;
}

int handle_view_named(const char *name)
{
    return strcmp(name, "a") == 0 ? VIEW_A : strcmp(name, "b") == 0 ? VIEW_B : -1;
}

static const char *type_of(const char *name)
{
    static const char *const types[][2] = {
        {".html", "text/html; charset=utf-8"},
        {".css", "text/css; charset=utf-8"},
        {".js", "text/javascript; charset=utf-8"},
        {".svg", "image/svg+xml"},
    };
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++)
        if (text_has_suffix(name, types[i][0]))
            return types[i][1];
    return "application/octet-stream";
}

bool handle_get_page(const struct route_request *request, const char *name)
{
    for (size_t i = 0; i < page_file_count; i++)
        if (strcmp(page_files[i].name, name[0] ? name : "index.html") == 0)
            return answer_bytes(request->connection, type_of(page_files[i].name),
                                page_files[i].bytes, page_files[i].length);
    return handle_unknown(request);
}

bool handle_get_catalogue(const struct route_request *request, const char *rest)
{
    (void)rest;
    return answer_json(request->connection, MHD_HTTP_OK, catalogue_write(request->explorer));
}

bool handle_get_state(const struct route_request *request, const char *rest)
{
    uint64_t serial;
    (void)rest;
    return answer_json(request->connection, MHD_HTTP_OK, state_write(request->explorer, &serial));
}

bool handle_get_events(const struct route_request *request, const char *rest)
{
    (void)rest;
    return answer_events(request->connection, request->explorer);
}

bool handle_get_picture(const struct route_request *request, const char *rest)
{
    int view = handle_view_named(rest);
    if (view < 0)
        return handle_unknown(request);
    return answer_picture(request->connection, explorer_picture(request->explorer, view),
                          handle_argument(request, "layer"));
}

/* --- changes
 * ----------------------------------------------------------------------------------------- */

bool handle_change(const struct route_request *request, ps_result result, const char *message)
{
    if (result == PS_OK)
        return answer_status(request->connection, MHD_HTTP_NO_CONTENT, "");
    return answer_message(request->connection,
                          result == PS_ERROR_MEMORY ? MHD_HTTP_INTERNAL_SERVER_ERROR
                                                    : MHD_HTTP_UNPROCESSABLE_CONTENT,
                          message);
}

ps_result handle_read_body(const struct route_request *request, struct arena *arena,
                           struct json **root, struct error *error)
{
    return json_read(arena, request->body, request->length, root, error);
}

static ps_result read_view(const struct json *root, struct option_list *options, uint32_t *passes,
                           struct error *error)
{
    size_t number;
    ps_result result = option_list_read(options, json_member(root, "options"), error);
    if (result != PS_OK)
        return result;
    if (!json_size(root, "passes", DEFAULT_VIEW_PASSES, &number) || number < 1 ||
        number > MOST_VIEW_PASSES)
        return error_set(error, PS_ERROR_INVALID, "passes: expected a whole number 1..%d",
                         MOST_VIEW_PASSES);
    *passes = (uint32_t)number;
    return PS_OK;
}

/* The view takes over the options where they make sense. */
static ps_result put_view(const struct route_request *request, int view, psplat_error *told)
{
    struct option_list options = {0};
    uint32_t passes = 0;
    struct arena arena = {0};
    struct json *root;
    struct error error;
    ps_result result = handle_read_body(request, &arena, &root, &error);
    if (result == PS_OK)
        result = read_view(root, &options, &passes, &error);
    arena_release(&arena);
    if (result == PS_OK) {
        result = explorer_put_view(request->explorer, view, &options, passes, told);
        /* A picture too large for the memory is as wrong an option as others. */
        return result == PS_ERROR_MEMORY ? PS_ERROR_INVALID : result;
    }
    snprintf(told->message, sizeof told->message, "%s", error.text);
    option_list_release(&options);
    return result;
}

bool handle_put_view(const struct route_request *request, const char *rest)
{
    int view = handle_view_named(rest);
    psplat_error told = {.message = ""};
    if (view < 0)
        return handle_unknown(request);
    ps_result result = put_view(request, view, &told);
    return handle_change(request, result, told.message);
}

bool handle_delete_view(const struct route_request *request, const char *rest)
{
    int view = handle_view_named(rest);
    if (view != VIEW_B) /* there is always one to look at */
        return handle_unknown(request);
    explorer_delete_view(request->explorer, view);
    return handle_change(request, PS_OK, "");
}
