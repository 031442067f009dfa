#include "view/edges.h"

#include "base/sample.h"
#include "view/edge_interpolation.h"
#include "view/pixel_filter.h"
#include "view/view.h"
#include <assert.h>
#include <psplat/host.h>
#include <psplat/tile.h>
#include <string.h>

/* A bit that no scene's seed has: samples at edges draw other random numbers than pixels. */
#define EDGE_SEED ((uint64_t)1 << 63)

/* Samples that are being traced, as one tile of a G-buffer of their own. */
struct edge_samples {
    _Alignas(64) ps_tile tile;
    ps_rgb direct[PS_TILE_PIXELS], direct_half[PS_TILE_PIXELS], emitted[PS_TILE_PIXELS];
    ps_rgb hard[PS_TILE_PIXELS], hard_half[PS_TILE_PIXELS];
    uint8_t choice[PS_TILE_PIXELS]; /* enum path_choice */
    struct glossy_tile glossy;
    float radiance[3 * PS_TILE_PIXELS], splatted[3 * PS_TILE_PIXELS];
    struct view_points points;
    uint32_t x[PS_TILE_PIXELS], y[PS_TILE_PIXELS]; /* their pixels */
    struct light_runs light_runs;
    float pattern[GLASS_SAMPLES * MOST_AA_SAMPLES][2]; /* where in each pixel they lie */
};

static void draw_pattern(const struct edge_pass *pass, struct edge_samples *batch)
{
    uint32_t key = sample_key(pass->seed | EDGE_SEED, PS_STREAM_PIXEL, 0);
    uint32_t samples = batch->points.samples_of_pixel;
    for (uint32_t sample = 0; sample < samples; sample++) {
        float numbers[4];
        sample_point(key, (uint64_t)pass->number * samples + sample, numbers);
        pixel_filter_point(pass->lighting->scene->pixel_filter, numbers, batch->pattern[sample]);
    }
}

/* Shadow rays of a sample: all samples together have no fewer than a pixel elsewhere; two make
 * halves. */
static uint32_t light_samples_of(const struct edge_pass *pass, const struct edge_samples *batch)
{
    uint32_t samples = batch->points.samples_of_pixel;
    uint32_t wanted = (pass->lighting->scene->light_samples + samples - 1) / samples;
    uint32_t least = pass->gbuffer->direct_half ? 2 : 1;
    return wanted > least ? wanted : least;
}

static void add_sample(const struct edge_pass *pass, uint32_t tile, uint32_t lane, uint32_t sample,
                       struct edge_samples *batch)
{
    uint32_t to = (uint32_t)batch->points.count++;
    uint64_t block = ps_sample_block(gbuffer_number(pass->gbuffer, tile), lane);
    uint64_t number = (uint64_t)pass->number * batch->points.samples_of_pixel + sample;
    gbuffer_pixel(pass->gbuffer, tile, lane, &batch->x[to], &batch->y[to]);
    batch->points.lanes[to] = to;
    batch->points.x[to] = (float)batch->x[to] + batch->pattern[sample][0];
    batch->points.y[to] = (float)batch->y[to] + batch->pattern[sample][1];
    batch->points.indices[to] = block + number;
    batch->light_runs.first[to] = block + number * light_samples_of(pass, batch);
    batch->light_runs.of_lane[to] = (uint8_t)to;
}

static bool same_pixel(const struct edge_samples *batch, uint32_t i, uint32_t j)
{
    return batch->x[i] == batch->x[j] && batch->y[i] == batch->y[j];
}

/* Samples of one pixel are consecutive. */
static void add_to_film(const struct edge_pass *pass, const struct gbuffer *samples,
                        struct edge_samples *batch, struct film *film)
{
    uint32_t count = (uint32_t)batch->points.count;
    float share = 1.0f / (float)batch->points.samples_of_pixel;
    for (uint32_t first = 0, end; first < count; first = end) {
        struct edge_neighbours neighbours;
        edge_neighbours_find(pass->gbuffer, batch->x[first], batch->y[first], &neighbours);
        for (end = first; end < count && same_pixel(batch, first, end); end++)
            edge_interpolate(pass->gbuffer, &neighbours, batch->x[end], batch->y[end],
                             batch->choice[end], samples, end);
        if (film_has_pixel(film, batch->x[first], batch->y[first]))
            film_add_samples(film, samples, first, end - first, share, batch->x[first],
                             batch->y[first]);
    }
}

/* Traces the samples, adds them to their pixels and forgets them. */
static void flush(const struct edge_pass *pass, struct edge_samples *batch, struct film *film)
{
    const struct lighting *lighting = pass->lighting;
    struct gbuffer gbuffer = {
        .width = PS_TILE_SIZE,
        .height = PS_TILE_SIZE,
        .picture_across = 1,
        .tiles_across = 1,
        .tiles_down = 1,
        .tile_count = 1,
        .tiles = &batch->tile,
        .direct = batch->direct,
        .direct_half = pass->gbuffer->direct_half ? batch->direct_half : NULL,
        .hard = pass->gbuffer->hard ? batch->hard : NULL,
        .hard_half = pass->gbuffer->hard_half ? batch->hard_half : NULL,
        .emitted = batch->emitted,
        .choice = batch->choice,
        .glossy = pass->gbuffer->glossy ? &batch->glossy : NULL,
        .radiance = pass->gbuffer->radiance ? batch->radiance : NULL,
        .splatted = pass->gbuffer->splatted ? batch->splatted : NULL,
    };
    struct view_pass view = {
        .lighting = *lighting,
        .gbuffer = &gbuffer,
        .seed = pass->seed | EDGE_SEED,
    };
    view_trace(&view, &batch->points, 0);
    batch->light_runs.count = batch->points.count;
    direct_light_tile(lighting, &gbuffer, 0, view.seed, &batch->light_runs,
                      light_samples_of(pass, batch));
    add_to_film(pass, &gbuffer, batch, film);
    batch->points.count = 0;
}

/* The pixels of one kind, each by so many samples. */
static void sample_edges(const struct edge_pass *pass, uint32_t tile, enum edge_kind kind,
                         uint32_t samples, struct film *film)
{
    const uint8_t *edges = &pass->edges[(size_t)tile * PS_TILE_PIXELS];
    struct edge_samples batch;
    if (!memchr(edges, (int)kind, PS_TILE_PIXELS))
        return;
    batch.points.samples_of_pixel = samples;
    batch.points.count = 0;
    draw_pattern(pass, &batch);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        if (edges[lane] != kind)
            continue;
        if (batch.points.count > 0 && batch.points.count + samples > PS_TILE_PIXELS)
            flush(pass, &batch, film);
        for (uint32_t sample = 0; sample < samples; sample++) {
            add_sample(pass, tile, lane, sample, &batch);
            if (batch.points.count == PS_TILE_PIXELS)
                flush(pass, &batch, film);
        }
    }
    if (batch.points.count > 0)
        flush(pass, &batch, film);
}

void edges_add_tile(const struct edge_pass *pass, uint32_t tile, struct film *film)
{
    assert(tile < pass->gbuffer->tile_count);
    if (!film_has_tile(film, pass->gbuffer, tile))
        return;
    sample_edges(pass, tile, EDGE, pass->samples, film);
    sample_edges(pass, tile, GLASS_EDGE, GLASS_SAMPLES * pass->samples, film);
}
