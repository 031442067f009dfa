#include "session/layers.h"

#include "pipeline/render.h"
#include <string.h>

/* The part of a list up to its next comma, past which `list` moves; 0 at the end. */
static size_t next_name(const char **list, const char **name)
{
    *name = *list;
    size_t length = strcspn(*list, ",");
    *list += length + ((*list)[length] == ',');
    return length;
}

ps_result layers_check(const char *list, struct error *error)
{
    const char *rest = list, *name;
    if (strcmp(list, "none") == 0)
        return PS_OK;
    do {
        size_t length = next_name(&rest, &name);
        bool is_all = length == 3 && strncmp(name, "all", length) == 0;
        if (!is_all && !render_makes_layer(name, length))
            return error_set(error, PS_ERROR_INVALID,
                             "--layers: expected none, or all and names among " RENDER_LAYERS
                             " with commas between them, got '%.500s'",
                             list);
    } while (*rest || rest[-1] == ',');
    return PS_OK;
}

static bool is_named(const char *list, const char *layer, size_t length)
{
    const char *name;
    while (*list) {
        size_t name_length = next_name(&list, &name);
        if (name_length == length && strncmp(name, layer, length) == 0)
            return true;
    }
    return false;
}

bool layers_contain(const char *list, const char *layer)
{
    return is_named(list, layer, strlen(layer));
}

bool layers_any(const char *list)
{
    return strcmp(list, "none") != 0;
}

bool layers_have_error(const char *list)
{
    return layers_contain(list, "all") || layers_contain(list, "error");
}

ps_result layers_check_denoiser(const char *list, const struct render_settings *settings,
                                struct error *error)
{
    const struct strategy_type *denoiser = settings->strategies[PS_DENOISER].type;
    if (!layers_contain(list, "error") || denoiser->table.denoiser.flags & PS_DENOISER_ERROR)
        return PS_OK;
    return error_set(error, PS_ERROR_INVALID,
                     "--layers: denoiser '%.100s' does not estimate its error; denoiser=regression "
                     "does",
                     denoiser->name);
}

/* Of channel "N.X" the layer is N. */
bool layers_keep(const char *list, const char *channel)
{
    size_t length = strcspn(channel, ".");
    bool is_display = strncmp(channel, "display.", length + 1) == 0;
    return !render_makes_layer(channel, length) || is_named(list, channel, length) ||
           (layers_contain(list, "all") && !is_display);
}
