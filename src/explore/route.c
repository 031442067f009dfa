#include "explore/route.h"

#include "base/text.h"
#include "explore/catalogue.h"
#include "explore/json_text.h"
#include "explore/page.h"
#include "explore/state.h"
#include <stdlib.h>
#include <string.h>

/* A handler gets what follows the name in the path: "a" of "view/a". */
typedef bool (*handler)(const struct route_request *request, const char *rest);

static bool refuse_path(const struct route_request *request)
{
    return answer_status(request->connection, MHD_HTTP_NOT_FOUND, "no such address\n");
}

static const char *argument(const struct route_request *request, const char *name)
{
    return MHD_lookup_connection_value(request->connection, MHD_GET_ARGUMENT_KIND, name);
}

/* The view of that name, or -1. */
static int view_named(const char *name)
{
    static const char *const names[VIEW_COUNT] = {"a", "b"};
    for (int i = 0; i < VIEW_COUNT; i++)
        if (strcmp(names[i], name) == 0)
            return i;
    return -1;
}

/* --- GET --------------------------------------------------------------------------------------------- */

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

static bool get_page(const struct route_request *request, const char *name)
{
    for (size_t i = 0; i < page_file_count; i++)
        if (strcmp(page_files[i].name, name[0] ? name : "index.html") == 0)
            return answer_bytes(request->connection, type_of(page_files[i].name),
                                page_files[i].bytes, page_files[i].length);
    return refuse_path(request);
}

static bool get_catalogue(const struct route_request *request, const char *rest)
{
    (void)rest;
    return answer_json(request->connection, MHD_HTTP_OK, catalogue_write(request->explorer));
}

static bool get_state(const struct route_request *request, const char *rest)
{
    uint64_t serial;
    (void)rest;
    return answer_json(request->connection, MHD_HTTP_OK, state_write(request->explorer, &serial));
}

static bool get_events(const struct route_request *request, const char *rest)
{
    (void)rest;
    return answer_events(request->connection, request->explorer);
}

static bool get_picture(const struct route_request *request, const char *rest)
{
    int view = view_named(rest);
    if (view < 0)
        return refuse_path(request);
    return answer_picture(request->connection, explorer_picture(request->explorer, view),
                          argument(request, "layer"));
}

/* --- PUT and DELETE ---------------------------------------------------------------------------------- */

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

static bool answer_change(const struct route_request *request, ps_result result,
                          const char *message)
{
    if (result == PS_OK)
        return answer_status(request->connection, MHD_HTTP_NO_CONTENT, "");
    return answer_message(request->connection,
                          result == PS_ERROR_MEMORY ? MHD_HTTP_INTERNAL_SERVER_ERROR
                                                    : MHD_HTTP_UNPROCESSABLE_CONTENT,
                          message);
}

static ps_result put_view_of(const struct route_request *request, int view, const struct json *root,
                             psplat_error *told)
{
    struct option_list options = {0};
    uint32_t passes = 0;
    struct error error;
    ps_result result = read_view(root, &options, &passes, &error);
    if (result == PS_OK)
        return explorer_put_view(request->explorer, view, &options, passes, told);
    snprintf(told->message, sizeof told->message, "%s", error.text);
    option_list_release(&options);
    return result;
}

static bool put_view(const struct route_request *request, const char *rest)
{
    int view = view_named(rest);
    struct arena arena = {0};
    struct json *root;
    struct error error;
    psplat_error told = {.message = ""};
    if (view < 0)
        return refuse_path(request);
    ps_result result = json_read(&arena, request->body, request->length, &root, &error);
    if (result == PS_OK)
        result = put_view_of(request, view, root, &told);
    else
        snprintf(told.message, sizeof told.message, "%s", error.text);
    arena_release(&arena);
    return answer_change(request, result, told.message);
}

static bool delete_view(const struct route_request *request, const char *rest)
{
    int view = view_named(rest);
    if (view != VIEW_B) /* there is always one to look at */
        return refuse_path(request);
    explorer_delete_view(request->explorer, view);
    return answer_change(request, PS_OK, "");
}

/* --- the table --------------------------------------------------------------------------------------- */

static const struct row {
    const char *method, *name; /* of the path, or with '/' of its begin */
    handler handle;
} rows[] = {
    {"GET", "catalogue", get_catalogue}, {"GET", "state", get_state},
    {"GET", "events", get_events},       {"GET", "picture/", get_picture},
    {"PUT", "view/", put_view},          {"DELETE", "view/", delete_view},
};

static bool row_has_path(const struct row *row, const char *path, const char **rest)
{
    size_t length = strlen(row->name);
    bool is_begin = row->name[length - 1] == '/';
    *rest = path + length;
    return strncmp(row->name, path, length) == 0 && (is_begin || path[length] == '\0');
}

bool route(const struct route_request *request)
{
    bool known = false;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const char *rest;
        if (!row_has_path(&rows[i], request->path, &rest))
            continue;
        known = true;
        if (strcmp(rows[i].method, request->method) == 0)
            return rows[i].handle(request, rest);
    }
    if (!known && strcmp(request->method, MHD_HTTP_METHOD_GET) == 0)
        return get_page(request, request->path);
    return known ? answer_status(request->connection, MHD_HTTP_METHOD_NOT_ALLOWED,
                                 "not by this method\n")
                 : refuse_path(request);
}
