#include "explore/route.h"

#include "explore/handlers.h"
#include <string.h>

static const struct row {
    const char *method, *name; /* of the path, or with '/' of its begin */
    route_handler handle;
} rows[] = {
    {"GET", "catalogue", handle_get_catalogue},
    {"GET", "state", handle_get_state},
    {"GET", "events", handle_get_events},
    {"GET", "picture/", handle_get_picture},
    {"PUT", "view/", handle_put_view},
    {"DELETE", "view/", handle_delete_view},
    {"GET", "pixel/", handle_get_pixel},
    {"GET", "light/", handle_get_light},
    {"GET", "compare", handle_get_compare},
    {"GET", "compare_map", handle_get_compare_map},
    {"GET", "history", handle_get_history},
    {"PUT", "reference", handle_put_reference},
    {"DELETE", "reference", handle_delete_reference},
};

static bool row_has_path(const struct row *row, const char *path, const char **rest)
{
    size_t length = strlen(row->name);
    bool is_begin = row->name[length - 1] == '/';
    if (strncmp(row->name, path, length) != 0 || (!is_begin && path[length] != '\0'))
        return false;
    *rest = path + length;
    return true;
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
    if (known)
        return answer_status(request->connection, MHD_HTTP_METHOD_NOT_ALLOWED,
                             "not by this method\n");
    return strcmp(request->method, MHD_HTTP_METHOD_GET) == 0
               ? handle_get_page(request, request->path)
               : handle_unknown(request);
}
