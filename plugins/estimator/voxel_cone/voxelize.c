#include "voxelize.h"

#include <string.h>

#define PATHS_PER_VOXEL 4
#define STREAM_LIGHT (PS_STREAM_PLUGIN + 1) /* places on area lights */

/* What the lines through one voxel met, along the axis and against it. */
struct column {
    uint32_t covered; /* lines, of both ways */
    float depth;      /* sum of where */
    struct voxel_tilt tilt;
    ps_rgb light[2]; /* sums of radiance; of the sides that face along the axis and against it */
};

/* Voxels in one layer: those of one row of cells, which lines along an axis pass. */
struct layer {
    struct volume_part *parts; /* the host's memory */
    size_t count;
    ps_result result;
};

struct work {
    const struct surface_lines *lines;
    const ps_pass *pass;
    struct column *columns; /* a layer for each worker, all 0 between layers */
    uint64_t *touched;      /* a bit for each of its columns that is not 0 */
    uint32_t *last_cells;   /* of the lines in a row, for each worker: the cell that each was in */
    struct layer *layers;   /* one for each axis and row of cells */
};

/* A worker's part of the work. */
struct layer_work {
    const struct work *work;
    struct column *columns;
    uint64_t *touched;
    uint32_t *last_cells;
};

/* --- light
 * ---------------------------------------------------------------------------------------------- */

/* Radiance towards where the lines came from, of direct light that is reflected diffusely: what
 * gloss makes of it is left to photons, as one direction would stand for all. */
static void find_light(const struct work *work, struct surface_crossings *crossings,
                       ps_rgb *radiance)
{
    const ps_host *host = work->lines->host;
    uint64_t indices[PS_PATH_CHUNK];
    for (size_t i = 0; i < crossings->n; i++) {
        uint64_t row = (uint64_t)work->pass->number * SURFACE_WAYS + crossings->way;
        indices[i] = row << 32 | (uint64_t)crossings->row << 16 | crossings->columns[i];
        crossings->hits[i].flags &= ~PS_HIT_SPECULAR;
    }
    host->direct_radiance(host, crossings->rays, crossings->hits, STREAM_LIGHT, crossings->round,
                          indices, crossings->n, radiance);
}

/* --- surfaces
 * ---------------------------------------------------------------------------------------------- */

/* The cell along the way of a line, 0 <= cell < across, and how far along it, 0..1. */
static uint32_t cell_along(const struct voxel_grid *grid, uint32_t axis, ps_vec3 position,
                           float *depth)
{
    float place[3];
    voxel_grid_place(grid, position, place);
    float last = (float)(grid->across - 1);
    uint32_t cell = (uint32_t)ps_min(ps_max(place[axis], 0.0f), last);
    *depth = place[axis] - (float)cell;
    return cell;
}

static void add_tilt(ps_vec3 normal, struct voxel_tilt *tilt)
{
    float n[3], area = surface_lines_area(normal);
    voxel_components(normal, n);
    for (int k = 0; k < 3; k++) {
        tilt->diagonal[k] += n[k] * n[k] * area;
        tilt->mixed[k] += n[k] * n[(k + 1) % 3] * area;
    }
}

/* A surface_lines_take. */
static void take_crossings(void *user, struct surface_crossings *crossings)
{
    const struct layer_work *layer = user;
    const struct work *work = layer->work;
    const struct surface_lines *lines = work->lines;
    uint32_t axis = surface_axis(crossings->way);
    ps_rgb radiance[PS_PATH_CHUNK];
    find_light(work, crossings, radiance);
    for (size_t i = 0; i < crossings->n; i++) {
        float depth;
        uint32_t cell = cell_along(&lines->grid, axis, crossings->hits[i].position, &depth);
        uint32_t *last = &layer->last_cells[crossings->columns[i]];
        if (crossings->round > 0 && *last == cell)
            continue; /* behind what was seen first */
        *last = cell;
        size_t row = crossings->columns[i] / lines->per_cell;
        size_t place = row * lines->grid.across + cell;
        struct column *column = &layer->columns[place];
        layer->touched[place / 64] |= UINT64_C(1) << place % 64;
        ps_rgb *light = &column->light[crossings->way < 3];
        column->covered++;
        column->depth += depth;
        add_tilt(crossings->hits[i].geometric_normal, &column->tilt);
        *light = ps_rgb_add(*light, radiance[i]);
    }
}

static size_t touched_words(uint32_t across)
{
    return ((size_t)across * across + 63) / 64;
}

static size_t count_touched(const struct layer_work *layer, uint32_t across)
{
    size_t count = 0;
    for (size_t word = 0; word < touched_words(across); word++)
        count += volume_count_bits(layer->touched[word]);
    return count;
}

static struct volume_part part_of(const struct column *column, const struct surface_lines *lines,
                                  uint32_t axis, const uint32_t at[3])
{
    float share = 1.0f / (float)(lines->per_cell * lines->per_cell);
    return (struct volume_part){
        .x = at[0],
        .y = at[1],
        .z = at[2],
        .axis = axis,
        .opacity = 0.5f * share * (float)column->covered,
        .depth = column->depth / (float)column->covered,
        .tilt = column->tilt,
        .light = {ps_rgb_scale(column->light[0], share), ps_rgb_scale(column->light[1], share)},
    };
}

/* Takes what surfaces lie in out of the columns, in their order; `parts` has room for it, or is
 * NULL: it is dropped. */
static void take_columns(const struct layer_work *work, uint32_t axis, uint32_t row,
                         struct layer *layer)
{
    const struct surface_lines *lines = work->work->lines;
    uint32_t across = lines->grid.across;
    for (size_t i = 0; i < (size_t)across * across; i++) {
        uint32_t at[3];
        if (i % 64 == 0 && work->touched[i / 64] == 0) {
            i += 63;
            continue;
        }
        if (!(work->touched[i / 64] >> i % 64 & 1))
            continue;
        at[axis] = (uint32_t)(i % across);
        at[(axis + 1) % 3] = (uint32_t)(i / across);
        at[(axis + 2) % 3] = row;
        if (layer->parts)
            layer->parts[layer->count++] = part_of(&work->columns[i], lines, axis, at);
        work->columns[i] = (struct column){.covered = 0};
    }
    memset(work->touched, 0, touched_words(across) * sizeof *work->touched);
}

/* Keeps what surfaces lie in, and leaves the columns empty. */
static ps_result keep_layer(const struct layer_work *work, uint32_t axis, uint32_t row,
                            struct layer *layer)
{
    const struct surface_lines *lines = work->work->lines;
    size_t count = count_touched(work, lines->grid.across);
    if (count == 0)
        return PS_OK;
    layer->parts = lines->host->allocate(lines->host, count * sizeof *layer->parts, VOLUME_MEMORY);
    take_columns(work, axis, row, layer);
    return layer->parts ? PS_OK : PS_ERROR_MEMORY;
}

static void find_layer(void *user, uint64_t index, uint32_t worker)
{
    const struct work *work = user;
    const struct surface_lines *lines = work->lines;
    uint32_t across = lines->grid.across, axis = (uint32_t)index / across;
    uint32_t row = (uint32_t)index % across;
    struct layer_work layer = {
        .work = work,
        .columns = work->columns + (size_t)worker * across * across,
        .touched = work->touched + worker * touched_words(across),
        .last_cells = work->last_cells + (size_t)worker * surface_lines_across(lines),
    };
    struct layer *kept = &work->layers[index];
    if (lines->host->cancelled(lines->host)) {
        kept->result = PS_CANCELLED;
        return;
    }
    for (uint32_t i = 0; i < 2 * lines->per_cell; i++)
        surface_lines_follow(lines, axis + 3 * (i & 1), row * lines->per_cell + i / 2,
                             take_crossings, &layer);
    kept->result = keep_layer(&layer, axis, row, kept);
}

/* --- the volume
 * --------------------------------------------------------------------------------------------- */

/* All layers in one array, in their order. */
static ps_result join(const struct work *work, struct volume *volume)
{
    const ps_host *host = work->lines->host;
    size_t layers = (size_t)3 * work->lines->grid.across, count = 0;
    for (size_t i = 0; i < layers; i++) {
        if (work->layers[i].result != PS_OK)
            return work->layers[i].result;
        count += work->layers[i].count;
    }
    struct volume_part *parts = host->allocate(host, (count + 1) * sizeof *parts, VOLUME_MEMORY);
    if (!parts)
        return PS_ERROR_MEMORY;
    count = 0;
    for (size_t i = 0; i < layers; i++) {
        const struct layer *layer = &work->layers[i];
        if (layer->count > 0)
            memcpy(parts + count, layer->parts, layer->count * sizeof *parts);
        count += layer->count;
    }
    ps_result result = volume_create(host, &work->lines->grid, parts, count, volume);
    host->release(host, parts);
    return result;
}

ps_result voxelize(const struct surface_lines *lines, const ps_pass *pass, struct volume *volume)
{
    const ps_host *host = lines->host;
    size_t across = lines->grid.across, layers = 3 * across;
    struct work work = {.lines = lines, .pass = pass};
    *volume = (struct volume){.host = host};
    size_t columns = pass->thread_count * across * across * sizeof *work.columns;
    size_t touched = pass->thread_count * touched_words((uint32_t)across) * sizeof *work.touched;
    work.columns = host->allocate(host, columns, VOLUME_MEMORY);
    work.touched = host->allocate(host, touched, VOLUME_MEMORY);
    work.last_cells = host->allocate(
        host, pass->thread_count * surface_lines_across(lines) * sizeof *work.last_cells,
        VOLUME_MEMORY);
    work.layers = host->allocate(host, layers * sizeof *work.layers, VOLUME_MEMORY);
    ps_result result = PS_ERROR_MEMORY;
    if (work.layers)
        memset(work.layers, 0, layers * sizeof *work.layers);
    if (work.columns && work.touched && work.last_cells && work.layers) {
        memset(work.columns, 0, columns);
        memset(work.touched, 0, touched);
        host->parallel_for(host, layers, find_layer, &work);
        result = join(&work, volume);
    }
    for (size_t i = 0; work.layers && i < layers; i++)
        host->release(host, work.layers[i].parts);
    host->release(host, work.layers);
    host->release(host, work.last_cells);
    host->release(host, work.touched);
    host->release(host, work.columns);
    return result;
}

/* --- photons
 * ---------------------------------------------------------------------------------------------- */

ps_result photon_light_create(const struct volume *volume, uint64_t paths,
                              struct photon_light *light)
{
    const ps_host *host = volume->host;
    *light = (struct photon_light){.host = host, .volume = volume};
    while (light->level + 1 < volume->level_count &&
           (uint64_t)volume->levels[light->level].voxel_count * PATHS_PER_VOXEL > paths)
        light->level++;
    size_t bytes = (volume->levels[light->level].voxel_count + 1) * sizeof *light->light;
    light->light = host->allocate(host, bytes, VOLUME_MEMORY);
    if (!light->light)
        return PS_ERROR_MEMORY;
    memset(light->light, 0, bytes);
    return PS_OK;
}

void photon_light_release(struct photon_light *light)
{
    light->host->release(light->host, light->light);
    *light = (struct photon_light){.host = light->host};
}

/* The voxel of a photon on its level, or NULL: where it lies, or half a voxel of the finest level
 * to either side of its surface, since lines find a place on the border of two cells in either. */
static const struct voxel *voxel_near(const struct photon_light *light, const ps_photon *photon)
{
    static const float sides[] = {0.0f, -0.5f, 0.5f};
    const struct volume *volume = light->volume;
    for (size_t i = 0; i < sizeof sides / sizeof sides[0]; i++) {
        uint32_t at[3];
        ps_vec3 place =
            ps_add_scaled(photon->position, sides[i] * volume->grid.side, photon->normal);
        if (!voxel_grid_cell(&volume->grid, place, at) ||
            !volume_at(&volume->levels[0], at[0], at[1], at[2]))
            continue;
        return volume_at(&volume->levels[light->level], at[0] >> light->level,
                         at[1] >> light->level, at[2] >> light->level);
    }
    return NULL;
}

void photon_light_add(struct photon_light *light, const ps_photon *photon)
{
    const struct voxel *voxel = voxel_near(light, photon);
    if (!voxel) {
        light->lost++;
        return;
    }
    ps_rgb *sides = light->light[voxel - light->volume->levels[light->level].voxels];
    float width = light->volume->grid.side * (float)(1 << light->level), facing[3];
    voxel_components(photon->lobe == PS_DIFFUSE ? photon->normal : photon->direction, facing);
    ps_rgb intensity = ps_rgb_scale(photon->power, 1.0f / PS_PI);
    for (uint32_t axis = 0; axis < 3; axis++) {
        ps_rgb *side = &sides[volume_side(axis, facing[axis] < 0.0f)];
        *side = ps_rgb_add(*side, ps_rgb_scale(intensity, fabsf(facing[axis]) / width / width));
    }
}
