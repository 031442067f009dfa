/* picture.c: psplat_picture: layers to read and to write. */
#include "api/environment.h"
#include "api/handles.h"
#include "api/report.h"
#include "session/output.h"

#include <stdlib.h>

void psplat_picture_destroy(psplat_picture *picture)
{
    if (!picture)
        return;
    image_release(&picture->image);
    output_options_release(&picture->output);
    free(picture);
}

size_t psplat_picture_width(const psplat_picture *picture)
{
    return picture->image.width;
}

size_t psplat_picture_height(const psplat_picture *picture)
{
    return picture->image.height;
}

size_t psplat_picture_channel_count(const psplat_picture *picture)
{
    return picture->image.channel_count;
}

const char *psplat_picture_channel_name(const psplat_picture *picture, size_t index)
{
    return index < picture->image.channel_count ? picture->image.channels[index].name : NULL;
}

const float *psplat_picture_channel(const psplat_picture *picture, const char *name)
{
    return image_channel(&picture->image, name);
}

const char *psplat_picture_attribute(const psplat_picture *picture, const char *name)
{
    return image_attribute(&picture->image, name);
}

ps_result psplat_picture_write(const psplat_picture *picture, const char *path, psplat_error *error)
{
    struct workers *workers = NULL;
    struct error reason;
    fenv_t caller;
    ps_result result = PS_OK;
    environment_enter(&caller);
    if (!output_is_writable_format(path))
        result = error_set(&reason, PS_ERROR_INVALID, "'%.1000s' ends neither in .exr nor in .png",
                           path);
    if (result == PS_OK)
        result = workers_create(picture->threads, &workers, &reason);
    if (result == PS_OK)
        result = output_write(&picture->image, path, &picture->output, workers, &reason);
    workers_destroy(workers);
    environment_leave(&caller);
    return result == PS_OK ? PS_OK : report_error(error, result, &reason);
}
