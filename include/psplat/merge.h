/* merge.h: many photons into one, for stratifications (Hoet 2014, sections 3.2.1 and 4.2).
 *
 * The photons i of a stratum, each of power Phi_i from its own place in its own direction, become
 * one of them with the power of all. What the light does on average decides which one may stay:
 *
 *   random        Photon i with probability p_i = Y(Phi_i) / sum_j Y(Phi_j), Y the luminance. If f_i
 *                 is what a pixel gets of a unit of photon i, the mean of what it gets is
 *                 sum_i p_i f_i sum_j Phi_j, and in luminance that is sum_i f_i Y(Phi_i): what it
 *                 would get without merging. So no bias, only noise; colours mix within a stratum.
 *                 With even odds, as in the thesis, this holds only where all powers are the same.
 *   nearest_mean  The one nearest to the mean position (weighted by luminance). Less noise in where
 *                 light starts, but the middle of a stratum is served more than its rim: a bias.
 *   dominant      The one whose direction is closest to the mean direction (weighted likewise). The
 *                 directions that a surface sends light in shrink towards its normal: a large bias.
 *
 * Means themselves are no choice: a mean position may lie inside of something, and a mean direction
 * goes where no photon did (Hoet 2014, section 3.2.1).
 *
 * Photons of any bounce may merge, since light does not remember; the one that stays keeps path,
 * bounce, position, normal and direction, and its place in the array: what is left is in path order.
 */
#ifndef PSPLAT_MERGE_H
#define PSPLAT_MERGE_H

#include <psplat/cell.h>
#include <psplat/host.h>
#include <psplat/math.h>
#include <psplat/param.h>
#include <stddef.h>
#include <string.h>

enum { PS_KEEP_RANDOM = 0, PS_KEEP_NEAREST_MEAN = 1, PS_KEEP_DOMINANT = 2 };

#define PS_STREAM_MERGE (PS_STREAM_PLUGIN + 16) /* random numbers for PS_KEEP_RANDOM */

/* The rows that every stratification shares; the plugin's state holds PS_MERGE_MEMBERS. */
#define PS_MERGE_MEMBERS                                                                           \
    int32_t representative;                                                                        \
    double normal_angle;

#define PS_MERGE_CHOICES                                                                           \
    static const char *const merge_representative[] = {"random", "nearest_mean", "dominant", NULL};

#define PS_MERGE_PARAMS(state)                                                                     \
    PS_ROW(state, representative, PS_PARAM_CHOICE, "random", 0, 0, PS_PARAM_EXPERT,                \
           merge_representative, "",                                                               \
           "the photon that stays; random by power has no bias, the others have"),                 \
        PS_NUMBER(state, normal_angle, "60", 5, 180, PS_PARAM_EXPERT, "degrees",                   \
                  "largest angle between the normal of a stratum's first photon and the others; "  \
                  "180: any")

typedef struct ps_merge_settings {
    int32_t representative;
    int32_t reserved;
    double normal_angle; /* degrees */
    uint64_t per_cell;   /* how many photons stay where there are as many; 0 counts as 1 */
    uint64_t bucket;     /* how many photons may become one; 0: any number */
} ps_merge_settings;

/* The strata of a pass while they are made. Stratum i is entries[starts[i]] to entries[starts[i + 1]
 * - 1]; photons without an entry stay as they are. */
typedef struct ps_strata {
    const ps_host *host;
    const ps_pass *pass;
    ps_photon *photons;
    void *memory; /* of the three arrays */
    ps_cell_entry *entries, *spare;
    size_t *starts;
    size_t entry_count, count;
    uint64_t drawn;  /* random numbers used */
    uint64_t merged; /* photons that became part of another */
} ps_strata;

/* Room for the strata of n photons: 40 bytes a photon, whatever the number of cells. 0 where there
 * is no memory; else release it with ps_strata_release. */
static inline int ps_strata_create(ps_strata *strata, const ps_host *host, const ps_pass *pass,
                                   ps_photon *photons, size_t n)
{
    *strata = (ps_strata){.host = host, .pass = pass, .photons = photons};
    size_t each = 2 * sizeof(ps_cell_entry) + sizeof(size_t);
    if (n > SIZE_MAX / 2 / each)
        return 0;
    strata->memory = host->allocate(host, n * each + sizeof(size_t), "strata");
    if (!strata->memory)
        return 0;
    strata->entries = strata->memory;
    strata->spare = strata->entries + n;
    strata->starts = (size_t *)(strata->spare + n);
    return 1;
}

static inline void ps_strata_release(ps_strata *strata)
{
    strata->host->release(strata->host, strata->memory);
}

/* Photon `index` lies in the cell of `key`. Each photon at most once, in order. */
static inline void ps_strata_add(ps_strata *strata, size_t index, uint64_t key)
{
    strata->entries[strata->entry_count++] = (ps_cell_entry){key, index};
}

/* Sorts what was added by cell, each cell in path order; strata are empty as yet. */
static inline void ps_strata_sort(ps_strata *strata)
{
    ps_cell_entry *sorted = ps_sort_cells(strata->entries, strata->spare, strata->entry_count);
    if (sorted != strata->entries) {
        strata->spare = strata->entries;
        strata->entries = sorted;
    }
}

/* Makes the entries up to `end`, from where the last stratum ended, the next stratum. */
static inline void ps_strata_end_at(ps_strata *strata, size_t end)
{
    if (strata->count == 0)
        strata->starts[0] = 0;
    strata->starts[++strata->count] = end;
}

/* The first entry of that key or a larger one, where they are sorted; their number where there is none. */
static inline size_t ps_strata_find(const ps_strata *strata, uint64_t key)
{
    size_t low = 0, high = strata->entry_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (strata->entries[middle].key < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* The stratum that an entry lies in. */
static inline size_t ps_stratum_of(const ps_strata *strata, size_t entry)
{
    size_t low = 0, high = strata->count;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (strata->starts[middle] <= entry)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Sorts, and makes each cell that holds something a stratum. */
static inline void ps_strata_from_cells(ps_strata *strata)
{
    ps_strata_sort(strata);
    for (size_t i = 1; i <= strata->entry_count; i++)
        if (i == strata->entry_count || strata->entries[i].key != strata->entries[i - 1].key)
            ps_strata_end_at(strata, i);
}

/* Takes a photon away from the result. A negative number of photons is none that a photon can stand
 * for, so it serves as the mark. */
static inline void ps_photon_remove(ps_photon *photon)
{
    photon->merged = -1.0f;
}

/* In [0, 1), of its own for each choice of each pass. */
static inline double ps_strata_draw(ps_strata *strata)
{
    float numbers[1][4];
    uint64_t index = (uint64_t)strata->pass->number << 32 | (uint32_t)strata->drawn++;
    strata->host->samples(strata->host, PS_STREAM_MERGE, 0, &index, 1, numbers);
    return (double)numbers[0][0] + (double)numbers[0][1] * 0x1p-24;
}

static inline const ps_photon *ps_entry_photon(const ps_strata *strata, const ps_cell_entry *entry)
{
    return &strata->photons[entry->index];
}

/* Each choice is among n > 0 entries of one stratum. */
static inline size_t ps_choose_by_power(ps_strata *strata, const ps_cell_entry *entries, size_t n)
{
    double total = 0, sum = 0;
    for (size_t i = 0; i < n; i++)
        total += ps_luminance(ps_entry_photon(strata, &entries[i])->power);
    double wanted = ps_strata_draw(strata) * total;
    for (size_t i = 0; i < n; i++) {
        sum += ps_luminance(ps_entry_photon(strata, &entries[i])->power);
        if (sum > wanted)
            return i;
    }
    return 0; /* no power at all */
}

/* The mean position is taken relative to the first photon's, for precision. */
static inline size_t ps_choose_nearest_mean(const ps_strata *strata, const ps_cell_entry *entries,
                                            size_t n)
{
    ps_vec3 first = ps_entry_photon(strata, entries)->position, mean = {0, 0, 0};
    float total = 0, least = INFINITY;
    size_t nearest = 0;
    for (size_t i = 0; i < n; i++) {
        const ps_photon *photon = ps_entry_photon(strata, &entries[i]);
        float weight = ps_luminance(photon->power);
        mean = ps_add_scaled(mean, weight, ps_subtract(photon->position, first));
        total += weight;
    }
    mean = ps_add_scaled(first, total > 0.0f ? 1.0f / total : 0.0f, mean);
    for (size_t i = 0; i < n; i++) {
        ps_vec3 away = ps_subtract(ps_entry_photon(strata, &entries[i])->position, mean);
        if (ps_dot(away, away) < least) {
            least = ps_dot(away, away);
            nearest = i;
        }
    }
    return nearest;
}

static inline size_t ps_choose_dominant(const ps_strata *strata, const ps_cell_entry *entries,
                                        size_t n)
{
    ps_vec3 mean = {0, 0, 0};
    float most = -INFINITY;
    size_t closest = 0;
    for (size_t i = 0; i < n; i++) {
        const ps_photon *photon = ps_entry_photon(strata, &entries[i]);
        mean = ps_add_scaled(mean, ps_luminance(photon->power), photon->direction);
    }
    for (size_t i = 0; i < n; i++) {
        float along = ps_dot(mean, ps_entry_photon(strata, &entries[i])->direction);
        if (along > most) {
            most = along;
            closest = i;
        }
    }
    return closest;
}

static inline size_t ps_choose_representative(ps_strata *strata, int32_t rule,
                                              const ps_cell_entry *entries, size_t n)
{
    if (rule == PS_KEEP_NEAREST_MEAN)
        return ps_choose_nearest_mean(strata, entries, n);
    if (rule == PS_KEEP_DOMINANT)
        return ps_choose_dominant(strata, entries, n);
    return ps_choose_by_power(strata, entries, n);
}

/* All of the entries into one. Sums are taken in double precision and rounded once. */
static inline void ps_merge_into_one(ps_strata *strata, int32_t rule, const ps_cell_entry *entries,
                                     size_t n)
{
    if (n < 2)
        return;
    size_t chosen = ps_choose_representative(strata, rule, entries, n);
    double r = 0, g = 0, b = 0, merged = 0;
    for (size_t i = 0; i < n; i++) {
        ps_photon *photon = &strata->photons[entries[i].index];
        r += photon->power.r;
        g += photon->power.g;
        b += photon->power.b;
        merged += photon->merged;
        ps_photon_remove(photon);
    }
    ps_photon *kept = &strata->photons[entries[chosen].index];
    kept->power = (ps_rgb){(float)r, (float)g, (float)b};
    kept->merged = (float)merged;
    strata->merged += n - 1;
}

/* Deals the entries evenly, as they stand, among as many photons as the settings ask for. */
static inline void ps_merge_parts(ps_strata *strata, const ps_merge_settings *settings,
                                  const ps_cell_entry *entries, size_t n)
{
    size_t wanted = settings->per_cell > 1 ? (size_t)settings->per_cell : 1;
    size_t parts = wanted < n ? wanted : n;
    if (settings->bucket > 0 && (n - 1) / settings->bucket + 1 > parts)
        parts = (size_t)((n - 1) / settings->bucket + 1);
    size_t share = n / parts, larger = n % parts;
    for (size_t part = 0; part < parts; part++) {
        size_t count = share + (part < larger);
        ps_merge_into_one(strata, settings->representative, entries, count);
        entries += count;
    }
}

/* Moves the entries whose normal is near enough to the first one's to the front; how many they are.
 * The order is kept among both. `rest` has room for n. */
static inline size_t ps_gather_facing(const ps_strata *strata, float least_cosine,
                                      ps_cell_entry *entries, size_t n, ps_cell_entry *rest)
{
    ps_vec3 first = ps_entry_photon(strata, entries)->normal;
    size_t near = 0, far = 0;
    for (size_t i = 0; i < n; i++) {
        ps_cell_entry entry = entries[i];
        if (i == 0 || ps_dot(ps_entry_photon(strata, &entry)->normal, first) >= least_cosine)
            entries[near++] = entry;
        else
            rest[far++] = entry;
    }
    memcpy(entries + near, rest, far * sizeof *rest);
    return near;
}

/* Merges the photons of each stratum whose normals agree, removes those that are no more, and counts
 * strata and photons merged in the statistics: a stratum counts once for each group of normals. *n becomes the number
 * of photons that are left. */
static inline void ps_strata_merge(ps_strata *strata, const ps_merge_settings *settings, size_t *n)
{
    float least_cosine = settings->normal_angle < 180.0
                             ? cosf((float)settings->normal_angle * PS_PI / 180.0f)
                             : -INFINITY;
    size_t groups = 0, left = 0;
    for (size_t i = 0; i < strata->count; i++) {
        ps_cell_entry *entries = strata->entries + strata->starts[i];
        size_t count = strata->starts[i + 1] - strata->starts[i];
        for (size_t taken; count > 0; entries += taken, count -= taken, groups++) {
            taken = ps_gather_facing(strata, least_cosine, entries, count, strata->spare);
            ps_merge_parts(strata, settings, entries, taken);
        }
    }
    for (size_t i = 0; i < *n; i++)
        if (strata->photons[i].merged >= 0.0f)
            strata->photons[left++] = strata->photons[i];
    strata->host->count(strata->host, "strata", (double)groups);
    strata->host->count(strata->host, "photons merged", (double)strata->merged);
    *n = left;
}

#endif
