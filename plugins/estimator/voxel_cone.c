/* voxel_cone.c: voxel cone tracing: the scene in voxels, at which cones look.
 *
 * Crassin, Neyret, Sainz, Green and Eisemann 2011, "Interactive indirect illumination using voxel
 * cone tracing". Light that leaves surfaces is kept in voxels that know it by six sides, and in
 * coarser and coarser levels of them (voxel_cone/volume.h). Irradiance at a pixel is what a few
 * cones see, each in levels as coarse as it is wide (voxel_cone/cones.h): so there is no noise of
 * rays, and cost does not depend on what the scene consists of.
 *
 * Light comes into the voxels by shadow rays where it has met one surface, and by photons where it
 * has met more (voxel_cone/voxelize.h), gloss and mirrors included. So all bounces cost as much as
 * one, where the paper gathers again from voxels for each. Caustics, which voxels would blur, are
 * splatted.
 *
 * Each pass shifts the grid by a part of a voxel and turns the cones, so that what depends on
 * either is averaged.
 */
#include "shared/caustics.h"
#include "shared/photons.h"
#include "voxel_cone/cones.h"
#include "voxel_cone/voxelize.h"

#define STREAM_GRID PS_STREAM_PLUGIN       /* shift of the grid, turn of a pass's cones */
#define STREAM_TURN (PS_STREAM_PLUGIN + 2) /* turn of a pixel's cones */

enum { TURN_PIXEL, TURN_PASS };

static const char *const turn_choices[] = {"pixel", "pass", NULL};

struct state {
    int64_t resolution;
    int64_t cones;
    int32_t turn;
    int64_t rays;
};

struct work {
    const ps_host *host;
    const ps_pass *pass;
    struct volume volume; /* owned */
    struct cone *cones;   /* owned */
    uint32_t cone_count;
    int32_t turn;
    float pass_turn; /* 0..1 */
};

/* --- the volume
 * ---------------------------------------------------------------------------------------------- */

/* Photons on their way into the volume. */
struct photon_work {
    const struct work *work;
    struct photon_light light;
};

/* Whether a photon is light that shadow rays from the voxels do not find, and the cones are to
 * see. */
static bool is_wanted(const ps_pass *pass, const ps_photon *photon)
{
    if (photon->bounce == 0 || photon->bounce > pass->bounces)
        return false;
    return photon->bounce > 1 || photon->specular;
}

/* A photons_take. */
static ps_result take_photons(void *opaque, const ps_photon *photons, size_t n)
{
    struct photon_work *photon_work = opaque;
    const struct work *work = photon_work->work;
    for (size_t i = 0; i < n; i++)
        if (is_wanted(work->pass, &photons[i]))
            photon_light_add(&photon_work->light, &photons[i]);
    return work->pass->specular ? caustics_splat_photons(work->host, photons, n) : PS_OK;
}

static ps_result light_by_photons(struct work *work)
{
    const ps_host *host = work->host;
    struct photon_work photon_work = {work, {.host = host}};
    uint64_t paths;
    if (work->pass->bounces < 2 && !work->pass->specular)
        return PS_OK;
    ps_result result = host->path_count(host, &paths);
    if (result == PS_OK)
        result = photon_light_create(&work->volume, paths, &photon_work.light);
    if (result == PS_OK && work->pass->specular)
        result = host->begin_splats(host, 0);
    if (result == PS_OK)
        result = photons_for_each_batch(host, take_photons, &photon_work);
    if (result == PS_OK)
        volume_add_light(&work->volume, photon_work.light.level,
                         (const ps_rgb(*)[6])photon_work.light.light);
    host->count(host, "photons left out", (double)photon_work.light.lost);
    photon_light_release(&photon_work.light);
    return result;
}

static ps_result make_volume(const struct state *state, struct work *work, const float shift[3])
{
    const ps_host *host = work->host;
    ps_vec3 center;
    float radius;
    host->scene_bounds(host, &center, &radius);
    if (!(radius > 0.0f)) /* no surfaces */
        return PS_OK;
    const struct surface_lines lines = {
        .host = host,
        .grid = voxel_grid_around(center, radius, (uint32_t)state->resolution, shift),
        .per_cell = (uint32_t)state->rays,
        .offset = work->pass->surface_offset,
    };
    ps_result result = voxelize(&lines, work->pass, &work->volume);
    if (result == PS_OK)
        result = volume_build_levels(&work->volume);
    if (result == PS_OK)
        result = light_by_photons(work);
    host->count(host, "radiance voxels", (double)work->volume.levels[0].voxel_count);
    return result;
}

/* --- the picture
 * ---------------------------------------------------------------------------------------------- */

static void light_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    ps_tile *tile = work->host->tile(work->host, (uint32_t)index);
    ps_points points;
    uint64_t samples[PS_TILE_PIXELS];
    float turns[PS_TILE_PIXELS][4];
    ps_collect_points(tile, &points);
    for (size_t i = 0; i < points.count; i++)
        samples[i] = ps_tile_sample(index, points.lanes[i], work->pass->number, 1);
    if (work->turn == TURN_PIXEL)
        work->host->samples(work->host, STREAM_TURN, 0, samples, points.count, turns);
    for (size_t i = 0; i < points.count; i++) {
        float turn = work->turn == TURN_PIXEL ? turns[i][0] : work->pass_turn;
        ps_add_irradiance(tile, points.lanes[i],
                          cones_irradiance(&work->volume, work->cones, work->cone_count,
                                           points.positions[i], points.normals[i],
                                           2.0f * PS_PI * turn));
    }
}

static ps_result light_picture(struct work *work)
{
    const ps_host *host = work->host;
    work->cones = host->allocate(host, work->cone_count * sizeof *work->cones, VOLUME_MEMORY);
    if (!work->cones)
        return PS_ERROR_MEMORY;
    cones_make(work->cone_count, work->cones);
    return host->for_each_tile(host, light_tile, work);
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    const struct state *state = opaque;
    float numbers[1][4];
    uint64_t index = pass->number;
    host->samples(host, STREAM_GRID, 0, &index, 1, numbers);
    struct work work = {
        .host = host,
        .pass = pass,
        .volume = {.host = host},
        .cone_count = (uint32_t)state->cones,
        .turn = state->turn,
        .pass_turn = numbers[0][3],
    };
    ps_result result = make_volume(state, &work, numbers[0]);
    if (result == PS_OK)
        result = light_picture(&work);
    host->release(host, work.cones);
    volume_release(&work.volume);
    return result;
}

static const ps_param params[] = {
    PS_INT(struct state, resolution, "128", 4, 1024, "voxels",
           "voxels across the sphere around the scene, along each axis"),
    PS_INT(struct state, cones, "16", 1, CONES_MOST, "cones",
           "cones that a pixel sees its hemisphere by"),
    PS_CHOICE(struct state, turn, "pixel", turn_choices,
              "what cones are turned for: pixel: each pixel, whose noise a denoiser removes; pass: "
              "each pass, without noise"),
    PS_ROW(struct state, rays, PS_PARAM_INT, "3", 1, 16, PS_PARAM_EXPERT, NULL, "rays",
           "rays across a voxel, in rows and columns, that find its surfaces"),
};

static const ps_estimator_vtable vtable = {
    .size = sizeof vtable,
    .flags = PS_ESTIMATOR_CROPS,
    .accumulate = accumulate,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "voxel_cone",
    .version = "1.0",
    .summary = "voxel cone tracing: light in voxels of many sizes, at which a few cones look",
    .paper = "Crassin et al. 2011, Interactive indirect illumination using voxel cone tracing",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, voxel_cone, &descriptor)
