#include "stratify/merge.h"

#include <assert.h>
#include <psplat/math.h>
#include <stdbool.h>
#include <string.h>

struct merging {
    const struct merge_params *params;
    const ps_host *host;
    const ps_pass *pass;
    const ps_strata *strata;
    ps_photon *photons;
    uint64_t drawn;  /* random numbers used */
    uint64_t merged; /* photons that became part of another */
};

/* Takes a photon away from the result: no photon stands for none. */
static void mark_removed(ps_photon *photon)
{
    photon->merged = 0.0f;
}

static const ps_photon *photon_of(const struct merging *merging, const ps_key_entry *entry)
{
    return &merging->photons[entry->index];
}

/* In [0, 1), of its own for each choice of each pass. */
static double draw(struct merging *merging)
{
    float numbers[1][4];
    uint64_t index = (uint64_t)merging->pass->number << 32 | (uint32_t)merging->drawn++;
    merging->host->samples(merging->host, PS_STREAM_MERGE, 0, &index, 1, numbers);
    return (double)numbers[0][0] + (double)numbers[0][1] * 0x1p-24;
}

/* Each choice is among n > 0 entries of one stratum. */
static size_t choose_by_power(struct merging *merging, const ps_key_entry *entries, size_t n)
{
    double total = 0, sum = 0;
    for (size_t i = 0; i < n; i++)
        total += ps_luminance(photon_of(merging, &entries[i])->power);
    double wanted = draw(merging) * total;
    for (size_t i = 0; i < n; i++) {
        sum += ps_luminance(photon_of(merging, &entries[i])->power);
        if (sum > wanted)
            return i;
    }
    return 0; /* no power at all */
}

/* The mean position is taken relative to the first photon's, for precision. */
static size_t choose_nearest_mean(const struct merging *merging, const ps_key_entry *entries,
                                  size_t n)
{
    ps_vec3 first = photon_of(merging, entries)->position, mean = {0, 0, 0};
    float total = 0, least = INFINITY;
    size_t nearest = 0;
    for (size_t i = 0; i < n; i++) {
        const ps_photon *photon = photon_of(merging, &entries[i]);
        float weight = ps_luminance(photon->power);
        mean = ps_add_scaled(mean, weight, ps_subtract(photon->position, first));
        total += weight;
    }
    mean = ps_add_scaled(first, total > 0.0f ? 1.0f / total : 0.0f, mean);
    for (size_t i = 0; i < n; i++) {
        ps_vec3 away = ps_subtract(photon_of(merging, &entries[i])->position, mean);
        if (ps_dot(away, away) < least) {
            least = ps_dot(away, away);
            nearest = i;
        }
    }
    return nearest;
}

static size_t choose_dominant(const struct merging *merging, const ps_key_entry *entries, size_t n)
{
    ps_vec3 mean = {0, 0, 0};
    float most = -INFINITY;
    size_t closest = 0;
    for (size_t i = 0; i < n; i++) {
        const ps_photon *photon = photon_of(merging, &entries[i]);
        mean = ps_add_scaled(mean, ps_luminance(photon->power), photon->direction);
    }
    for (size_t i = 0; i < n; i++) {
        float along = ps_dot(mean, photon_of(merging, &entries[i])->direction);
        if (along > most) {
            most = along;
            closest = i;
        }
    }
    return closest;
}

static size_t choose(struct merging *merging, const ps_key_entry *entries, size_t n)
{
    if (merging->params->representative == KEEP_NEAREST_MEAN)
        return choose_nearest_mean(merging, entries, n);
    if (merging->params->representative == KEEP_DOMINANT)
        return choose_dominant(merging, entries, n);
    return choose_by_power(merging, entries, n);
}

/* All of the entries into one. Sums are taken in double precision and rounded once. */
static void merge_into_one(struct merging *merging, const ps_key_entry *entries, size_t n)
{
    if (n < 2)
        return;
    size_t chosen = choose(merging, entries, n);
    double r = 0, g = 0, b = 0, merged = 0;
    for (size_t i = 0; i < n; i++) {
        ps_photon *photon = &merging->photons[entries[i].index];
        r += photon->power.r;
        g += photon->power.g;
        b += photon->power.b;
        merged += photon->merged;
        mark_removed(photon);
    }
    ps_photon *kept = &merging->photons[entries[chosen].index];
    kept->power = (ps_rgb){(float)r, (float)g, (float)b};
    kept->merged = (float)merged;
    merging->merged += n - 1;
}

/* Deals the entries evenly, as they stand, among as many photons as the strata ask for. */
static void merge_parts(struct merging *merging, const ps_key_entry *entries, size_t n)
{
    assert(n > 0);
    uint64_t most = merging->strata->most, wanted = merging->strata->per_stratum;
    size_t parts = wanted > 1 ? (size_t)wanted : 1;
    parts = parts < n ? parts : n;
    if (most > 0 && (n - 1) / most + 1 > parts)
        parts = (size_t)((n - 1) / most + 1);
    size_t share = n / parts, larger = n % parts;
    for (size_t part = 0; part < parts; part++) {
        size_t count = share + (part < larger);
        merge_into_one(merging, entries, count);
        entries += count;
    }
}

/* Moves the entries whose normal is near enough to the first one's to the front; how many they are.
 * The order is kept among both. `rest` has room for n. */
static size_t gather_facing(const struct merging *merging, float least_cosine,
                            ps_key_entry *entries, size_t n, ps_key_entry *rest)
{
    ps_vec3 first = photon_of(merging, entries)->normal;
    size_t near = 0, far = 0;
    for (size_t i = 0; i < n; i++) {
        ps_key_entry entry = entries[i];
        if (i == 0 || ps_dot(photon_of(merging, &entry)->normal, first) >= least_cosine)
            entries[near++] = entry;
        else
            rest[far++] = entry;
    }
    memcpy(entries + near, rest, far * sizeof *rest);
    return near;
}

static size_t keep_rest(ps_photon *photons, size_t n)
{
    size_t left = 0;
    for (size_t i = 0; i < n; i++)
        if (photons[i].merged > 0.0f)
            photons[left++] = photons[i];
    return left;
}

size_t merge(const struct merge_params *params, const ps_host *host, const ps_pass *pass,
             const ps_strata *strata, ps_photon *photons, size_t n)
{
    struct merging merging = {params, host, pass, strata, photons, 0, 0};
    float least_cosine = params->normal_angle < 180.0
                             ? cosf((float)params->normal_angle * PS_PI / 180.0f)
                             : -INFINITY;
    size_t groups = 0;
    for (size_t i = 0; i < strata->count; i++) {
        ps_key_entry *entries = strata->entries + strata->starts[i];
        size_t count = strata->starts[i + 1] - strata->starts[i];
        for (size_t taken; count > 0; entries += taken, count -= taken, groups++) {
            taken = gather_facing(&merging, least_cosine, entries, count, strata->spare);
            merge_parts(&merging, entries, taken);
        }
    }
    host->count(host, "strata", (double)groups);
    host->count(host, "photons merged", (double)merging.merged);
    return keep_rest(photons, n);
}
