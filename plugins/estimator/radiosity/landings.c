#include "landings.h"

enum {
    PATHS = 1 << 15,
    BATCH = 256,     /* of them */
    MOST_PATHS = 16, /* in an undivided triangle */
    MOST_DIVISIONS = 10
};

/* Set of random numbers. */
enum { SET_EMISSION = 0x103 };

/* Where a light path first landed: the triangle, or ELEMENT_NONE. */
struct landing {
    uint32_t element;
    ps_vec3 place, normal;
    uint32_t object;
};

struct landings {
    struct elements *elements;
    struct landing *paths;
    ps_rgb *power; /* W, of all that started */
};

static void trace_batch(void *user, uint64_t batch, uint32_t worker)
{
    (void)worker;
    const struct landings *landings = user;
    const struct elements *elements = landings->elements;
    const ps_host *host = elements->host;
    uint64_t indices[BATCH];
    float numbers[BATCH][4];
    ps_ray rays[BATCH];
    ps_hit hits[BATCH];
    for (uint32_t i = 0; i < BATCH; i++)
        indices[i] = batch * BATCH + i;
    host->samples(host, PS_STREAM_PLUGIN, SET_EMISSION, indices, BATCH, numbers);
    host->emit_light(host, (const float(*)[4])numbers, BATCH, rays,
                     &landings->power[batch * BATCH]);
    host->intersect(host, rays, BATCH, hits);
    for (uint32_t i = 0; i < BATCH; i++) {
        struct landing *landing = &landings->paths[batch * BATCH + i];
        landing->element = ELEMENT_NONE;
        if (!(hits[i].distance < INFINITY))
            continue;
        landing->place = elements_place(elements, hits[i].position);
        landing->normal = hits[i].geometric_normal;
        landing->object = hits[i].object;
        landing->element =
            elements_find(elements, landing->place, landing->normal, landing->object, ELEMENT_NONE);
    }
}

static void find_again(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct landings *landings = user;
    struct landing *landing = &landings->paths[index];
    if (landing->element != ELEMENT_NONE &&
        elements_at(landings->elements, landing->element)->child_count > 0)
        landing->element = elements_find(landings->elements, landing->place, landing->normal,
                                         landing->object, landing->element);
}

/* Divides each triangle that more than MOST_PATHS landed in; `counts` are those of all elements,
 * 0. */
static ps_result divide_crowded(struct landings *landings, size_t *divided)
{
    struct elements *elements = landings->elements;
    const ps_host *host = elements->host;
    size_t count = elements->tree.count;
    uint32_t *counts = host->allocate(host, count * sizeof *counts, "radiosity elements");
    if (!counts)
        return PS_ERROR_MEMORY;
    memset(counts, 0, count * sizeof *counts);
    for (size_t i = 0; i < PATHS; i++)
        if (landings->paths[i].element != ELEMENT_NONE)
            counts[landings->paths[i].element]++;
    ps_result result = PS_OK;
    *divided = 0;
    for (uint32_t i = 0; result == PS_OK && i < count; i++) {
        if (counts[i] <= MOST_PATHS)
            continue;
        result = elements_divide(elements, i) ? PS_OK : PS_ERROR_MEMORY;
        ++*divided;
    }
    host->release(host, counts);
    return result;
}

/* What the lights sent out, if none of it was lost. */
static double power_of_paths(const struct landings *landings)
{
    double power = 0.0;
    for (size_t i = 0; i < PATHS; i++) {
        ps_rgb path = landings->power[i];
        if (landings->paths[i].element == ELEMENT_NONE)
            return 0.0;
        power += (double)path.r + (double)path.g + (double)path.b;
    }
    return power / PATHS;
}

static ps_result follow_paths(struct landings *landings)
{
    struct elements *elements = landings->elements;
    const ps_host *host = elements->host;
    host->parallel_for(host, PATHS / BATCH, trace_batch, landings);
    ps_result result = PS_OK;
    size_t divided = 1;
    for (int i = 0; i < MOST_DIVISIONS && divided > 0 && result == PS_OK; i++) {
        result = divide_crowded(landings, &divided);
        if (result == PS_OK)
            host->parallel_for(host, PATHS, find_again, landings);
        if (host->cancelled(host))
            return PS_CANCELLED;
    }
    return result;
}

ps_result landings_divide(struct elements *elements)
{
    const ps_host *host = elements->host;
    struct landings landings = {
        .elements = elements,
        .paths = host->allocate(host, PATHS * sizeof *landings.paths, "radiosity elements"),
        .power = host->allocate(host, PATHS * sizeof *landings.power, "radiosity elements"),
    };
    ps_result result = landings.paths && landings.power ? follow_paths(&landings) : PS_ERROR_MEMORY;
    if (result == PS_OK)
        elements->power = power_of_paths(&landings);
    host->release(host, landings.paths);
    host->release(host, landings.power);
    return result;
}
