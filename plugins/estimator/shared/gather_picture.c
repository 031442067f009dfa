#include "gather_picture.h"

#include "allocation.h"
#include "sampled_tiles.h"
#include <string.h>

#define MOST_PILOTS 8192 /* tiles by which the picture's need is told */

struct work {
    const struct gather_setting *setting;
    /* When tiles take samples by their need: what the first round found in each tile that is there, in those around these, and in
     * those that stand for the picture. It is kept for the former two, `places` being their places. */
    const struct gather_shares *shares; /* NULL: they do not */
    struct gather_first *first_rounds;
    struct tile_pilot
        *pilots; /* of the picture's tiles; of those that were not looked at, without points */
    uint32_t *places;
};

#define NO_PLACE UINT32_MAX
#define IS_THERE 0u /* before places are numbered */
#define IS_WANTED 1u

static bool begin_tile(const struct work *work, uint64_t index, const ps_tile *tile,
                       struct gather *gather)
{
    *gather = (struct gather){.setting = work->setting, .index = index};
    ps_collect_points(tile, &gather->points);
    if (gather->points.count > 0)
        gather_begin(gather);
    return gather->points.count > 0;
}

enum half { FIRST_HALF, SECOND_HALF, BOTH_HALVES };

/* What the first round found at those points, in the brightness that a pixel has of it. */
static struct tile_pilot pilot_of(const struct gather *gather, const ps_tile *tile, enum half which)
{
    uint32_t lanes[PS_TILE_PIXELS];
    float found[PS_TILE_PIXELS], half[PS_TILE_PIXELS];
    size_t count = 0;
    for (size_t i = 0; i < gather->points.count; i++) {
        float light = 0.0f, of_half = 0.0f;
        if (which != BOTH_HALVES && gather_half_of(gather, i) != (int)which)
            continue;
        for (int number = 0; number < GATHER_FIRST; number++) {
            if (number == GATHER_FIRST / 2)
                of_half = light;
            light += ps_luminance(gather->first.found[number][i]);
        }
        uint32_t lane = gather->points.lanes[i];
        float scale = ps_luminance(ps_tile_reflectance(tile, lane)) / (float)GATHER_FIRST;
        found[count] = scale * light;
        half[count] = 2.0f * scale * of_half;
        lanes[count++] = lane;
    }
    return tile_pilot(lanes, found, half, count);
}

static float sum_of_shares(const struct gather *gather)
{
    float sum = 0.0f;
    for (size_t i = 0; i < gather->points.count; i++)
        sum += gather->first.shares[i];
    return sum;
}

static bool stands_for_picture(const struct work *work, uint64_t tile)
{
    return tile_is_sampled((uint32_t)tile, work->setting->paths.pass->tile_count, MOST_PILOTS);
}

static void take_first_round(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    uint32_t place = work->places[index];
    if (place == NO_PLACE && (work->shares->are_known || !stands_for_picture(work, index)))
        return;
    const ps_host *host = work->setting->paths.host;
    ps_tile tile;
    struct gather gather;
    host->tile_surfaces(host, (uint32_t)index, sizeof tile, &tile);
    if (place != NO_PLACE)
        work->first_rounds[place].guide_count = 0; /* also of a tile that sees nothing */
    if (!begin_tile(work, index, &tile, &gather))
        return;
    gather_samples(&gather, GATHER_FIRST);
    point_shares(&gather.points, gather.first.shares);
    work->pilots[index] = pilot_of(&gather, &tile, BOTH_HALVES);
    work->pilots[index].shares = sum_of_shares(&gather);
    if (place == NO_PLACE)
        return;
    gather_teach(&gather);
    work->first_rounds[place] = gather.first;
}

/* The tiles of the picture next to one, up to eight. */
static size_t tiles_around(const ps_pass *pass, uint64_t tile, uint32_t around[8])
{
    int64_t across = (pass->width + PS_TILE_SIZE - 1) / PS_TILE_SIZE;
    int64_t down = pass->tile_count / across, x = (int64_t)tile % across,
            y = (int64_t)tile / across;
    size_t count = 0;
    for (int64_t row = y - 1; row <= y + 1; row++)
        for (int64_t column = x - 1; column <= x + 1; column++)
            if (row >= 0 && row < down && column >= 0 && column < across &&
                (row != y || column != x))
                around[count++] = (uint32_t)(row * across + column);
    return count;
}

static void resume(const struct work *work, uint64_t index, struct gather *gather)
{
    uint32_t tiles[8];
    const struct gather_first *around[8];
    size_t count = tiles_around(work->setting->paths.pass, index, tiles);
    for (size_t i = 0; i < count; i++)
        around[i] = &work->first_rounds[work->places[tiles[i]]];
    gather_resume(gather, &work->first_rounds[work->places[index]], around, count);
}

static void gather_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    const ps_host *host = work->setting->paths.host;
    ps_tile *tile = host->tile(host, (uint32_t)index);
    uint64_t samples = work->shares
                           ? allocated_samples(&work->shares->allocation, &work->pilots[index])
                           : work->setting->samples;
    struct gather gather;
    if (!begin_tile(work, index, tile, &gather))
        return;
    if (work->shares) {
        const struct allocation *allocation = &work->shares->allocation;
        resume(work, index, &gather);
        struct tile_pilot first = pilot_of(&gather, tile, FIRST_HALF);
        struct tile_pilot second = pilot_of(&gather, tile, SECOND_HALF);
        gather.expected[0] = allocated_samples(allocation, &second);
        gather.expected[1] = allocated_samples(allocation, &first);
    }
    gather_samples(&gather, samples);
    for (size_t i = 0; i < gather.points.count; i++)
        ps_add_irradiance(tile, gather.points.lanes[i], gather.irradiance[i]);
}

static void mark_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    work->places[index] = IS_THERE;
}

/* Gives a place to each tile that is there (IS_THERE) and to those around it. Returns how many. */
static uint32_t number_places(const struct work *work)
{
    const ps_pass *pass = work->setting->paths.pass;
    uint32_t count = 0, tiles[8];
    for (uint32_t tile = 0; tile < pass->tile_count; tile++) {
        size_t around = work->places[tile] == IS_THERE ? tiles_around(pass, tile, tiles) : 0;
        for (size_t i = 0; i < around; i++)
            if (work->places[tiles[i]] == NO_PLACE)
                work->places[tiles[i]] = IS_WANTED;
    }
    for (uint32_t tile = 0; tile < pass->tile_count; tile++)
        if (work->places[tile] != NO_PLACE)
            work->places[tile] = count++;
    return count;
}

/* Finds the tiles that are there, and makes room for what the first round finds in them and around. */
static ps_result make_places(struct work *work)
{
    const ps_host *host = work->setting->paths.host;
    size_t tiles = work->setting->paths.pass->tile_count;
    double before = work->setting->share_before;
    host->progress_part(host, before, before);
    work->places = host->allocate(host, tiles * sizeof *work->places, "first round");
    if (!work->places)
        return PS_ERROR_MEMORY;
    for (size_t i = 0; i < tiles; i++)
        work->places[i] = NO_PLACE;
    ps_result result = host->for_each_tile(host, mark_tile, work);
    size_t bytes = number_places(work) * sizeof *work->first_rounds;
    work->first_rounds = host->allocate(host, bytes, "first round");
    return work->first_rounds || result != PS_OK ? result : PS_ERROR_MEMORY;
}

/* By the tiles that stand for the picture, which `pilots` then begins with. */
static struct allocation allocation_of(const struct work *work, struct tile_pilot *pilots)
{
    size_t tiles = work->setting->paths.pass->tile_count, count = 0;
    const struct gather_setting *setting = work->setting;
    /* The first round may have missed all that there is to be found in a tile, and has much more noise than guided rays:
     * half of those are taken everywhere. */
    const struct allocation_limits limits = {
        .first = GATHER_FIRST,
        .samples = setting->samples,
        .least = GATHER_FIRST + (setting->samples - GATHER_FIRST + 1) / 2,
        .most = setting->most,
    };
    for (size_t i = 0; i < tiles; i++)
        if (stands_for_picture(work, i))
            pilots[count++] = work->pilots[i];
    return allocation_for(&limits, pilots, count);
}

/* Takes the first round of tiles, and finds the shares, where they are not known, by those that stand for the picture. */
static ps_result find_shares(struct work *work, struct gather_shares *shares)
{
    const ps_host *host = work->setting->paths.host;
    size_t bytes = work->setting->paths.pass->tile_count * sizeof *work->pilots;
    ps_result result = host->for_each_picture_tile(host, take_first_round, work);
    if (result != PS_OK || shares->are_known)
        return result;
    struct tile_pilot *chosen = host->allocate(host, bytes, "first round");
    if (!chosen)
        return PS_ERROR_MEMORY;
    *shares = (struct gather_shares){true, allocation_of(work, chosen)};
    host->release(host, chosen);
    return PS_OK;
}

static ps_result share_out_samples(struct work *work, struct gather_shares *shares)
{
    const ps_host *host = work->setting->paths.host;
    size_t bytes = work->setting->paths.pass->tile_count * sizeof *work->pilots;
    work->pilots = host->allocate(host, bytes, "first round");
    if (!work->pilots)
        return PS_ERROR_MEMORY;
    memset(work->pilots, 0, bytes);
    work->shares = shares;
    ps_result result = make_places(work);
    double before = work->setting->share_before;
    double first = before + (1.0 - before) * (double)GATHER_FIRST / (double)work->setting->samples;
    host->progress_part(host, before, first);
    if (result == PS_OK)
        result = find_shares(work, shares);
    host->progress_part(host, first, 1.0);
    return result;
}

ps_result gather_picture(const struct gather_setting *setting, bool adaptive,
                         struct gather_shares *shares)
{
    const ps_host *host = setting->paths.host;
    struct work work = {.setting = setting};
    host->progress_part(host, setting->share_before, 1.0);
    ps_result result =
        adaptive && setting->samples > GATHER_FIRST ? share_out_samples(&work, shares) : PS_OK;
    if (result == PS_OK)
        result = host->for_each_tile(host, gather_tile, &work);
    host->release(host, work.first_rounds);
    host->release(host, work.places);
    host->release(host, work.pilots);
    return result;
}
