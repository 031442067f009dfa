#include "volume.h"

#include <assert.h>
#include <string.h>

/* --- one level
 * ------------------------------------------------------------------------------------------ */

/* A level without bricks. */
static ps_result start_level(const ps_host *host, uint32_t across, struct volume_level *level)
{
    *level = (struct volume_level){.across = across, .bricks_across = (across + 3) / 4};
    size_t places = (size_t)level->bricks_across * level->bricks_across * level->bricks_across;
    level->table = host->allocate(host, places * sizeof *level->table, VOLUME_MEMORY);
    if (!level->table)
        return PS_ERROR_MEMORY;
    memset(level->table, 0, places * sizeof *level->table);
    return PS_OK;
}

/* There shall be a brick around this voxel. */
static void want_brick(struct volume_level *level, uint32_t x, uint32_t y, uint32_t z)
{
    *volume_brick_at(level, x, y, z) = 1;
}

/* Makes all bricks that are wanted, without voxels. */
static ps_result make_bricks(const ps_host *host, struct volume_level *level)
{
    uint32_t side = level->bricks_across;
    size_t places = (size_t)side * side * side;
    level->brick_count = 1; /* the first one is everywhere else */
    for (size_t i = 0; i < places; i++)
        level->brick_count += level->table[i];
    size_t bytes = level->brick_count * sizeof *level->bricks;
    level->bricks = host->allocate(host, bytes, VOLUME_MEMORY);
    if (!level->bricks)
        return PS_ERROR_MEMORY;
    memset(level->bricks, 0, bytes);
    uint32_t number = 0;
    for (size_t i = 0; i < places; i++) {
        if (!level->table[i])
            continue;
        level->table[i] = ++number;
        level->bricks[number].x = (uint32_t)(i % side);
        level->bricks[number].y = (uint32_t)(i / side % side);
        level->bricks[number].z = (uint32_t)(i / side / side);
    }
    return PS_OK;
}

/* There shall be a voxel here; its brick is there. */
static void want_voxel(struct volume_level *level, uint32_t x, uint32_t y, uint32_t z)
{
    struct voxel_brick *brick = &level->bricks[*volume_brick_at(level, x, y, z)];
    assert(brick != level->bricks);
    brick->mask |= UINT64_C(1) << volume_bit(x, y, z);
}

/* Makes all voxels that are wanted: black and transparent. */
static ps_result make_voxels(const ps_host *host, struct volume_level *level)
{
    for (size_t i = 0; i < level->brick_count; i++) {
        level->bricks[i].first = (uint32_t)level->voxel_count;
        level->voxel_count += volume_count_bits(level->bricks[i].mask);
    }
    size_t bytes = (level->voxel_count + 1) * sizeof *level->voxels;
    level->voxels = host->allocate(host, bytes, VOLUME_MEMORY);
    if (!level->voxels)
        return PS_ERROR_MEMORY;
    memset(level->voxels, 0, bytes);
    return PS_OK;
}

/* --- levels
 * ---------------------------------------------------------------------------------------------- */

/* Light of the voxel behind, as far as the one before leaves room for it. */
static ps_rgb light_behind(const struct voxel *before, const struct voxel *behind, uint32_t axis,
                           uint32_t side)
{
    float left = 1.0f - before->opacity[axis], covered = behind->opacity[axis];
    return ps_rgb_scale(behind->light[side], covered > left ? left / covered : 1.0f);
}

/* Puts two voxels behind each other together, along an axis: adds a quarter of it to the voxel
 * above. Either may be NULL. `a` comes first along the axis. */
static void add_column(const struct voxel *a, const struct voxel *b, uint32_t axis,
                       struct voxel *above)
{
    static const struct voxel empty;
    a = a ? a : &empty;
    b = b ? b : &empty;
    uint32_t low = volume_side(axis, true), high = volume_side(axis, false);
    ps_rgb seen_low = ps_rgb_add(a->light[low], light_behind(a, b, axis, low));
    ps_rgb seen_high = ps_rgb_add(b->light[high], light_behind(b, a, axis, high));
    above->opacity[axis] += 0.25f * ps_min(a->opacity[axis] + b->opacity[axis], 1.0f);
    above->light[low] = ps_rgb_add(above->light[low], ps_rgb_scale(seen_low, 0.25f));
    above->light[high] = ps_rgb_add(above->light[high], ps_rgb_scale(seen_high, 0.25f));
}

struct raising {
    const struct volume_level *below;
    struct volume_level *level;
};

static void raise_voxel(const struct volume_level *below, const uint32_t place[3],
                        struct voxel *above)
{
    *above = (struct voxel){.opacity = {0}};
    for (uint32_t axis = 0; axis < 3; axis++) {
        for (uint32_t column = 0; column < 4; column++) {
            uint32_t at[3] = {2 * place[0], 2 * place[1], 2 * place[2]};
            at[(axis + 1) % 3] += column & 1;
            at[(axis + 2) % 3] += column >> 1;
            const struct voxel *a = volume_at(below, at[0], at[1], at[2]);
            at[axis]++;
            const struct voxel *b = volume_at(below, at[0], at[1], at[2]);
            add_column(a, b, axis, above);
            if (axis == 0 && a)
                voxel_tilt_add(&above->tilt, &a->tilt);
            if (axis == 0 && b)
                voxel_tilt_add(&above->tilt, &b->tilt);
        }
    }
}

static void raise_brick(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct raising *raising = user;
    const struct voxel_brick *brick = &raising->level->bricks[index];
    struct voxel *voxel = raising->level->voxels + brick->first;
    for (uint32_t bit = 0; bit < 64; bit++) {
        uint32_t place[3];
        volume_place(brick, bit, place);
        if (brick->mask >> bit & 1)
            raise_voxel(raising->below, place, voxel++);
    }
}

/* Makes the voxels of a level of those below. */
static void raise_level(struct volume *volume, uint32_t number)
{
    struct raising raising = {&volume->levels[number - 1], &volume->levels[number]};
    volume->host->parallel_for(volume->host, raising.level->brick_count, raise_brick, &raising);
}

/* Calls want() for what lies above each voxel of a level. */
static void want_above(const struct volume_level *below, struct volume_level *level,
                       void (*want)(struct volume_level *, uint32_t, uint32_t, uint32_t))
{
    for (size_t i = 1; i < below->brick_count; i++) {
        const struct voxel_brick *brick = &below->bricks[i];
        for (uint32_t bit = 0; bit < 64; bit++) {
            uint32_t place[3];
            volume_place(brick, bit, place);
            if (brick->mask >> bit & 1)
                want(level, place[0] / 2, place[1] / 2, place[2] / 2);
        }
    }
}

static ps_result build_level(struct volume *volume, uint32_t number)
{
    const ps_host *host = volume->host;
    struct raising raising = {&volume->levels[number - 1], &volume->levels[number]};
    ps_result result = start_level(host, (raising.below->across + 1) / 2, raising.level);
    volume->level_count = number + 1;
    if (result == PS_OK) {
        want_above(raising.below, raising.level, want_brick);
        result = make_bricks(host, raising.level);
    }
    if (result == PS_OK) {
        want_above(raising.below, raising.level, want_voxel);
        result = make_voxels(host, raising.level);
    }
    if (result == PS_OK)
        raise_level(volume, number);
    return result;
}

ps_result volume_build_levels(struct volume *volume)
{
    ps_result result = PS_OK;
    for (uint32_t number = 1;
         result == PS_OK && number < VOLUME_MOST_LEVELS && volume->levels[number - 1].across > 1;
         number++)
        result = volume->host->cancelled(volume->host) ? PS_CANCELLED : build_level(volume, number);
    return result;
}

/* --- light that comes later
 * ------------------------------------------------------------------------------ */

struct lighting {
    const struct volume *volume;
    uint32_t level;
    const ps_rgb (*light)[6];
};

static void light_voxel(const struct lighting *lighting, const uint32_t place[3],
                        struct voxel *voxel)
{
    const struct volume_level *level = &lighting->volume->levels[lighting->level];
    const struct voxel *above = volume_at(level, place[0] >> lighting->level,
                                          place[1] >> lighting->level, place[2] >> lighting->level);
    assert(above);
    const ps_rgb *light = lighting->light[above - level->voxels];
    for (uint32_t side = 0; side < 6; side++) {
        float whole = above->opacity[side % 3], part = voxel->opacity[side % 3];
        if (part > 0.0f)
            voxel->light[side] =
                ps_rgb_add(voxel->light[side], ps_rgb_scale(light[side], part / whole));
    }
}

static void light_brick(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct lighting *lighting = user;
    const struct volume_level *level = &lighting->volume->levels[0];
    const struct voxel_brick *brick = &level->bricks[index];
    struct voxel *voxel = level->voxels + brick->first;
    for (uint32_t bit = 0; bit < 64; bit++) {
        uint32_t place[3];
        volume_place(brick, bit, place);
        if (brick->mask >> bit & 1)
            light_voxel(lighting, place, voxel++);
    }
}

void volume_add_light(struct volume *volume, uint32_t level, const ps_rgb (*light)[6])
{
    struct lighting lighting = {volume, level, light};
    volume->host->parallel_for(volume->host, volume->levels[0].brick_count, light_brick, &lighting);
    for (uint32_t number = 1; number < volume->level_count; number++)
        raise_level(volume, number);
}

/* --- the finest level
 * --------------------------------------------------------------------------------------- */

static void add_part(const struct volume_level *level, const struct volume_part *part)
{
    struct voxel *voxel = volume_at(level, part->x, part->y, part->z);
    assert(voxel);
    voxel->opacity[part->axis] = part->opacity;
    voxel->depth[part->axis] = part->depth;
    voxel_tilt_add(&voxel->tilt, &part->tilt);
    voxel->light[volume_side(part->axis, false)] = part->light[0];
    voxel->light[volume_side(part->axis, true)] = part->light[1];
}

ps_result volume_create(const ps_host *host, const struct voxel_grid *grid,
                        const struct volume_part *parts, size_t n, struct volume *volume)
{
    *volume = (struct volume){.host = host, .grid = *grid, .level_count = 1};
    struct volume_level *level = &volume->levels[0];
    ps_result result = start_level(host, grid->across, level);
    if (result != PS_OK)
        return result;
    for (size_t i = 0; i < n; i++)
        want_brick(level, parts[i].x, parts[i].y, parts[i].z);
    result = make_bricks(host, level);
    if (result != PS_OK)
        return result;
    for (size_t i = 0; i < n; i++)
        want_voxel(level, parts[i].x, parts[i].y, parts[i].z);
    result = make_voxels(host, level);
    for (size_t i = 0; result == PS_OK && i < n; i++)
        add_part(level, &parts[i]);
    return result;
}

void volume_release(struct volume *volume)
{
    for (uint32_t i = 0; i < volume->level_count; i++) {
        volume->host->release(volume->host, volume->levels[i].table);
        volume->host->release(volume->host, volume->levels[i].bricks);
        volume->host->release(volume->host, volume->levels[i].voxels);
    }
    *volume = (struct volume){.host = volume->host};
}
