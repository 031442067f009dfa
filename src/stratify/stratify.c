#include "stratify/stratify.h"

#include "stratify/merge.h"

/* Room for the strata of n photons, in one piece of memory: 40 bytes each, whatever the strata.
 * NULL: there is none. */
static void *create_strata(const ps_host *host, size_t n, ps_strata *strata)
{
    size_t each = 2 * sizeof(ps_key_entry) + sizeof(size_t);
    void *memory =
        n <= SIZE_MAX / 2 / each ? host->allocate(host, n * each + sizeof(size_t), "strata") : NULL;
    ps_key_entry *entries = memory;
    if (!memory)
        return NULL;
    *strata = (ps_strata){
        .size = sizeof *strata,
        .entries = entries,
        .spare = entries + n,
        .starts = (size_t *)(entries + 2 * n),
    };
    strata->starts[0] = 0;
    return memory;
}

/* A plugin's mistake must not become a read past the end. */
static bool are_whole(const ps_strata *strata, const void *memory, size_t n)
{
    const ps_key_entry *first = memory;
    bool whole = strata->entry_count <= n && strata->count <= n &&
                 ((strata->entries == first && strata->spare == first + n) ||
                  (strata->entries == first + n && strata->spare == first));
    for (size_t i = 0; whole && i < strata->entry_count; i++)
        whole = strata->entries[i].index < n;
    for (size_t i = 0; whole && i < strata->count; i++)
        whole = strata->starts[i] <= strata->starts[i + 1] &&
                strata->starts[i + 1] <= strata->entry_count;
    return whole;
}

static ps_result make_strata(const struct strategy *strategy, const ps_host *host,
                             const ps_pass *pass, ps_photon *photons, size_t n, ps_strata *strata)
{
    const void *memory = strata->entries;
    ps_result result = strategy->type->table.stratification.stratify(strategy->state, host, pass,
                                                                     photons, n, strata);
    if (result == PS_OK && !are_whole(strata, memory, n))
        return host->fail(host, PS_ERROR_INVALID, "it made strata of photons that are not there");
    return result;
}

ps_result stratify(const struct strategy *strategy, const ps_host *host, const ps_pass *pass,
                   ps_photon *photons, size_t *n)
{
    ps_strata strata;
    if (!strategy->type->table.stratification.stratify)
        return PS_OK;
    void *memory = create_strata(host, *n, &strata);
    if (!memory)
        return PS_ERROR_MEMORY;
    ps_result result = make_strata(strategy, host, pass, photons, *n, &strata);
    if (result == PS_OK)
        *n = merge(strategy_shared(strategy), host, pass, &strata, photons, *n);
    host->release(host, memory);
    return result;
}

ps_result stratify_numbers(const struct strategy *strategy, const ps_host *host,
                           const ps_pass *pass, ps_photon *photons, size_t n, const ps_vec3 *points,
                           size_t count, uint64_t *numbers)
{
    ps_strata strata;
    void *memory = create_strata(host, n, &strata);
    if (!memory)
        return PS_ERROR_MEMORY;
    ps_result result = make_strata(strategy, host, pass, photons, n, &strata);
    if (result == PS_OK)
        result = strategy->type->table.stratification.find_strata(strategy->state, host, &strata,
                                                                  points, count, numbers);
    host->release(host, memory);
    return result;
}
