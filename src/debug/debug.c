#include "debug/debug.h"

#include "base/suggestion.h"
#include "pipeline/render.h"
#include <stdio.h>
#include <string.h>

static const struct debug_view *const views[] = {&debug_photons, &debug_voxels,  &debug_gbuffer,
                                                 &debug_maps,    &debug_overlap, &debug_pixel};
enum { VIEWS = sizeof views / sizeof views[0] };

static ps_result report_unknown(const char *name, struct error *error)
{
    char known[256] = "";
    struct suggestion suggestion = suggestion_start(name);
    char hint[SUGGESTION_TEXT];
    for (size_t i = 0; i < VIEWS; i++) {
        size_t length = strlen(known);
        snprintf(known + length, sizeof known - length, "%s%s", i > 0 ? ", " : "", views[i]->name);
        suggestion_consider(&suggestion, views[i]->name);
    }
    suggestion_text(&suggestion, hint);
    if (suggestion.best)
        return error_set(error, PS_ERROR_INVALID, "there is no view '%s'%s", name, hint);
    return error_set(error, PS_ERROR_INVALID, "there is no view '%s'; there are: %s", name, known);
}

static ps_result report_unknown_part(const char *name, const struct debug_view *view,
                                     struct error *error)
{
    char known[256] = "";
    if (!view->parts)
        return error_set(error, PS_ERROR_INVALID, "the view %s has no parts, such as '%s'",
                         view->name, name);
    for (size_t i = 0; view->parts[i]; i++) {
        size_t length = strlen(known);
        snprintf(known + length, sizeof known - length, "%s%s", i > 0 ? ", " : "", view->parts[i]);
    }
    return error_set(error, PS_ERROR_INVALID, "the view %s has no part '%s'; it has: %s",
                     view->name, name, known);
}

static ps_result find_part(const char *name, struct debug_request *request, struct error *error)
{
    for (int i = 0; request->view->parts && request->view->parts[i]; i++)
        if (strcmp(request->view->parts[i], name) == 0) {
            request->part = i;
            return PS_OK;
        }
    return report_unknown_part(name, request->view, error);
}

ps_result debug_find(const char *name, struct debug_request *request, struct error *error)
{
    size_t length = strcspn(name, ":");
    request->part = -1;
    for (size_t i = 0; i < VIEWS; i++) {
        request->view = views[i];
        if (strncmp(views[i]->name, name, length) != 0 || views[i]->name[length])
            continue;
        return name[length] ? find_part(name + length + 1, request, error) : PS_OK;
    }
    return report_unknown(name, error);
}

struct drawing {
    const struct debug_request *request;
    struct canvas *canvas;
};

static ps_result draw(void *user, struct render *render, struct error *error)
{
    const struct drawing *drawing = user;
    const struct debug_request *request = drawing->request;
    return request->view->draw(render, &request->options, request->part, drawing->canvas, error);
}

ps_result debug_draw(const struct debug_request *request, const struct scene *scene,
                     struct render_settings *settings, const struct render_callbacks *callbacks,
                     struct statistics *statistics, struct canvas *canvas, struct error *error)
{
    struct drawing drawing = {request, canvas};
    *canvas = (struct canvas){.rgb = NULL};
    ps_result result =
        render_inspect(scene, settings, callbacks, statistics, draw, &drawing, error);
    if (result != PS_OK)
        canvas_release(canvas);
    return result;
}
