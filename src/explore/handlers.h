/* handlers.h: what route.h leads to. A handler gets what follows the name in the path: "a" of
 * "view/a". False where no answer could be sent. */
#ifndef EXPLORE_HANDLERS_H
#define EXPLORE_HANDLERS_H

#include "base/arena.h"
#include "explore/json_text.h"
#include "explore/route.h"

typedef bool (*route_handler)(const struct route_request *request, const char *rest);

/* Of the page, and the views. */
bool handle_get_page(const struct route_request *request, const char *name);
bool handle_get_catalogue(const struct route_request *request, const char *rest);
bool handle_get_state(const struct route_request *request, const char *rest);
bool handle_get_events(const struct route_request *request, const char *rest);
bool handle_get_picture(const struct route_request *request, const char *rest);
bool handle_put_view(const struct route_request *request, const char *rest);
bool handle_delete_view(const struct route_request *request, const char *rest);

/* Of what is measured. */
bool handle_get_pixel(const struct route_request *request, const char *rest);
bool handle_get_light(const struct route_request *request, const char *rest);
bool handle_get_compare(const struct route_request *request, const char *rest);
bool handle_get_compare_map(const struct route_request *request, const char *rest);
bool handle_get_history(const struct route_request *request, const char *rest);
bool handle_put_reference(const struct route_request *request, const char *rest);
bool handle_delete_reference(const struct route_request *request, const char *rest);

/* --- what they share
 * --------------------------------------------------------------------------------- */

/* 404 */
bool handle_unknown(const struct route_request *request);

/* What follows '?' by that name; NULL: nothing. */
const char *handle_argument(const struct route_request *request, const char *name);

/* A whole number from 0 on and below `limit` that follows '?' by that name; false: there is
 * none. */
bool handle_coordinate(const struct route_request *request, const char *name, size_t limit,
                       size_t *coordinate);

/* The view of that name, or -1. */
int handle_view_named(const char *name);

/* The answer to a change: 204, or 422 with a message. */
bool handle_change(const struct route_request *request, ps_result result, const char *message);

/* The body as a tree, which lives as long as the arena. */
ps_result handle_read_body(const struct route_request *request, struct arena *arena,
                           struct json **root, struct error *error);

#endif
