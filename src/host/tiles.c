/* tiles.c: the services for the tiles of the picture: the G-buffer, and what estimators add to it. */
#include "host/host.h"

#include "base/parallel.h"
#include <psplat/math.h>

/* A part of the tiles; their number is shifted by the first of the part. */
struct tile_part {
    const struct render *render;
    uint64_t first;
    ps_body body;
    void *user;
};

static void visit_tile(void *user, uint64_t index, uint32_t worker)
{
    const struct tile_part *part = user;
    if (!host_is_cancelled(part->render))
        part->body(part->user, part->first + index, worker);
}

static ps_result host_for_each_tile(const ps_host *host, ps_body body, void *user)
{
    const struct render *render = render_of(host);
    if (!host_in_place(host, render->estimating, "for_each_tile"))
        return PS_ERROR_INVALID;
    uint64_t count = render->gbuffer.tile_count;
    /* Parts of some tiles a thread: often enough to report, rarely enough to keep threads busy. */
    uint64_t step = 16 * (uint64_t)workers_count(render->settings->workers);
    for (uint64_t first = 0; first < count; first += step) {
        struct tile_part part = {render, first, body, user};
        uint64_t n = count - first < step ? count - first : step;
        if (!host_loop(host, "for_each_tile", n, visit_tile, &part))
            return PS_ERROR_INVALID;
        if (host_is_cancelled(render))
            return PS_CANCELLED;
        uint64_t done = first + step < count ? first + step : count;
        host_tell_progress(host, (double)done / (double)count);
    }
    return PS_OK;
}

/* Whether the tile is there. */
static bool has_tile(const ps_host *host, uint32_t index, const char *service)
{
    const struct render *render = render_of(host);
    if (!host_in_place(host, render->has_tiles, service))
        return false;
    if (index < render->gbuffer.tile_count)
        return true;
    host_refuse_index(host, service, index, render->gbuffer.tile_count);
    return false;
}

/* One that is not there is all empty, and what is written to it is lost. */
static ps_tile *host_tile(const ps_host *host, uint32_t index)
{
    struct render *render = render_of(host);
    return has_tile(host, index, "tile") ? &render->gbuffer.tiles[index] : &render->nowhere;
}

static int32_t host_pixel(const ps_host *host, uint32_t tile, uint32_t lane, uint32_t *x,
                          uint32_t *y)
{
    *x = *y = 0;
    return has_tile(host, tile, "pixel") && lane < PS_TILE_PIXELS &&
           gbuffer_pixel(&render_of(host)->gbuffer, tile, lane, x, y);
}

static int32_t host_tile_of(const ps_host *host, uint32_t x, uint32_t y, uint32_t *tile,
                            uint32_t *lane)
{
    const struct render *render = render_of(host);
    const struct gbuffer *gbuffer = &render->gbuffer;
    *tile = *lane = 0;
    if (!host_in_place(host, render->has_tiles, "tile_of") || x >= gbuffer->width ||
        y >= gbuffer->height)
        return 0;
    *tile = gbuffer_tile_of(gbuffer, x, y, lane);
    return 1;
}

static void host_tile_hits(const ps_host *host, uint32_t index, ps_ray *rays, ps_hit *hits)
{
    const struct render *render = render_of(host);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        hits[lane] = (ps_hit){.distance = INFINITY, .object = PS_NO_OBJECT};
    if (!host_in_place(host, render->estimating, "tile_hits") ||
        !has_tile(host, index, "tile_hits"))
        return;
    struct view_pass pass = {
        .scene = render->scene,
        .trace = render->trace,
        .seed = render->settings->seed,
        .rays = rays,
        .hits = hits,
    };
    struct view_points points;
    view_pixels(&render->gbuffer, index, render->pass.number, render->jitter[0], render->jitter[1],
                &points);
    view_trace(&pass, &points, index);
}

void host_add_tiles(ps_host *host)
{
    host->for_each_tile = host_for_each_tile;
    host->tile = host_tile;
    host->pixel = host_pixel;
    host->tile_of = host_tile_of;
    host->tile_hits = host_tile_hits;
}
