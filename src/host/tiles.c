/* tiles.c: the services for the tiles of the picture: the G-buffer, and what estimators add to it.
 *
 * Plugins know tiles by their numbers in the picture, of which a part may be there
 * (film/gbuffer.h).
 */
#include "host/host.h"

#include "base/parallel.h"
#include <psplat/math.h>
#include <string.h>

/* A part of the tiles; their index is shifted by the first of the part. */
struct tile_part {
    const struct render *render;
    bool by_number; /* of the picture, not those that are there alone */
    uint64_t first;
    ps_body body;
    void *user;
};

static void visit_tile(void *user, uint64_t index, uint32_t worker)
{
    const struct tile_part *part = user;
    uint32_t tile = (uint32_t)(part->first + index);
    if (!host_is_cancelled(part->render))
        part->body(part->user,
                   part->by_number ? tile : gbuffer_number(&part->render->gbuffer, tile), worker);
}

static ps_result visit_tiles(const ps_host *host, const char *service, bool by_number, ps_body body,
                             void *user)
{
    const struct render *render = render_of(host);
    if (!host_in_place(host, render->estimating, service))
        return PS_ERROR_INVALID;
    const struct gbuffer *gbuffer = &render->gbuffer;
    uint64_t count = by_number ? gbuffer_picture_tiles(gbuffer) : gbuffer->tile_count;
    /* Parts of some tiles a thread: often enough to report, rarely enough to keep threads busy. */
    uint64_t step = 16 * (uint64_t)workers_count(render->settings->workers);
    for (uint64_t first = 0; first < count; first += step) {
        struct tile_part part = {render, by_number, first, body, user};
        uint64_t n = count - first < step ? count - first : step;
        if (!host_loop(host, service, n, visit_tile, &part))
            return PS_ERROR_INVALID;
        if (host_is_cancelled(render))
            return PS_CANCELLED;
        uint64_t done = first + step < count ? first + step : count;
        host_tell_progress(host, (double)done / (double)count);
    }
    return PS_OK;
}

static ps_result host_for_each_tile(const ps_host *host, ps_body body, void *user)
{
    return visit_tiles(host, "for_each_tile", false, body, user);
}

static ps_result host_for_each_picture_tile(const ps_host *host, ps_body body, void *user)
{
    return visit_tiles(host, "for_each_picture_tile", true, body, user);
}

/* Whether the picture has the tile. */
static bool has_tile(const ps_host *host, uint32_t index, const char *service)
{
    const struct render *render = render_of(host);
    if (!host_in_place(host, render->has_tiles, service))
        return false;
    uint32_t count = gbuffer_picture_tiles(&render->gbuffer);
    if (index < count)
        return true;
    host_refuse_index(host, service, index, count);
    return false;
}

/* Those that are not there are all one, which is empty; workers share it. */
static ps_tile *host_tile(const ps_host *host, uint32_t index)
{
    struct render *render = render_of(host);
    uint32_t tile;
    return has_tile(host, index, "tile") && gbuffer_tile_numbered(&render->gbuffer, index, &tile)
               ? &render->gbuffer.tiles[tile]
               : &render->nowhere;
}

static int32_t host_pixel(const ps_host *host, uint32_t tile, uint32_t lane, uint32_t *x,
                          uint32_t *y)
{
    *x = *y = 0;
    return has_tile(host, tile, "pixel") && lane < PS_TILE_PIXELS &&
           gbuffer_picture_pixel(&render_of(host)->gbuffer, tile, lane, x, y);
}

static int32_t host_tile_of(const ps_host *host, uint32_t x, uint32_t y, uint32_t *tile,
                            uint32_t *lane)
{
    const struct render *render = render_of(host);
    const struct gbuffer *gbuffer = &render->gbuffer;
    *tile = *lane = 0;
    if (!host_in_place(host, render->has_tiles, "tile_of") ||
        !gbuffer_find(gbuffer, x, y, tile, lane))
        return 0;
    *tile = gbuffer_number(gbuffer, *tile);
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
        .lighting = {.scene = render->scene, .trace = render->trace},
        .seed = render->settings->seed,
        .rays = rays,
        .hits = hits,
    };
    struct view_points points;
    view_pixels(&render->gbuffer, index, render->pass.number, render->jitter[0], render->jitter[1],
                &points);
    view_trace(&pass, &points, index);
}

/* As the pass traces the tiles that are there. */
static void trace_surfaces(const struct render *render, uint32_t index, ps_tile *tile)
{
    ps_rgb emitted[PS_TILE_PIXELS];
    uint8_t choice[PS_TILE_PIXELS];
    struct gbuffer alone = gbuffer_layout(PS_TILE_SIZE, PS_TILE_SIZE);
    alone.tiles = tile;
    alone.emitted = emitted;
    alone.choice = choice;
    struct view_pass pass = {
        .lighting = {.scene = render->scene, .trace = render->trace},
        .gbuffer = &alone,
        .seed = render->settings->seed,
        .without_light = true,
    };
    struct view_points points;
    view_pixels(&render->gbuffer, index, render->pass.number, render->jitter[0], render->jitter[1],
                &points);
    view_trace(&pass, &points, 0);
}

static void find_surfaces(const ps_host *host, uint32_t index, ps_tile *tile)
{
    const struct render *render = render_of(host);
    uint32_t there;
    if (!host_in_place(host, render->estimating, "tile_surfaces") ||
        !has_tile(host, index, "tile_surfaces")) {
        *tile = render->nowhere;
    } else if (gbuffer_tile_numbered(&render->gbuffer, index, &there)) {
        *tile = render->gbuffer.tiles[there];
    } else {
        trace_surfaces(render, index, tile);
        return;
    }
    tile->radiance_r = tile->radiance_g = tile->radiance_b = NULL;
    memset(tile->irradiance_r, 0, sizeof tile->irradiance_r);
    memset(tile->irradiance_g, 0, sizeof tile->irradiance_g);
    memset(tile->irradiance_b, 0, sizeof tile->irradiance_b);
    memset(tile->weight, 0, sizeof tile->weight);
    memset(tile->variance, 0, sizeof tile->variance);
}

/* The caller's tile may be that of an older interface, which is shorter. */
static void host_tile_surfaces(const ps_host *host, uint32_t index, size_t size, ps_tile *tile)
{
    ps_tile found;
    find_surfaces(host, index, &found);
    memcpy(tile, &found, size < sizeof found ? size : sizeof found);
}

void host_add_tiles(ps_host *host)
{
    host->for_each_tile = host_for_each_tile;
    host->tile = host_tile;
    host->pixel = host_pixel;
    host->tile_of = host_tile_of;
    host->tile_hits = host_tile_hits;
    host->for_each_picture_tile = host_for_each_picture_tile;
    host->tile_surfaces = host_tile_surfaces;
}
