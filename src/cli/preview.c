#include "cli/preview.h"

#include <math.h>
#include <stdlib.h>

#define WIDTH 640.0
#define HEIGHT 360.0

static const struct option passes = {.name = "passes"}, set = {.name = "set"},
                           plugin = {.name = "plugin"};

static const struct argument stands_for[] = {
    {&passes, "1"},
    {&set, "render.light_samples=2"},
    {&set, "render.discontinuity_buffer=yes"},
    {&set, "render.aa_samples=1"},
    {&plugin, "injection=photon:count=10000"},
    {&plugin, "stratification=none"},
    {&plugin, "visibility=shadowmap:radius=auto,resolution=4"},
    {&plugin, "estimator=splat:interleave=4,gather_rays=0"},
    {&plugin, "denoiser=none"},
};

#define STANDS_FOR (sizeof stands_for / sizeof stands_for[0])

static bool is_among(const struct argument *arguments, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (argument_is(&arguments[i], "preview"))
            return true;
    return false;
}

struct argument *preview_expand(const struct argument *arguments, size_t count,
                                size_t *expanded_count)
{
    struct argument *expanded = calloc(count + STANDS_FOR, sizeof *expanded);
    if (!expanded) {
        print_error("out of memory");
        return NULL;
    }
    size_t added = is_among(arguments, count) ? STANDS_FOR : 0;
    for (size_t i = 0; i < added; i++)
        expanded[i] = stands_for[i];
    for (size_t i = 0; i < count; i++)
        expanded[added + i] = arguments[i];
    *expanded_count = added + count;
    return expanded;
}

void preview_shrink(struct image_description *image)
{
    double scale = fmin(WIDTH / (double)image->width, HEIGHT / (double)image->height);
    if (scale >= 1.0)
        return;
    image->width = (int64_t)fmax(1.0, round((double)image->width * scale));
    image->height = (int64_t)fmax(1.0, round((double)image->height * scale));
}
