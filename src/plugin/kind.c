#include "plugin/kind.h"

#include <string.h>

const struct kind kinds[PS_KINDS] = {
    [PS_INJECTION] = {"injection", "makes the indirect light sources", "photon"},
    [PS_STRATIFICATION] = {"stratification", "combines neighbouring photons into fewer", "none"},
    [PS_VISIBILITY] = {"visibility", "decides what a bundled light ray lights", "shadowmap"},
    [PS_FILTER] = {"filter", "radial weight of a splat", "gaussian"},
    [PS_ESTIMATOR] = {"estimator", "turns photons into light on the picture", "splat"},
    [PS_NORMALIZATION] = {"normalization", "turns accumulated light into radiance", "density"},
    [PS_DENOISER] = {"denoiser", "smooths the indirect light", "none"},
};

ps_kind kind_parse(const char *text, const char **rest)
{
    size_t length = strcspn(text, "=");
    int kind = 0;
    while (kind < PS_KINDS &&
           (strlen(kinds[kind].name) != length || strncmp(kinds[kind].name, text, length) != 0))
        kind++;
    *rest = text[length] ? text + length + 1 : NULL;
    return (ps_kind)kind;
}
