#include "gather_picture.h"

#include "allocation.h"
#include "contact.h"
#include "gather_guides.h"
#include "sampled_tiles.h"
#include <string.h>

#define MOST_PILOTS 8192 /* tiles by which the error of the picture is estimated */

struct work {
    const struct gather_setting *setting;
    const struct gather_allocation *allocation; /* NULL: all tiles take as many samples */
    /* What the first round found in each tile that is there and in those around, by `slots`, of all
     * tiles of the picture. */
    struct gather_first *first_rounds;
    /* Of the picture's tiles; of those that were not looked at, without points. */
    struct tile_pilot *pilots;
    uint32_t *slots;
};

#define NO_SLOT UINT32_MAX
#define IS_THERE 0u /* before slots are numbered */
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
    uint64_t first = gather->setting->first;
    size_t count = 0;
    for (size_t i = 0; i < gather->points.count; i++) {
        float light = 0.0f, of_half = 0.0f;
        if (which != BOTH_HALVES && gather_half_of(gather, i) != (int)which)
            continue;
        for (uint64_t number = 0; number < first; number++) {
            if (number == first / 2)
                of_half = light;
            light += ps_luminance(gather->first.found[number][i]);
        }
        uint32_t lane = gather->points.lanes[i];
        float scale = ps_luminance(ps_tile_reflectance(tile, lane)) / (float)first;
        found[count] = scale * light;
        half[count] = 2.0f * scale * of_half;
        lanes[count++] = lane;
    }
    return tile_pilot(lanes, found, half, count);
}

static void tell_variance(const struct gather *gather, uint64_t samples, ps_tile *tile)
{
    float variance[PS_TILE_PIXELS];
    for (size_t i = 0; i < gather->points.count; i++)
        variance[i] = gather_variance(gather, i, samples);
    contact_tell_variance(gather->setting->paths.host, &gather->points, gather->first.nearest,
                          variance, tile);
}

static float sum_of_factors(const struct gather *gather)
{
    float sum = 0.0f;
    for (size_t i = 0; i < gather->points.count; i++)
        sum += gather->first.factors[i];
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
    uint32_t slot = work->slots[index];
    if (slot == NO_SLOT && (work->allocation->is_known || !stands_for_picture(work, index)))
        return;
    const ps_host *host = work->setting->paths.host;
    ps_tile tile;
    struct gather gather;
    host->tile_surfaces(host, (uint32_t)index, sizeof tile, &tile);
    if (slot != NO_SLOT)
        work->first_rounds[slot].guide_count = 0; /* also of a tile that sees nothing */
    if (!begin_tile(work, index, &tile, &gather))
        return;
    gather_guide_first(&gather);
    gather_samples(&gather, work->setting->first);
    sample_factors(&gather.points, gather.first.factors);
    work->pilots[index] = pilot_of(&gather, &tile, BOTH_HALVES);
    work->pilots[index].factors = sum_of_factors(&gather);
    if (slot == NO_SLOT)
        return;
    gather_keep_first_round(&gather);
    work->first_rounds[slot] = gather.first;
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
        around[i] = &work->first_rounds[work->slots[tiles[i]]];
    gather_resume(gather, &work->first_rounds[work->slots[index]], around, count);
}

static void gather_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    const ps_host *host = work->setting->paths.host;
    ps_tile *tile = host->tile(host, (uint32_t)index);
    uint64_t samples = work->allocation
                           ? allocated_samples(&work->allocation->by_error, &work->pilots[index])
                           : work->setting->samples;
    struct gather gather;
    if (!begin_tile(work, index, tile, &gather))
        return;
    if (work->allocation) {
        const struct allocation *allocation = &work->allocation->by_error;
        resume(work, index, &gather);
        struct tile_pilot first = pilot_of(&gather, tile, FIRST_HALF);
        struct tile_pilot second = pilot_of(&gather, tile, SECOND_HALF);
        gather.expected_samples[0] = allocated_samples(allocation, &second);
        gather.expected_samples[1] = allocated_samples(allocation, &first);
    } else {
        gather_guide_first(&gather);
    }
    gather_samples(&gather, samples);
    for (size_t i = 0; i < gather.points.count; i++)
        ps_add_irradiance(tile, gather.points.lanes[i], gather.irradiance[i]);
    if (samples > work->setting->first)
        tell_variance(&gather, samples, tile);
}

static void mark_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    work->slots[index] = IS_THERE;
}

/* Gives a slot to each tile that is there (IS_THERE) and to those around it. Returns how many. */
static uint32_t number_slots(const struct work *work)
{
    const ps_pass *pass = work->setting->paths.pass;
    uint32_t count = 0, tiles[8];
    for (uint32_t tile = 0; tile < pass->tile_count; tile++) {
        size_t around = work->slots[tile] == IS_THERE ? tiles_around(pass, tile, tiles) : 0;
        for (size_t i = 0; i < around; i++)
            if (work->slots[tiles[i]] == NO_SLOT)
                work->slots[tiles[i]] = IS_WANTED;
    }
    for (uint32_t tile = 0; tile < pass->tile_count; tile++)
        if (work->slots[tile] != NO_SLOT)
            work->slots[tile] = count++;
    return count;
}

/* Finds the tiles that are there, and makes room for what the first round finds in them and
 * around. */
static ps_result make_slots(struct work *work)
{
    const ps_host *host = work->setting->paths.host;
    size_t tiles = work->setting->paths.pass->tile_count;
    double before = work->setting->share_before;
    host->progress_part(host, before, before);
    work->slots = host->allocate(host, tiles * sizeof *work->slots, "first round");
    if (!work->slots)
        return PS_ERROR_MEMORY;
    for (size_t i = 0; i < tiles; i++)
        work->slots[i] = NO_SLOT;
    ps_result result = host->for_each_tile(host, mark_tile, work);
    size_t bytes = number_slots(work) * sizeof *work->first_rounds;
    work->first_rounds = host->allocate(host, bytes, "first round");
    return work->first_rounds || result != PS_OK ? result : PS_ERROR_MEMORY;
}

/* By the tiles that stand for the picture, which `pilots` then begins with. */
static struct allocation allocation_of(const struct work *work, struct tile_pilot *pilots)
{
    size_t tiles = work->setting->paths.pass->tile_count, count = 0;
    const struct gather_setting *setting = work->setting;
    /* The first round may have missed all that there is to be found in a tile, and has much more
     * noise than guided rays: half of those are taken everywhere. */
    const struct allocation_limits limits = {
        .first = setting->first,
        .samples = setting->samples,
        .least = setting->first + (setting->samples - setting->first + 1) / 2,
        .most = setting->most,
    };
    for (size_t i = 0; i < tiles; i++)
        if (stands_for_picture(work, i))
            pilots[count++] = work->pilots[i];
    return allocation_for(&limits, pilots, count);
}

/* Takes the first round of tiles, and finds the allocation, where it is not known, by those that
 * stand for the picture. */
static ps_result find_allocation(struct work *work, struct gather_allocation *allocation)
{
    const ps_host *host = work->setting->paths.host;
    size_t bytes = work->setting->paths.pass->tile_count * sizeof *work->pilots;
    ps_result result = host->for_each_picture_tile(host, take_first_round, work);
    if (result != PS_OK || allocation->is_known)
        return result;
    struct tile_pilot *chosen = host->allocate(host, bytes, "first round");
    if (!chosen)
        return PS_ERROR_MEMORY;
    *allocation = (struct gather_allocation){true, allocation_of(work, chosen)};
    host->release(host, chosen);
    return PS_OK;
}

static ps_result allocate_samples(struct work *work, struct gather_allocation *allocation)
{
    const ps_host *host = work->setting->paths.host;
    size_t bytes = work->setting->paths.pass->tile_count * sizeof *work->pilots;
    work->pilots = host->allocate(host, bytes, "first round");
    if (!work->pilots)
        return PS_ERROR_MEMORY;
    memset(work->pilots, 0, bytes);
    work->allocation = allocation;
    ps_result result = make_slots(work);
    double before = work->setting->share_before;
    double first =
        before + (1.0 - before) * (double)work->setting->first / (double)work->setting->samples;
    host->progress_part(host, before, first);
    if (result == PS_OK)
        result = find_allocation(work, allocation);
    host->progress_part(host, first, 1.0);
    return result;
}

ps_result gather_picture(const struct gather_setting *setting, bool adaptive,
                         struct gather_allocation *allocation)
{
    const ps_host *host = setting->paths.host;
    struct work work = {.setting = setting};
    host->progress_part(host, setting->share_before, 1.0);
    ps_result result =
        adaptive && setting->samples > setting->first ? allocate_samples(&work, allocation) : PS_OK;
    if (result == PS_OK)
        result = host->for_each_tile(host, gather_tile, &work);
    host->release(host, work.first_rounds);
    host->release(host, work.slots);
    host->release(host, work.pilots);
    return result;
}
