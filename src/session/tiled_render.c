#include "session/tiled_render.h"

#include "image/exr_tiles.h"
#include <stdlib.h>

_Static_assert(TILE_STEP % EXR_TILE_SIDE == 0, "a tile holds whole tiles of OpenEXR files");

#define MARGIN 64 /* pixels that a denoiser looks at around a tile */

static size_t margin_of(const struct render_settings *settings)
{
    return settings->strategies[PS_DENOISER].type->table.denoiser.filter ? MARGIN : 0;
}

static struct rectangle around(struct rectangle tile, size_t margin, size_t width, size_t height)
{
    size_t left = tile.x > margin ? tile.x - margin : 0,
           top = tile.y > margin ? tile.y - margin : 0;
    size_t right = tile.x + tile.width + margin, bottom = tile.y + tile.height + margin;
    right = right < width ? right : width;
    bottom = bottom < height ? bottom : height;
    return (struct rectangle){left, top, right - left, bottom - top};
}

ps_result tiled_render_prepare(struct render_settings *settings, size_t width, size_t height,
                               struct error *error)
{
    size_t side = settings->tile, margin = margin_of(settings);
    size_t x = side < width ? side : 0, y = side < height ? side : 0;
    const struct rectangle inner = {x, y, width - x < side ? width - x : side,
                                    height - y < side ? height - y : side};
    settings->crop = around(inner, margin, width, height);
    return render_check_parts(settings, width, height, error);
}

struct tiling {
    const struct tiled_render *job;
    size_t across, down;
};

static struct rectangle tile_at(const struct tiling *tiling, uint32_t index)
{
    const struct scene *scene = tiling->job->scene;
    size_t side = tiling->job->settings->tile;
    size_t x = index % tiling->across * side, y = index / tiling->across * side;
    return (struct rectangle){x, y, scene->width - x < side ? scene->width - x : side,
                              scene->height - y < side ? scene->height - y : side};
}

/* See render_parts.take. */
static ps_result take_part(void *user, uint32_t part, struct image *image, struct error *error)
{
    const struct tiling *tiling = user;
    tiling->job->settings->crop = (struct rectangle){0}; /* the picture is all of it */
    return tiling->job->take(tiling->job->user, tile_at(tiling, part), image, error);
}

ps_result tiled_render_run(const struct tiled_render *job, struct error *error)
{
    size_t side = job->settings->tile, width = job->scene->width, height = job->scene->height;
    struct tiling tiling = {
        .job = job, .across = (width + side - 1) / side, .down = (height + side - 1) / side};
    uint32_t count = (uint32_t)(tiling.across * tiling.down);
    struct rectangle *places = malloc(count * sizeof *places);
    if (!places)
        return error_memory(error, count * sizeof *places, "tiles");
    for (uint32_t i = 0; i < count; i++)
        places[i] = around(tile_at(&tiling, i), margin_of(job->settings), width, height);
    const struct render_parts parts = {
        .places = places, .count = count, .take = take_part, .user = &tiling};
    ps_result result =
        render_run_parts(job->scene, job->settings, job->callbacks, job->statistics, &parts, error);
    free(places);
    return result;
}
