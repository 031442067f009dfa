#include "surfel_table.h"

#include <string.h>

#define LEVELS 8         /* of cubes */
#define BY_LENGTH 0.075f /* side of a cube, in lengths of the ray */
#define MOST_BY_LENGTH 0.6f
#define ENOUGH 2 /* surfels of a cube that is not the largest one */

/* Half of a cache line: lookups go all over the table. */
struct surfel_cell {
    uint64_t key;         /* 0: none */
    ps_rgb indirect, sky; /* means over the surfels, W/m^2 */
};

/* --- cubes --- */

/* One of 54 directions: a face of a cube, and a ninth of it. */
static uint64_t normal_key(ps_vec3 n)
{
    uint32_t face = surfel_facing(n);
    float most = ps_max(fabsf(n.x), ps_max(fabsf(n.y), fabsf(n.z)));
    float a = face < 2 ? n.y : n.x, b = face < 4 ? n.z : n.y, third = most * (1.0f / 3.0f);
    uint32_t column = a < -third ? 0 : a > third ? 2 : 1, row = b < -third ? 0 : b > third ? 2 : 1;
    return face * 9 + row * 3 + column;
}

/* Index of a cube along an axis; what lies out of the scene's bounds counts as at its border. */
static uint64_t cube_at(float place, float scale)
{
    return (uint64_t)ps_min(ps_max(place * scale, 0.0f), 65535.0f);
}

static uint64_t cell_key(const struct surfels *surfels, ps_vec3 p, uint64_t normal, uint32_t level)
{
    float scale = (float)(1u << level) / surfels->largest;
    uint64_t x = cube_at(p.x - surfels->origin.x, scale);
    uint64_t y = cube_at(p.y - surfels->origin.y, scale);
    uint64_t z = cube_at(p.z - surfels->origin.z, scale);
    return UINT64_C(1) << 63 | x << 44 | y << 28 | z << 12 | normal << 4 | level;
}

static uint32_t level_of_key(uint64_t key)
{
    return key & 15;
}

static size_t hash(uint64_t key)
{
    key = (key ^ (key >> 31)) * UINT64_C(0x9e3779b97f4a7c15);
    return (size_t)(key ^ (key >> 32));
}

/* The cell of that key, or the free place where it would be. */
static struct surfel_cell *cell_at(const struct surfels *surfels, uint64_t key)
{
    size_t place = hash(key) & (surfels->capacity - 1);
    while (surfels->cells[place].key && surfels->cells[place].key != key)
        place = (place + 1) & (surfels->capacity - 1);
    return &surfels->cells[place];
}

static uint32_t level_of(const struct surfels *surfels, float side)
{
    uint32_t level = 0;
    while (level + 1 < LEVELS && surfels->largest > side * (float)(1u << level) * 1.4142f)
        level++;
    return level;
}

/* The smallest cubes that a surfel is put in: rays that are shorter than the one that found it are few there. */
static uint32_t finest_level(const struct surfels *surfels, size_t i)
{
    return level_of(surfels, 0.5f * BY_LENGTH * surfels->lengths[i]);
}

/* --- making it --- */

/* Lists each surfel by each cube that it lies in. */
static void list_cubes(const struct surfels *surfels, ps_key_entry *entries)
{
    for (size_t i = 0; i < surfels->count; i++) {
        uint64_t normal = normal_key(surfels->normals[i]);
        for (uint32_t level = 0; level <= finest_level(surfels, i); level++) {
            uint64_t key = cell_key(surfels, surfels->positions[i], normal, level);
            *entries++ = (ps_key_entry){key, i};
        }
    }
}

/* Surfels in the cube of the first of n entries, which are sorted. */
static size_t surfels_of(const ps_key_entry *entries, size_t n)
{
    size_t count = 1;
    while (count < n && entries[count].key == entries[0].key)
        count++;
    return count;
}

/* A cube is kept if there are enough surfels, or if none larger could be asked. */
static bool is_kept(uint64_t key, size_t count)
{
    return count >= ENOUGH || level_of_key(key) == 0;
}

static struct surfel_cell mean_of(const struct surfels *surfels, const ps_key_entry *entries,
                                  size_t count)
{
    struct surfel_cell cell = {.key = entries[0].key};
    for (size_t i = 0; i < count; i++) {
        cell.indirect = ps_rgb_add(cell.indirect, surfels->irradiance[entries[i].index]);
        if (surfels->sky)
            cell.sky = ps_rgb_add(cell.sky, surfels->sky[entries[i].index]);
    }
    cell.indirect = ps_rgb_scale(cell.indirect, 1.0f / (float)count);
    cell.sky = ps_rgb_scale(cell.sky, 1.0f / (float)count);
    return cell;
}

static ps_result fill(struct surfels *surfels, const ps_key_entry *sorted, size_t n)
{
    const ps_host *host = surfels->host;
    size_t kept = 0;
    for (size_t i = 0, count; i < n; i += count) {
        count = surfels_of(sorted + i, n - i);
        kept += is_kept(sorted[i].key, count);
    }
    surfels->capacity = 16;
    while (surfels->capacity < 2 * kept)
        surfels->capacity *= 2;
    size_t bytes = surfels->capacity * sizeof *surfels->cells;
    host->release(host, surfels->cells);
    surfels->cells = host->allocate(host, bytes, "surfels");
    if (!surfels->cells)
        return PS_ERROR_MEMORY;
    memset(surfels->cells, 0, bytes);
    for (size_t i = 0, count; i < n; i += count) {
        count = surfels_of(sorted + i, n - i);
        if (is_kept(sorted[i].key, count))
            *cell_at(surfels, sorted[i].key) = mean_of(surfels, sorted + i, count);
    }
    return PS_OK;
}

ps_result surfel_table_build(struct surfels *surfels)
{
    const ps_host *host = surfels->host;
    size_t n = 0;
    for (size_t i = 0; i < surfels->count; i++)
        n += finest_level(surfels, i) + 1;
    ps_key_entry *entries = host->allocate(host, 2 * n * sizeof *entries, "surfels sorted");
    if (!entries)
        return PS_ERROR_MEMORY;
    list_cubes(surfels, entries);
    const ps_key_entry *sorted = surfels->extension->sort(entries, entries + n, n);
    ps_result result = fill(surfels, sorted, n);
    host->release(host, entries);
    return result;
}

/* --- asking it --- */

/* Somewhere within a cube's side of a point, along the two axes that its surface faces least. */
static ps_vec3 move(ps_vec3 p, ps_vec3 normal, float side, const float numbers[2])
{
    uint32_t axis = surfel_facing(normal) / 2;
    float a = (numbers[0] - 0.5f) * side, b = (numbers[1] - 0.5f) * side;
    return (ps_vec3){p.x + (axis == 0 ? 0.0f : a),
                     p.y + (axis == 1   ? 0.0f
                            : axis == 0 ? a
                                        : b),
                     p.z + (axis == 2 ? 0.0f : b)};
}

bool surfel_table_lookup(const void *opaque, ps_vec3 position, ps_vec3 normal, float length,
                         const float numbers[2], struct gather_known *known)
{
    const struct surfels *surfels = opaque;
    uint64_t direction = normal_key(normal);
    uint32_t level = level_of(surfels, BY_LENGTH * length);
    for (;; level--) {
        float side = surfels->largest / (float)(1u << level);
        if (side > MOST_BY_LENGTH * length)
            return false;
        ps_vec3 moved = move(position, normal, side, numbers);
        const struct surfel_cell *cell =
            cell_at(surfels, cell_key(surfels, moved, direction, level));
        if (cell->key) {
            *known = (struct gather_known){cell->indirect, cell->sky};
            return true;
        }
        if (level == 0)
            return false;
    }
}
