#include "cache.h"

#include <stdlib.h>
#include <string.h>

#define LEAF 4             /* records, at most */
#define CANCEL_EVERY 1024u /* records */

/* Nodes are in depth-first order: that after a box which does not hold the point is `skip`. */
struct cache_node {
    ps_vec3 low, high;
    uint32_t first, count; /* of a leaf's records in `order`; count is 0 in inner nodes */
    uint32_t skip;
};

void cache_begin(const ps_host *host, struct irradiance_cache *cache)
{
    *cache = (struct irradiance_cache){.host = host};
}

static void release_tree(struct irradiance_cache *cache)
{
    cache->host->release(cache->host, cache->order);
    cache->host->release(cache->host, cache->nodes);
    cache->order = NULL;
    cache->nodes = NULL;
    cache->node_count = 0;
}

void cache_release(struct irradiance_cache *cache)
{
    release_tree(cache);
    cache->host->release(cache->host, cache->records);
    cache_begin(cache->host, cache);
}

struct record *cache_add(struct irradiance_cache *cache, size_t n)
{
    if (cache->count + n > cache->room) {
        size_t room = 2 * (cache->count + n);
        struct record *records =
            cache->host->allocate(cache->host, room * sizeof *records, "irradiance cache");
        if (!records)
            return NULL;
        if (cache->count > 0)
            memcpy(records, cache->records, cache->count * sizeof *records);
        cache->host->release(cache->host, cache->records);
        cache->records = records;
        cache->room = room;
    }
    cache->count += n;
    return &cache->records[cache->count - n];
}

/* --- the tree --- */

struct sort_entry {
    float key;
    uint32_t record;
};

struct builder {
    struct irradiance_cache *cache;
    struct sort_entry *entries;
};

static int compare_entries(const void *a, const void *b)
{
    const struct sort_entry *x = a, *y = b;
    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    return x->record < y->record ? -1 : x->record > y->record;
}

static float component(ps_vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static void enclose(ps_vec3 point, ps_vec3 *low, ps_vec3 *high)
{
    *low = (ps_vec3){ps_min(low->x, point.x), ps_min(low->y, point.y), ps_min(low->z, point.z)};
    *high = (ps_vec3){ps_max(high->x, point.x), ps_max(high->y, point.y), ps_max(high->z, point.z)};
}

/* The box around all points that a record reaches. */
static void enclose_record(const struct record *record, ps_vec3 *low, ps_vec3 *high)
{
    float half[3];
    for (int i = 0; i < 3; i++) {
        float u = record->radii[0] * component(record->axes[0], i);
        float v = record->radii[1] * component(record->axes[1], i);
        float w = record_thickness(record) * component(record->normal, i);
        half[i] = CACHE_REACH * sqrtf(u * u + v * v + w * w);
    }
    const ps_vec3 extent = {half[0], half[1], half[2]};
    enclose(ps_subtract(record->position, extent), low, high);
    enclose(ps_add(record->position, extent), low, high);
}

static void split(const struct builder *builder, uint32_t first, uint32_t count)
{
    const struct record *records = builder->cache->records;
    struct sort_entry *entries = builder->entries + first;
    ps_vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < count; i++)
        enclose(records[entries[i].record].position, &low, &high);
    ps_vec3 size = ps_subtract(high, low);
    int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    for (uint32_t i = 0; i < count; i++)
        entries[i].key = component(records[entries[i].record].position, axis);
    qsort(entries, count, sizeof *entries, compare_entries);
}

static void build_node(const struct builder *builder, uint32_t first, uint32_t count)
{
    struct irradiance_cache *cache = builder->cache;
    struct cache_node *node = &cache->nodes[cache->node_count++];
    *node = (struct cache_node){.low = {INFINITY, INFINITY, INFINITY},
                                .high = {-INFINITY, -INFINITY, -INFINITY},
                                .first = first};
    for (uint32_t i = 0; i < count; i++)
        enclose_record(&cache->records[builder->entries[first + i].record], &node->low,
                       &node->high);
    if (count <= LEAF) {
        node->count = count;
    } else {
        split(builder, first, count);
        build_node(builder, first, count / 2);
        build_node(builder, first + count / 2, count - count / 2);
    }
    node->skip = (uint32_t)cache->node_count;
}

static ps_result build_tree(struct irradiance_cache *cache)
{
    const ps_host *host = cache->host;
    size_t count = cache->count;
    release_tree(cache);
    struct builder builder = {
        cache, host->allocate(host, count * sizeof *builder.entries, "irradiance cache")};
    cache->order = host->allocate(host, count * sizeof *cache->order, "irradiance cache");
    cache->nodes = host->allocate(host, 2 * count * sizeof *cache->nodes, "irradiance cache");
    ps_result result = builder.entries && cache->order && cache->nodes ? PS_OK : PS_ERROR_MEMORY;
    for (uint32_t i = 0; result == PS_OK && i < count; i++)
        builder.entries[i].record = i;
    if (result == PS_OK)
        build_node(&builder, 0, (uint32_t)count);
    for (size_t i = 0; result == PS_OK && i < count; i++)
        cache->order[i] = builder.entries[i].record;
    host->release(host, builder.entries);
    return result;
}

/* Where a walk through the tree has got to. */
struct place {
    size_t node;
    uint32_t record; /* of the leaf */
};

static bool holds(const struct cache_node *node, ps_vec3 point)
{
    return point.x >= node->low.x && point.x <= node->high.x && point.y >= node->low.y &&
           point.y <= node->high.y && point.z >= node->low.z && point.z <= node->high.z;
}

/* The next record, in the tree's order, of the leaves whose box holds a point; NULL when there is
 * none. */
static struct record *next_record(const struct irradiance_cache *cache, ps_vec3 point,
                                  struct place *place)
{
    while (place->node < cache->node_count) {
        const struct cache_node *node = &cache->nodes[place->node];
        if (place->record < node->count && (place->record > 0 || holds(node, point)))
            return &cache->records[cache->order[node->first + place->record++]];
        bool enters = node->count == 0 && holds(node, point);
        place->node = enters ? place->node + 1 : node->skip;
        place->record = 0;
    }
    return NULL;
}

/* --- neighbours --- */

static float radius_along(const struct record *record, ps_vec3 direction)
{
    float u = ps_dot(direction, record->axes[0]) / record->radii[0];
    float v = ps_dot(direction, record->axes[1]) / record->radii[1];
    float w = ps_dot(direction, record->normal) / record_thickness(record);
    return 1.0f / sqrtf(u * u + v * v + w * w);
}

/* `record` may reach no farther along its axes than a neighbour and the way to it do. */
static void clamp_by(const struct record *neighbour, struct record *record)
{
    float way = ps_length(ps_subtract(record->position, neighbour->position));
    for (int i = 0; i < 2; i++)
        record->radii[i] = ps_min(record->radii[i], radius_along(neighbour, record->axes[i]) + way);
}

ps_result cache_update(struct irradiance_cache *cache, size_t n)
{
    ps_result result = build_tree(cache);
    for (size_t i = cache->count - n; result == PS_OK && i < cache->count; i++) {
        if (i % CANCEL_EVERY == 0 && cache->host->cancelled(cache->host))
            return PS_CANCELLED;
        struct record *record = &cache->records[i], *other;
        struct place place = {0, 0};
        while ((other = next_record(cache, record->position, &place)) != NULL) {
            if (!(record_distance(other, record->position, record->normal) < 1.0f))
                continue;
            clamp_by(other, record);
            clamp_by(record, other);
        }
    }
    return result;
}

/* --- use --- */

bool cache_covers(const struct irradiance_cache *cache, ps_vec3 position, ps_vec3 normal)
{
    struct place place = {0, 0};
    const struct record *record;
    while ((record = next_record(cache, position, &place)) != NULL)
        if (record_distance(record, position, normal) < 1.0f)
            return true;
    return false;
}

bool cache_interpolate(const struct irradiance_cache *cache, ps_vec3 position, ps_vec3 normal,
                       ps_rgb *irradiance)
{
    struct place place = {0, 0};
    const struct record *record, *nearest = NULL;
    ps_rgb sum = {0, 0, 0};
    float weights = 0.0f, least = INFINITY;
    while ((record = next_record(cache, position, &place)) != NULL) {
        float distance = record_distance(record, position, normal) / (CACHE_REACH * CACHE_REACH);
        if (distance < least) {
            least = distance;
            nearest = record;
        }
        if (!(distance < 1.0f))
            continue;
        float weight = (1.0f - distance) * (1.0f - distance);
        sum = ps_rgb_add(sum, ps_rgb_scale(record_extrapolate(record, position, normal), weight));
        weights += weight;
    }
    if (weights > 0.0f)
        *irradiance = ps_rgb_scale(sum, 1.0f / weights);
    else if (nearest)
        *irradiance = nearest->irradiance;
    return nearest != NULL;
}
