#include "pipeline/edges.h"

#include "base/sample.h"
#include "pipeline/pixel_filter.h"
#include "pipeline/view.h"
#include <psplat/host.h>
#include <psplat/tile.h>

/* Radiance and albedo differ where they do by more than this share of the larger one. */
#define CONTRAST 0.25f

/* Pixels up to so far to each side know of the indirect light at a sample. */
#define NEIGHBOURHOOD 2
#define NEIGHBOURHOOD_PIXELS ((2 * NEIGHBOURHOOD + 1) * (2 * NEIGHBOURHOOD + 1))

/* Neighbours that lie off each other's plane by more than this part of their distance (squared) are a
 * step; less may be a normal that is bent or smoothed. */
#define STEP2 0.25f

/* Seeds of scenes end before: random numbers of samples at edges are no pixel's. */
#define EDGE_SEED ((uint64_t)1 << 63)

/* --- finding them ------------------------------------------------------------------------------- */

/* A pixel of the G-buffer. */
struct place {
    const ps_tile *tile;
    uint32_t lane;
    ps_rgb direct, emitted;
};

/* False outside of the picture. */
static bool place_of(const struct gbuffer *gbuffer, int64_t x, int64_t y, struct place *place)
{
    uint32_t tile, lane;
    if (!gbuffer_find(gbuffer, x, y, &tile, &lane))
        return false;
    size_t pixel = (size_t)tile * PS_TILE_PIXELS + lane;
    *place = (struct place){&gbuffer->tiles[tile], lane, gbuffer->direct[pixel],
                            gbuffer->emitted[pixel]};
    return true;
}

static bool sees_surface(const struct place *place)
{
    return place->tile->object[place->lane] != PS_NO_OBJECT;
}

static bool same_object(const struct place *a, const struct place *b)
{
    return a->tile->object[a->lane] == b->tile->object[b->lane];
}

/* How far b lies off the plane of a, how far away (squared), and the cosine between both normals. */
struct offset {
    float off_plane, distance2, cosine;
};

static struct offset offset_of(const struct place *a, const struct place *b)
{
    ps_vec3 normal = ps_tile_normal(a->tile, a->lane);
    ps_vec3 way =
        ps_subtract(ps_tile_position(b->tile, b->lane), ps_tile_position(a->tile, a->lane));
    return (struct offset){ps_dot(normal, way), ps_dot(way, way),
                           ps_dot(normal, ps_tile_normal(b->tile, b->lane))};
}

static bool same_surface(const struct place *a, const struct place *b)
{
    struct offset offset = offset_of(a, b);
    return same_object(a, b) &&
           gbuffer_same_surface(offset.cosine, offset.off_plane, offset.distance2);
}

static bool surfaces_differ(const struct place *a, const struct place *b)
{
    struct offset offset = offset_of(a, b);
    return !same_object(a, b) || offset.cosine < 0.9f ||
           offset.off_plane * offset.off_plane > STEP2 * offset.distance2;
}

static ps_rgb albedo_of(const struct place *place)
{
    const ps_tile *tile = place->tile;
    uint32_t lane = place->lane;
    return (ps_rgb){tile->albedo_r[lane] * tile->throughput_r[lane],
                    tile->albedo_g[lane] * tile->throughput_g[lane],
                    tile->albedo_b[lane] * tile->throughput_b[lane]};
}

static ps_rgb radiance_of(const struct place *place)
{
    ps_rgb reflected = ps_rgb_multiply(albedo_of(place), place->direct);
    return ps_rgb_add(place->emitted, ps_rgb_scale(reflected, 1.0f / PS_PI));
}

static bool numbers_differ(float a, float b)
{
    return fabsf(a - b) > CONTRAST * fmaxf(a, b);
}

static bool colors_differ(ps_rgb a, ps_rgb b)
{
    return numbers_differ(a.r, b.r) || numbers_differ(a.g, b.g) || numbers_differ(a.b, b.b);
}

static bool places_differ(const struct place *a, const struct place *b)
{
    if (sees_surface(a) != sees_surface(b))
        return true;
    if (sees_surface(a) && surfaces_differ(a, b))
        return true;
    return colors_differ(albedo_of(a), albedo_of(b)) ||
           colors_differ(radiance_of(a), radiance_of(b));
}

static bool is_edge(const struct gbuffer *gbuffer, uint32_t tile, uint32_t lane)
{
    static const int steps[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    uint32_t x, y;
    struct place here, there;
    if (!gbuffer_pixel(gbuffer, tile, lane, &x, &y) || !place_of(gbuffer, x, y, &here))
        return false;
    if (gbuffer->by_chance[(size_t)tile * PS_TILE_PIXELS + lane])
        return true;
    for (int i = 0; i < 4; i++)
        if (place_of(gbuffer, (int64_t)x + steps[i][0], (int64_t)y + steps[i][1], &there) &&
            places_differ(&here, &there))
            return true;
    return false;
}

void edges_find(const struct gbuffer *gbuffer, uint32_t tile, bool edges[PS_TILE_PIXELS])
{
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        edges[lane] = is_edge(gbuffer, tile, lane);
}

/* --- looking again ------------------------------------------------------------------------------ */

/* Samples under way: one tile of a picture of its own. */
struct looks {
    _Alignas(64) ps_tile tile;
    ps_rgb direct[PS_TILE_PIXELS], emitted[PS_TILE_PIXELS];
    bool by_chance[PS_TILE_PIXELS];
    struct view_points points;
    uint32_t x[PS_TILE_PIXELS], y[PS_TILE_PIXELS]; /* their pixels */
    uint64_t light_numbers[PS_TILE_PIXELS];
};

/* Shadow rays of a sample: all samples together have no fewer than a pixel elsewhere. */
static uint32_t light_samples_of(const struct edge_pass *pass)
{
    return (pass->lighting->scene->light_samples + pass->samples - 1) / pass->samples;
}

static void add_look(const struct edge_pass *pass, uint32_t tile, uint32_t lane, uint32_t sample,
                     struct looks *looks)
{
    uint32_t to = (uint32_t)looks->points.count++;
    uint64_t block = ps_sample_block(tile, lane);
    uint64_t number = (uint64_t)pass->number * pass->samples + sample;
    float numbers[4], point[2];
    sample_point(sample_key(pass->seed | EDGE_SEED, PS_STREAM_PIXEL, 0), block + number, numbers);
    pixel_filter_point(pass->lighting->scene->pixel_filter, numbers, point);
    gbuffer_pixel(pass->gbuffer, tile, lane, &looks->x[to], &looks->y[to]);
    looks->points.lanes[to] = to;
    looks->points.x[to] = (float)looks->x[to] + point[0];
    looks->points.y[to] = (float)looks->y[to] + point[1];
    looks->points.indices[to] = block + number;
    looks->light_numbers[to] = block + number * light_samples_of(pass);
}

/* What pixels hold of indirect light. */
struct indirect {
    ps_rgb irradiance;
    float weight;
    float pixels;
};

static void add_indirect(const struct place *from, struct indirect *sum)
{
    const ps_tile *tile = from->tile;
    ps_rgb irradiance = {tile->irradiance_r[from->lane], tile->irradiance_g[from->lane],
                         tile->irradiance_b[from->lane]};
    sum->irradiance = ps_rgb_add(sum->irradiance, irradiance);
    sum->weight += tile->weight[from->lane];
    sum->pixels += 1.0f;
}

static const struct indirect *best_of(const struct indirect *same_surface,
                                      const struct indirect *same_object,
                                      const struct indirect *any)
{
    if (same_surface->pixels > 0.0f)
        return same_surface;
    return same_object->pixels > 0.0f ? same_object : any;
}

/* The pixels around one that see surfaces: its samples all look at the same ones. */
struct neighbours {
    size_t count;
    struct place places[NEIGHBOURHOOD_PIXELS];
};

static void find_neighbours(const struct gbuffer *gbuffer, uint32_t x, uint32_t y,
                            struct neighbours *neighbours)
{
    neighbours->count = 0;
    for (int dy = -NEIGHBOURHOOD; dy <= NEIGHBOURHOOD; dy++)
        for (int dx = -NEIGHBOURHOOD; dx <= NEIGHBOURHOOD; dx++) {
            struct place *there = &neighbours->places[neighbours->count];
            if (place_of(gbuffer, (int64_t)x + dx, (int64_t)y + dy, there))
                neighbours->count += sees_surface(there);
        }
}

/* Gives a sample the mean of the indirect light that the pixels around found on its surface. */
static void borrow_indirect(const struct neighbours *neighbours, ps_tile *tile, uint32_t lane)
{
    const struct place here = {.tile = tile, .lane = lane};
    struct indirect surface = {.pixels = 0.0f}, object = {.pixels = 0.0f}, any = {.pixels = 0.0f};
    for (size_t i = 0; i < neighbours->count; i++) {
        const struct place *there = &neighbours->places[i];
        add_indirect(there, &any);
        if (same_object(&here, there))
            add_indirect(there, &object);
        if (same_surface(&here, there))
            add_indirect(there, &surface);
    }
    const struct indirect *found = best_of(&surface, &object, &any);
    float scale = found->pixels > 0.0f ? 1.0f / found->pixels : 0.0f;
    tile->irradiance_r[lane] = scale * found->irradiance.r;
    tile->irradiance_g[lane] = scale * found->irradiance.g;
    tile->irradiance_b[lane] = scale * found->irradiance.b;
    tile->weight[lane] = scale * found->weight;
}

static bool same_pixel(const struct looks *looks, uint32_t i, uint32_t j)
{
    return looks->x[i] == looks->x[j] && looks->y[i] == looks->y[j];
}

/* Those of a pixel lie one after the other. */
static void add_looks(const struct edge_pass *pass, const struct gbuffer *samples,
                      struct looks *looks, struct film *film)
{
    struct neighbours neighbours;
    for (uint32_t i = 0; i < looks->points.count; i++) {
        if (i == 0 || !same_pixel(looks, i, i - 1))
            find_neighbours(pass->gbuffer, looks->x[i], looks->y[i], &neighbours);
        borrow_indirect(&neighbours, &looks->tile, i);
        film_add_sample(film, samples, 0, i, 1.0f / (float)pass->samples, looks->x[i], looks->y[i]);
    }
}

/* Traces the samples, adds them to their pixels and forgets them. */
static void finish_looks(const struct edge_pass *pass, struct looks *looks, struct film *film)
{
    const struct lighting *lighting = pass->lighting;
    struct gbuffer gbuffer = {
        .width = PS_TILE_SIZE,
        .height = PS_TILE_SIZE,
        .tiles_across = 1,
        .tiles_down = 1,
        .tile_count = 1,
        .tiles = &looks->tile,
        .direct = looks->direct,
        .emitted = looks->emitted,
        .by_chance = looks->by_chance,
    };
    struct view_pass view = {
        .scene = lighting->scene,
        .trace = lighting->trace,
        .maps = lighting->maps,
        .gbuffer = &gbuffer,
        .seed = pass->seed | EDGE_SEED,
    };
    view_trace(&view, &looks->points, 0);
    direct_light_tile(lighting, &gbuffer, 0, view.seed, looks->light_numbers,
                      light_samples_of(pass));
    add_looks(pass, &gbuffer, looks, film);
    looks->points.count = 0;
}

void edges_add_tile(const struct edge_pass *pass, uint32_t tile, struct film *film)
{
    bool *edges = &pass->edges[(size_t)tile * PS_TILE_PIXELS];
    struct looks looks;
    looks.points.count = 0;
    if (pass->number == 0)
        edges_find(pass->gbuffer, tile, edges);
    film_add_tile(film, pass->gbuffer, tile, edges);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        for (uint32_t sample = 0; sample < pass->samples && edges[lane]; sample++) {
            add_look(pass, tile, lane, sample, &looks);
            if (looks.points.count == PS_TILE_PIXELS)
                finish_looks(pass, &looks, film);
        }
    if (looks.points.count > 0)
        finish_looks(pass, &looks, film);
}
