#include "import/ahead.h"

#include "import/transfer.h"
#include <string.h>

ps_result mesh_read_ahead(const struct mesh_request *request, struct mesh_ahead *ahead,
                          struct error *error)
{
    *ahead = (struct mesh_ahead){.request = *request};
    ps_result result = mesh_import(request, &ahead->fragment, &ahead->report, error);
    ahead->is_there = result == PS_OK;
    return result;
}

static bool same_text(const char *a, const char *b)
{
    return a && b ? strcmp(a, b) == 0 : a == b;
}

/* Whether they read the same files in the same way. */
static bool same_reading(const struct mesh_request *a, const struct mesh_request *b)
{
    return mesh_request_digest(a) == mesh_request_digest(b) && same_text(a->cache, b->cache);
}

/* What the file does not have makes no difference where it was asked for and now is not. */
static bool same_part(bool was_asked, bool is_asked, size_t count)
{
    return was_asked == is_asked || (was_asked && count == 0);
}

static bool same_parts(const struct mesh_ahead *ahead, const struct mesh_request *request)
{
    const struct mesh_request *was = &ahead->request;
    const struct scene_description *fragment = &ahead->fragment;
    return same_part(was->geometry, request->geometry, fragment->mesh_count) &&
           same_part(was->materials, request->materials, fragment->material_count) &&
           same_part(was->camera, request->camera, fragment->camera_count) &&
           same_part(was->lights, request->lights, fragment->light_count);
}

bool mesh_take_ahead(struct mesh_ahead *ahead, const struct mesh_request *request,
                     struct scene_description *fragment, struct mesh_report *report)
{
    if (!ahead || !ahead->is_there || !same_reading(&ahead->request, request) ||
        !same_parts(ahead, request))
        return false;
    *fragment = ahead->fragment;
    *report = ahead->report;
    mesh_fragment_set_origins(fragment, request->origin);
    *ahead = (struct mesh_ahead){.is_there = false};
    return true;
}

void mesh_ahead_release(struct mesh_ahead *ahead)
{
    scene_description_release(&ahead->fragment);
    *ahead = (struct mesh_ahead){.is_there = false};
}
