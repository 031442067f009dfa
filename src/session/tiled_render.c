#include "session/tiled_render.h"

#include "base/clock.h"
#include "image/exr_tiles.h"
#include "session/tiled_output.h"
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

/* --- the render ------------------------------------------------------------------------------------ */

struct tiling {
    const struct tiled_render *job;
    size_t across, down;
    struct tiled_output *output; /* NULL: no tile is done */
    bool cannot_write;
};

static struct rectangle tile_at(const struct tiling *tiling, uint32_t index)
{
    const struct scene *scene = tiling->job->scene;
    size_t side = tiling->job->settings->tile;
    size_t x = index % tiling->across * side, y = index / tiling->across * side;
    return (struct rectangle){x, y, scene->width - x < side ? scene->width - x : side,
                              scene->height - y < side ? scene->height - y : side};
}

/* The picture's attributes are those of all of it. */
static ps_result begin_files(struct tiling *tiling, struct image *first, struct error *error)
{
    const struct tiled_render *job = tiling->job;
    struct rectangle part = job->settings->crop;
    job->settings->crop = (struct rectangle){0};
    ps_result result = output_describe(first, job->scene_path, job->scene_options, job->settings,
                                       settings_pass_count(job->settings), true, error);
    job->settings->crop = part;
    if (result != PS_OK)
        return result;
    return tiled_output_create(job->paths, job->path_count, job->output, first, job->scene->width,
                               job->scene->height, job->settings->tile, job->settings->workers,
                               &tiling->output, error);
}

/* See render_parts.take. */
static ps_result take_tile(void *user, uint32_t part, struct image *image, struct error *error)
{
    struct tiling *tiling = user;
    double start = clock_seconds();
    ps_result result = tiling->output ? PS_OK : begin_files(tiling, image, error);
    if (result == PS_OK)
        result = tiled_output_add(tiling->output, image, tile_at(tiling, part), error);
    tiling->cannot_write = result != PS_OK;
    statistics_add_seconds(tiling->job->statistics, "write", clock_seconds() - start);
    return result;
}

static ps_result finish(struct tiling *tiling, ps_result result, struct error *error)
{
    struct error reason;
    if (!tiling->output || tiling->cannot_write) {
        tiled_output_discard(tiling->output);
        return result;
    }
    ps_result finished = tiled_output_finish(tiling->output, &reason);
    if (finished == PS_OK || (result != PS_OK && result != PS_CANCELLED))
        return result;
    *error = reason;
    return finished;
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
        .places = places, .count = count, .take = take_tile, .user = &tiling};
    ps_result result =
        render_run_parts(job->scene, job->settings, job->callbacks, job->statistics, &parts, error);
    free(places);
    return finish(&tiling, result, error);
}
