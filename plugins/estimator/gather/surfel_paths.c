#include "surfel_paths.h"

#include "surfel_correction.h"
#include "surfel_table.h"

#define FEWEST_ONE_SEGMENT 4   /* paths of a surfel: with fewer there is no second step */
#define ONE_SEGMENT_PER_FULL 4 /* paths of one segment for each that goes to its end */
#define FEWEST_FULL 2

/* One step: paths from all surfels. */
struct step {
    struct gather_setting setting;
    const struct surfels *surfels;
    uint64_t first_index;  /* of the groups, among all that draw random numbers */
    ps_rgb *traced, *half; /* irradiance by paths, and by the first half of each surfel's */
};

/* From a group of surfels, as if they were the pixels of a tile. */
static void trace_group(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct step *step = user;
    const struct surfels *surfels = step->surfels;
    struct surfel_group group = surfels_group(surfels, SURFELS_GROUP, index);
    struct gather gather = {.setting = &step->setting, .index = step->first_index + index};
    if (surfels->host->cancelled(surfels->host))
        return;
    for (uint32_t i = 0; i < group.n; i++) {
        gather.points.positions[i] = surfels->positions[group.first + i];
        gather.points.normals[i] = surfels->normals[group.first + i];
        gather.points.lanes[i] = i;
        gather.points.count++;
    }
    gather_begin(&gather);
    gather_samples(&gather, step->setting.samples);
    for (size_t i = 0; i < gather.points.count; i++) {
        step->traced[group.first + i] = gather.irradiance[i];
        step->half[group.first + i] = ps_rgb_scale(gather.half[i], 2.0f);
    }
}

static ps_result take_step(struct step *step, struct surfels *surfels)
{
    const ps_host *host = surfels->host;
    step->surfels = surfels;
    step->traced = host->allocate(host, 2 * surfels->count * sizeof(ps_rgb), "surfels");
    if (!step->traced)
        return PS_ERROR_MEMORY;
    step->half = step->traced + surfels->count;
    host->parallel_for(host, surfels_group_count(surfels, SURFELS_GROUP), trace_group, step);
    ps_result result = host->cancelled(host) ? PS_CANCELLED : PS_OK;
    if (result == PS_OK)
        result = surfels_correct(surfels, step->traced, step->half);
    host->release(host, step->traced);
    return result;
}

ps_result surfel_paths_correct(const ps_pass *pass, uint32_t roulette, uint64_t paths,
                               struct surfels *surfels)
{
    const ps_host *host = surfels->host;
    ps_pass left = *pass; /* for surfels, which are one surface on */
    left.bounces -= left.bounces != PS_ALL_BOUNCES;
    bool has_second_step = paths >= FEWEST_ONE_SEGMENT && pass->bounces == PS_ALL_BOUNCES;
    uint64_t full = has_second_step ? paths / ONE_SEGMENT_PER_FULL : paths;
    if (has_second_step && full < FEWEST_FULL)
        full = FEWEST_FULL;
    const struct paths_setting setting = {
        .host = host, .pass = &left, .roulette = roulette, .least_roughness = PS_ROUGH_GLOSS};
    struct step first = {
        .setting = {.paths = setting, .samples = full, .first = GATHER_MOST_FIRST, .most = full},
        .first_index = pass->tile_count,
    };
    struct step second = {
        .setting = {.paths = setting,
                    .samples = paths,
                    .first = GATHER_MOST_FIRST,
                    .most = paths,
                    .lookup = surfel_table_lookup,
                    .cache = surfels,
                    .cache_has_indirect = true,
                    .cache_has_sky = surfels->sky != NULL},
        .first_index = pass->tile_count + surfels_group_count(surfels, SURFELS_GROUP),
    };
    ps_result result = take_step(&first, surfels);
    if (result == PS_OK && has_second_step)
        result = surfel_table_build(surfels);
    return result == PS_OK && has_second_step ? take_step(&second, surfels) : result;
}
