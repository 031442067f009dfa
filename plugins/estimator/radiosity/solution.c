#include "solution.h"

#include "lighting.h"

enum {
    CHUNK = 256,   /* elements of an item of a loop */
    SCALINGS = 24, /* rounds in which the sums of form factors are brought to 1 */
    MOST_ROUNDS = 1000
};

#define COARSER 16.0 /* epsilon of the first solution, by which the second one finds what is dim */
#define SMALL_CHANGE 1e-5 /* of the flux, from which round on no more follow */

struct solving {
    struct solution *solution;
    const ps_host *host;
    ps_rgb *sent;     /* of each element: what it sends out over its links, scaled */
    ps_rgb *gathered; /* what arrives over its links, and then over those of its ancestors too */
    float *scale;     /* s, of elements without children */
};

static bool has_surface(const struct element *element)
{
    return !element_is_cluster(element) && element->child_count == 0;
}

/* --- one exchange of light --- */

static void pull(const struct solving *work, ps_rgb *values)
{
    const struct elements *elements = &work->solution->elements;
    for (size_t i = elements->tree.count; i-- > 0;) {
        const struct element *whole = elements_at(elements, i);
        if (whole->child_count == 0)
            continue;
        ps_rgb sum = {0, 0, 0};
        for (uint32_t k = 0; k < whole->child_count; k++) {
            float share = elements_at(elements, whole->child + k)->area / whole->area;
            sum = ps_rgb_add(sum, ps_rgb_scale(values[whole->child + k], share));
        }
        values[i] = sum;
    }
}

static void gather_chunk(void *user, uint64_t chunk, uint32_t worker)
{
    (void)worker;
    const struct solving *work = user;
    const struct links *links = &work->solution->links;
    size_t count = work->solution->elements.tree.count, end = (chunk + 1) * CHUNK;
    for (size_t i = chunk * CHUNK; i < end && i < count; i++) {
        ps_rgb sum = {0, 0, 0};
        for (uint64_t k = links->starts[i]; k < links->starts[i + 1]; k++) {
            struct link link = links->list[k];
            sum = ps_rgb_add(sum, ps_rgb_scale(work->sent[link.source], link.form_factor));
        }
        work->gathered[i] = sum;
    }
}

/* From `sent`, of elements without children, to `gathered`; both scaled. */
static void exchange_light(const struct solving *work)
{
    const struct elements *elements = &work->solution->elements;
    size_t count = elements->tree.count;
    for (size_t i = 0; i < count; i++)
        if (has_surface(elements_at(elements, i)))
            work->sent[i] = ps_rgb_scale(work->sent[i], work->scale[i]);
    pull(work, work->sent);
    work->host->parallel_for(work->host, (count + CHUNK - 1) / CHUNK, gather_chunk, (void *)work);
    for (size_t i = 1; i < count; i++) {
        uint32_t parent = elements_at(elements, i)->parent;
        work->gathered[i] = ps_rgb_add(work->gathered[i], work->gathered[parent]);
    }
    for (size_t i = 0; i < count; i++)
        if (has_surface(elements_at(elements, i)))
            work->gathered[i] = ps_rgb_scale(work->gathered[i], work->scale[i]);
}

/* --- the sums of form factors --- */

/* Elements that see out keep their sums; `targets` are the sums to be. */
static void find_targets(const struct solving *work, float *targets)
{
    const struct elements *elements = &work->solution->elements;
    for (size_t i = 0; i < elements->tree.count; i++) {
        const struct element *element = elements_at(elements, i);
        float sum = work->gathered[i].r;
        targets[i] = element->enclosed && sum > 0.0f ? 1.0f : sum;
    }
}

/* s_i (F s)_i = target_i: each round takes the geometric mean of s and what would give the
 * target. */
static ps_result balance(const struct solving *work)
{
    const struct elements *elements = &work->solution->elements;
    const ps_host *host = work->host;
    size_t count = elements->tree.count;
    float *targets = host->allocate(host, count * sizeof *targets, "radiosity");
    if (!targets)
        return PS_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++)
        work->scale[i] = 1.0f;
    for (int round = 0; round < SCALINGS && !host->cancelled(host); round++) {
        for (size_t i = 0; i < count; i++)
            work->sent[i] = (ps_rgb){1, 1, 1};
        exchange_light(work);
        if (round == 0)
            find_targets(work, targets);
        for (size_t i = 0; i < count; i++)
            if (work->gathered[i].r > 0.0f && targets[i] > 0.0f)
                work->scale[i] *= sqrtf(targets[i] / work->gathered[i].r);
    }
    host->release(host, targets);
    return host->cancelled(host) ? PS_CANCELLED : PS_OK;
}

/* --- bounces --- */

static double flux_of(const struct elements *elements, size_t i, ps_rgb irradiance)
{
    double unit = (double)elements->unit, area = (double)elements_at(elements, i)->area;
    return ((double)irradiance.r + (double)irradiance.g + (double)irradiance.b) * area * unit *
           unit;
}

/* One more bounce; returns the change of the flux that leaves, in parts of it. */
static double bounce(const struct solving *work)
{
    struct solution *solution = work->solution;
    const struct elements *elements = &solution->elements;
    size_t count = elements->tree.count;
    double change = 0.0, whole = 0.0;
    memcpy(work->sent, solution->radiosity, count * sizeof *work->sent);
    exchange_light(work);
    for (size_t i = 0; i < count; i++) {
        const struct element *element = elements_at(elements, i);
        if (!has_surface(element))
            continue;
        ps_rgb leaves =
            ps_rgb_add(element->reflected, ps_rgb_multiply(element->albedo, work->gathered[i]));
        change += fabs(flux_of(elements, i, leaves) - flux_of(elements, i, solution->radiosity[i]));
        whole += flux_of(elements, i, leaves);
        solution->radiosity[i] = leaves;
    }
    return whole > 0.0 ? change / whole : 0.0;
}

/* As many bounces as are asked for, less the last one: that is the picture's own. */
static ps_result bounce_all(const struct solving *work, uint32_t bounces)
{
    struct solution *solution = work->solution;
    const struct elements *elements = &solution->elements;
    for (size_t i = 0; i < elements->tree.count; i++)
        solution->radiosity[i] = elements_at(elements, i)->reflected;
    solution->converged = false;
    solution->rounds = 0;
    while (!solution->converged && solution->rounds < MOST_ROUNDS) {
        solution->converged = solution->rounds + 1 >= bounces;
        if (!solution->converged)
            solution->converged = bounce(work) < SMALL_CHANGE;
        solution->rounds++;
        if (work->host->cancelled(work->host))
            return PS_CANCELLED;
    }
    memcpy(work->sent, solution->radiosity, elements->tree.count * sizeof *work->sent);
    exchange_light(work);
    memcpy(solution->indirect, work->gathered, elements->tree.count * sizeof *work->gathered);
    pull(work, solution->radiosity);
    return PS_OK;
}

static void measure_balance(struct solution *solution)
{
    const struct elements *elements = &solution->elements;
    for (size_t i = 0; i < elements->tree.count; i++) {
        const struct element *element = elements_at(elements, i);
        if (!has_surface(element))
            continue;
        ps_rgb indirect = solution->indirect[i];
        ps_rgb reflected =
            ps_rgb_add(element->reflected, ps_rgb_multiply(element->albedo, indirect));
        double arrives = flux_of(elements, i, ps_rgb_add(element->direct, indirect));
        solution->arrived += flux_of(elements, i, element->direct);
        solution->absorbed += arrives - flux_of(elements, i, reflected);
        solution->escaped +=
            flux_of(elements, i, solution->radiosity[i]) - flux_of(elements, i, indirect);
    }
}

/* As long as nothing is known of indirect light, an even estimate takes its place, as Cohen et al.
 * 1988 add to pictures of unfinished solutions. */
static void guess_ambient(struct elements *elements, uint32_t bounces)
{
    const struct element *scene = elements_at(elements, 0);
    float reflected = ps_rgb_maximum(scene->reflected), albedo = ps_rgb_maximum(scene->albedo);
    float ambient = bounces > 1 ? reflected / ps_max(1.0f - albedo, 0.1f) : reflected;
    for (size_t i = 0; i < elements->tree.count; i++)
        elements_at(elements, i)->ambient = ambient;
}

static void learn_ambient(struct solution *solution)
{
    struct elements *elements = &solution->elements;
    for (size_t i = elements->tree.count; i-- > 0;) {
        struct element *element = elements_at(elements, i);
        if (element->child_count == 0)
            element->ambient = ps_rgb_maximum(solution->indirect[i]);
        else
            element->ambient = 0.0f;
        for (uint32_t k = 0; k < element->child_count; k++) {
            const struct element *child = elements_at(elements, element->child + k);
            element->ambient += child->ambient * (child->area / element->area);
        }
    }
}

static void release_light(struct solution *solution)
{
    const ps_host *host = solution->elements.host;
    host->release(host, solution->radiosity);
    host->release(host, solution->indirect);
    solution->radiosity = solution->indirect = NULL;
    links_release(&solution->links);
}

/* Links the elements, and lets light go between them. */
static ps_result solve(struct solution *solution, const struct links_setting *setting,
                       uint32_t bounces)
{
    const ps_host *host = solution->elements.host;
    ps_result result = links_create(&solution->elements, setting, &solution->links);
    if (result != PS_OK)
        return result;
    lighting_finish(&solution->elements);
    size_t count = solution->elements.tree.count;
    struct solving work = {
        .solution = solution,
        .host = host,
        .sent = host->allocate(host, count * sizeof(ps_rgb), "radiosity"),
        .gathered = host->allocate(host, count * sizeof(ps_rgb), "radiosity"),
        .scale = host->allocate(host, count * sizeof(float), "radiosity"),
    };
    solution->radiosity = host->allocate(host, count * sizeof(ps_rgb), "radiosity");
    solution->indirect = host->allocate(host, count * sizeof(ps_rgb), "radiosity");
    bool good =
        work.sent && work.gathered && work.scale && solution->radiosity && solution->indirect;
    result = good ? balance(&work) : PS_ERROR_MEMORY;
    if (result == PS_OK)
        result = bounce_all(&work, bounces);
    host->release(host, work.sent);
    host->release(host, work.gathered);
    host->release(host, work.scale);
    return result;
}

ps_result solution_create(const ps_host *host, const ps_pass *pass,
                          const struct links_setting *setting, double share,
                          struct solution *solution)
{
    *solution = (struct solution){.links = {.host = NULL}};
    struct elements *elements = &solution->elements;
    struct links_setting coarse = *setting;
    coarse.epsilon *= COARSER;
    ps_result result = elements_create(host, pass, elements);
    if (result != PS_OK || elements->side_count == 0)
        return result;
    result = lighting_begin(elements, setting->epsilon);
    if (result != PS_OK)
        return result;
    guess_ambient(elements, pass->bounces);
    host->progress_part(host, 0.0, 0.25 * share);
    result = solve(solution, &coarse, pass->bounces);
    if (result != PS_OK)
        return result;
    learn_ambient(solution);
    release_light(solution);
    host->progress_part(host, 0.25 * share, share);
    result = solve(solution, setting, pass->bounces);
    if (result == PS_OK)
        measure_balance(solution);
    return result;
}

void solution_release(struct solution *solution)
{
    if (!solution->elements.host)
        return;
    release_light(solution);
    elements_release(&solution->elements);
    *solution = (struct solution){.radiosity = NULL};
}
