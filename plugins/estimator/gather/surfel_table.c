#include "surfel_table.h"

#include <string.h>

#define LEVELS 8          /* of cubes */
#define MATERIALS 64u     /* that are told apart; others share their numbers */
#define MOST_CUBES 511.0f /* along an axis, of the largest ones */
#define BY_LENGTH 0.075f  /* side of a cube, in lengths of the ray */
#define MOST_BY_LENGTH 0.6f
#define ENOUGH 2   /* surfels of a cube that is not one of the largest */
#define SPARSITY 4 /* of the table: so many cells for each cube, or a search for no cube is long */

#ifdef __GNUC__
#define PREFETCH(address) __builtin_prefetch(address)
#else
#define PREFETCH(address) ((void)(address))
#endif

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
    uint32_t column = 1u - (a < -third) + (a > third), row = 1u - (b < -third) + (b > third);
    return face * 9 + row * 3 + column;
}

/* A point, in sides of the largest cubes from the table's origin (what lies out of the scene's
 * bounds counts as at its border), which way its surface faces, and the surface's material. */
struct cube_position {
    ps_vec3 point;
    uint64_t normal, material;
};

static float clamp(float along)
{
    return ps_min(ps_max(along, 0.0f), MOST_CUBES);
}

static struct cube_position cube_position_of(const struct surfels *surfels, ps_vec3 position,
                                             ps_vec3 normal, uint32_t material)
{
    ps_vec3 p = ps_scale(ps_subtract(position, surfels->origin), 1.0f / surfels->largest);
    return (struct cube_position){
        {clamp(p.x), clamp(p.y), clamp(p.z)}, normal_key(normal), material % MATERIALS};
}

/* The key of the cube of a level that holds a position moved by so many sides, more than -1. From
 * the top: 1, 16 bits for each axis, 6 for the material, 6 for the normal and 3 for the level. */
static uint64_t cell_key(const struct cube_position *position, ps_vec3 moved, uint32_t level)
{
    float scale = (float)(1u << level);
    uint32_t x = (uint32_t)(int32_t)(position->point.x * scale + moved.x);
    uint32_t y = (uint32_t)(int32_t)(position->point.y * scale + moved.y);
    uint32_t z = (uint32_t)(int32_t)(position->point.z * scale + moved.z);
    return UINT64_C(1) << 63 | (uint64_t)x << 47 | (uint64_t)y << 31 | (uint64_t)z << 15 |
           position->material << 9 | position->normal << 3 | level;
}

static uint32_t level_of_key(uint64_t key)
{
    return key & (LEVELS - 1);
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
    /* Without a branch that depends on which of the two it is. */
    while ((surfels->cells[place].key != 0) & (surfels->cells[place].key != key))
        place = (place + 1) & (surfels->capacity - 1);
    return &surfels->cells[place];
}

/* How often a number above 0 must be halved until it is at most 1; by its exponent, without a
 * branch. */
static uint32_t halvings(float number, uint32_t most)
{
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    int32_t n = (int32_t)((bits + 0x7fffff) >> 23) - 127;
    n = n < 0 ? 0 : n;
    return (uint32_t)n < most ? (uint32_t)n : most;
}

/* The level of the cubes whose side is nearest to this one, by ratio. */
static uint32_t level_of(const struct surfels *surfels, float side)
{
    return halvings(surfels->largest / (1.4142f * side), LEVELS - 1);
}

/* The smallest cubes that a surfel is put in: rays that are shorter than the one that found it are
 * few there. */
static uint32_t finest_level(const struct surfels *surfels, size_t i)
{
    return level_of(surfels, 0.5f * BY_LENGTH * surfels->lengths[i]);
}

/* --- making it --- */

/* Lists each surfel by each cube that it lies in. */
static void list_cubes(const struct surfels *surfels, ps_key_entry *entries)
{
    for (size_t i = 0; i < surfels->count; i++) {
        struct cube_position position = cube_position_of(
            surfels, surfels->positions[i], surfels->normals[i], surfels->materials[i]);
        for (uint32_t level = 0; level <= finest_level(surfels, i); level++)
            *entries++ = (ps_key_entry){cell_key(&position, (ps_vec3){0, 0, 0}, level), i};
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

/* A cube is kept if it has enough surfels, or if there is no larger one. */
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
    while (surfels->capacity < SPARSITY * kept)
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

/* --- lookups --- */

/* The search for a landing's cell, from small cubes to wide ones. */
struct query {
    struct cube_position position;
    ps_vec3 moved;          /* in sides of a cube */
    uint32_t level, widest; /* of the next cube, and of the last one */
    uint32_t path;          /* the landing's */
};

/* Those that have found none yet are `open`. */
struct queries {
    struct query all[PS_TILE_PIXELS];
    uint32_t open[PS_TILE_PIXELS];
    size_t count;
};

/* Somewhere within half a cube's side of a point, along the two axes that its surface faces
 * least. */
static ps_vec3 jitter(ps_vec3 normal, const float numbers[2])
{
    uint32_t axis = surfel_facing(normal) / 2;
    float a = numbers[0] - 0.5f, b = numbers[1] - 0.5f;
    float y = axis == 0 ? a : b;
    return (ps_vec3){axis == 0 ? 0.0f : a, axis == 1 ? 0.0f : y, axis == 2 ? 0.0f : b};
}

static void begin_queries(const struct surfels *surfels, const struct gather_landing *landings,
                          size_t n, struct queries *queries)
{
    queries->count = 0;
    for (uint32_t i = 0; i < n; i++) {
        const struct gather_landing *landing = &landings[i];
        struct query *query = &queries->all[i];
        query->position =
            cube_position_of(surfels, landing->position, landing->normal, landing->material);
        query->moved = jitter(landing->normal, landing->numbers);
        float length = surfel_length(landing->length, landing->is_focused);
        query->level = level_of(surfels, BY_LENGTH * length);
        query->widest = halvings(surfels->largest / (MOST_BY_LENGTH * landing->length), LEVELS);
        query->path = landing->path;
        queries->open[queries->count] = i;
        queries->count += query->widest <= query->level; /* or the ray is too short */
    }
}

/* Looks up one cube for each open query. Those that find none look for a wider one next, if there
 * is one. */
static void look_up(const struct surfels *surfels, struct queries *queries,
                    struct cached_irradiance *known, bool *is_known)
{
    uint64_t keys[PS_TILE_PIXELS];
    size_t left = 0;
    for (size_t k = 0; k < queries->count; k++) {
        const struct query *query = &queries->all[queries->open[k]];
        keys[k] = cell_key(&query->position, query->moved, query->level);
        PREFETCH(&surfels->cells[hash(keys[k]) & (surfels->capacity - 1)]);
    }
    for (size_t k = 0; k < queries->count; k++) {
        uint32_t i = queries->open[k];
        struct query *query = &queries->all[i];
        const struct surfel_cell *cell = cell_at(surfels, keys[k]);
        bool found = cell->key != 0;
        known[query->path] = (struct cached_irradiance){cell->indirect, cell->sky};
        is_known[query->path] = found;
        queries->open[left] = i;
        left += !found & (query->level > query->widest);
        query->level--;
    }
    queries->count = left;
}

/* Level by level for all landings together, not landing by landing: a processor then waits for
 * several cells of the table at a time. */
void surfel_table_lookup(const void *opaque, const struct gather_landing *landings, size_t n,
                         struct cached_irradiance *known, bool *is_known)
{
    const struct surfels *surfels = opaque;
    struct queries queries;
    begin_queries(surfels, landings, n, &queries);
    while (queries.count > 0)
        look_up(surfels, &queries, known, is_known);
}
