#include "local_pass.h"

#include "form_factor.h"
#include "spherical_triangle.h"

enum { RAYS = 64 };

/* Set of random numbers. */
enum { SET_RAYS = 0x200 };

#define MOST_UNEVEN                                                                                \
    0.25f /* difference within an element, in parts of its light, that is overlooked */
#define FAR_SQUARED 36.0f /* square of a distance, in radii, from which on a triangle is small */
#define LEAST_FACING 0.1f /* of clusters: none is sure to look away */
#define NEAREST 0.02f /* distance in radii of an element, below which its points grow no brighter */
#define LEAST_ANGLE 0.01f /* solid angle, below which points are even over the area */

/* An element that may light a pixel, partly in shadow. */
struct candidate {
    uint32_t source;
    float form_factor; /* without shadows; of clusters about */
    float sum;         /* of the light of this one and those before it */
};

struct work {
    const struct solution *solution;
    const struct local_setting *setting;
    const ps_host *host;
    struct candidate *candidates; /* `most` of each worker */
    size_t most;
    ps_ray *rays; /* PS_TILE_PIXELS of each worker, and their hits */
    ps_hit *hits;
};

/* A pixel's point. */
struct receiver {
    ps_vec3 place, normal;
    ps_vec3 position, surface_normal; /* where rays leave from */
    uint32_t tile, lane;
};

/* --- what an element gives to a point --- */

static bool is_far(const struct receiver *receiver, const struct element *source)
{
    ps_vec3 way = ps_subtract(source->centre, receiver->place);
    return ps_dot(way, way) > FAR_SQUARED * source->radius * source->radius;
}

static float triangle_form_factor(const struct receiver *receiver, const struct element *source)
{
    if (is_far(receiver, source))
        return form_factor_small(receiver->normal, ps_subtract(source->centre, receiver->place),
                                 source->normal, source->area);
    return form_factor_triangle(receiver->place, receiver->normal, source->corners);
}

/* Not below 0 where some of it may be lit. */
static float cluster_form_factor(const struct receiver *receiver, const struct element *source)
{
    ps_vec3 way = ps_subtract(source->centre, receiver->place);
    float square = ps_dot(way, way), distance = sqrtf(square);
    float height = ps_dot(receiver->normal, way) + source->radius;
    float facing =
        source->cone > 0.0f ? -ps_dot(source->normal, way) / ps_max(distance, 1e-30f) : 0.5f;
    if (!(height > 0.0f))
        return 0.0f;
    float cosine = ps_min(1.0f, height / ps_max(distance, source->radius));
    square = ps_max(square, source->radius * source->radius);
    return ps_min(1.0f, cosine * ps_max(facing, LEAST_FACING) * source->area / (PS_PI * square));
}

/* --- shadows --- */

/* A point of a candidate: the triangle, undivided, that it lies on, and the candidate's form factor
 * by it alone. */
struct target {
    uint32_t triangle;
    ps_vec3 place;
    float form_factor;
};

/* Even over the candidate's area. */
static struct target aim_by_area(const struct work *work, const struct receiver *receiver,
                                 uint32_t source, const float numbers[2])
{
    const struct elements *elements = &work->solution->elements;
    const struct element *whole = elements_at(elements, source);
    float weights[2];
    struct target target = {.triangle = elements_sample(elements, source, numbers, weights)};
    const struct element *at = elements_at(elements, target.triangle);
    target.place = element_point(at, weights);
    ps_vec3 way = ps_subtract(target.place, receiver->place);
    float square = ps_dot(way, way), least = NEAREST * whole->radius;
    target.form_factor = form_factor_small(receiver->normal, way, at->normal, whole->area);
    if (square < least * least)
        target.form_factor *= square / (least * least);
    return target;
}

/* Even over the solid angle of a triangle, for those that are near. */
static struct target aim_by_angle(const struct work *work, const struct receiver *receiver,
                                  uint32_t source, const struct spherical_triangle *seen,
                                  const float numbers[2])
{
    const struct elements *elements = &work->solution->elements;
    const struct element *whole = elements_at(elements, source);
    ps_vec3 direction = spherical_triangle_sample(seen, numbers);
    float height = ps_dot(whole->normal, ps_subtract(whole->centre, receiver->place));
    float distance = height / ps_dot(whole->normal, direction);
    struct target target = {.triangle = source};
    if (!(distance > 0.0f && distance < INFINITY))
        return target;
    target.place = ps_add_scaled(receiver->place, distance, direction);
    target.triangle = elements_part(elements, source, target.place);
    target.form_factor =
        seen->solid_angle * ps_max(0.0f, ps_dot(receiver->normal, direction)) / PS_PI;
    return target;
}

static struct target aim(const struct work *work, const struct receiver *receiver, uint32_t source,
                         const float numbers[2])
{
    const struct element *whole = elements_at(&work->solution->elements, source);
    if (!element_is_cluster(whole) && !is_far(receiver, whole)) {
        ps_vec3 corners[3];
        for (int i = 0; i < 3; i++)
            corners[i] = ps_subtract(whole->corners[i], receiver->place);
        struct spherical_triangle seen = spherical_triangle(corners);
        if (seen.solid_angle > LEAST_ANGLE)
            return aim_by_angle(work, receiver, source, &seen, numbers);
    }
    return aim_by_area(work, receiver, source, numbers);
}

static size_t choose(const struct candidate *candidates, size_t count, float sum)
{
    size_t low = 0, high = count - 1;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (candidates[middle].sum > sum)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/* Of candidates, of which some are drawn; the first of the samples of this pixel, and how many of
 * them. */
static ps_rgb light_of_batch(const struct work *work, const struct receiver *receiver,
                             const struct candidate *candidates, size_t count, uint64_t first,
                             size_t n)
{
    const ps_host *host = work->host;
    const struct elements *elements = &work->solution->elements;
    float offset = elements->offset * elements->unit, all = candidates[count - 1].sum;
    uint64_t indices[RAYS];
    float numbers[RAYS][4];
    ps_ray rays[RAYS];
    ps_rgb light[RAYS], sum = {0, 0, 0};
    uint8_t blocked[RAYS];
    ps_vec3 start = ps_add_scaled(receiver->position, offset, receiver->surface_normal);
    for (size_t i = 0; i < n; i++)
        indices[i] = first + i;
    host->samples(host, PS_STREAM_PLUGIN, SET_RAYS, indices, n, numbers);
    for (size_t i = 0; i < n; i++) {
        size_t which = choose(candidates, count, numbers[i][2] * all);
        float own = candidates[which].sum - (which > 0 ? candidates[which - 1].sum : 0.0f);
        struct target target = aim(work, receiver, candidates[which].source, numbers[i]);
        ps_vec3 end = element_lift(elements, elements_at(elements, target.triangle), target.place);
        rays[i] = elements_ray(elements, elements_place(elements, start), end);
        light[i] = own > 0.0f ? ps_rgb_scale(work->solution->radiosity[target.triangle],
                                             target.form_factor * all / own)
                              : (ps_rgb){0, 0, 0};
    }
    host->occluded(host, rays, n, blocked);
    for (size_t i = 0; i < n; i++)
        if (!blocked[i])
            sum = ps_rgb_add(sum, light[i]);
    return sum;
}

static ps_rgb light_in_shadow(const struct work *work, const struct receiver *receiver,
                              const struct candidate *candidates, size_t count)
{
    const struct local_setting *setting = work->setting;
    uint64_t samples = setting->samples;
    uint64_t first = ps_tile_sample(receiver->tile, receiver->lane, setting->pass->number, samples);
    ps_rgb sum = {0, 0, 0};
    for (uint64_t done = 0; done < samples; done += RAYS) {
        uint64_t left = samples - done;
        size_t n = left < RAYS ? (size_t)left : RAYS;
        sum = ps_rgb_add(sum, light_of_batch(work, receiver, candidates, count, first + done, n));
    }
    return ps_rgb_scale(sum, 1.0f / (float)samples);
}

/* --- pixels --- */

/* The light over the links of an element and its ancestors. */
static ps_rgb light_of_links(const struct work *work, const struct receiver *receiver,
                             uint32_t index, struct candidate *candidates)
{
    const struct solution *solution = work->solution;
    const struct elements *elements = &solution->elements;
    const struct links *links = &solution->links;
    ps_rgb sum = {0, 0, 0};
    float in_shadow = 0.0f;
    size_t count = 0;
    for (; index != ELEMENT_NONE; index = elements_at(elements, index)->parent)
        for (uint64_t k = links->starts[index]; k < links->starts[index + 1]; k++) {
            const struct link *link = &links->list[k];
            const struct element *source = elements_at(elements, link->source);
            ps_rgb leaves = solution->radiosity[link->source];
            float form_factor = element_is_cluster(source) ? cluster_form_factor(receiver, source)
                                                           : triangle_form_factor(receiver, source);
            if (!(form_factor > 0.0f))
                continue;
            bool is_even =
                is_far(receiver, source) || source->uneven < MOST_UNEVEN * ps_rgb_maximum(leaves);
            if (link->is_clear && is_even) {
                sum = ps_rgb_add(sum, ps_rgb_scale(leaves, form_factor));
                continue;
            }
            in_shadow += form_factor * (leaves.r + leaves.g + leaves.b);
            candidates[count++] = (struct candidate){link->source, form_factor, in_shadow};
        }
    if (in_shadow > 0.0f)
        sum = ps_rgb_add(sum, light_in_shadow(work, receiver, candidates, count));
    return sum;
}

static void light_tile(void *user, uint64_t index, uint32_t worker)
{
    const struct work *work = user;
    const struct solution *solution = work->solution;
    const struct elements *elements = &solution->elements;
    ps_tile *tile = work->host->tile(work->host, (uint32_t)index);
    ps_ray *rays = &work->rays[(size_t)worker * PS_TILE_PIXELS];
    ps_hit *hits = &work->hits[(size_t)worker * PS_TILE_PIXELS];
    work->host->tile_hits(work->host, (uint32_t)index, rays, hits);
    uint32_t element = ELEMENT_NONE;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        if (tile->object[lane] == PS_NO_OBJECT || hits[lane].object == PS_NO_OBJECT)
            continue;
        struct receiver receiver = {.place = elements_place(elements, hits[lane].position),
                                    .normal = hits[lane].normal,
                                    .position = hits[lane].position,
                                    .surface_normal = hits[lane].geometric_normal,
                                    .tile = (uint32_t)index,
                                    .lane = lane};
        element = elements_find(elements, receiver.place, receiver.surface_normal,
                                hits[lane].object, element);
        if (element == ELEMENT_NONE)
            continue;
        ps_rgb light =
            work->setting->elements
                ? solution->indirect[element]
                : light_of_links(work, &receiver, element, &work->candidates[worker * work->most]);
        ps_add_irradiance(tile, lane, light);
    }
}

/* The most links that an element and its ancestors have. */
static size_t longest_chain(const struct solution *solution)
{
    const struct elements *elements = &solution->elements;
    size_t most = 0;
    for (uint32_t i = 0; i < elements->tree.count; i++) {
        size_t chain = 0;
        if (elements_at(elements, i)->child_count > 0)
            continue;
        for (uint32_t at = i; at != ELEMENT_NONE; at = elements_at(elements, at)->parent)
            chain += solution->links.starts[at + 1] - solution->links.starts[at];
        most = chain > most ? chain : most;
    }
    return most;
}

ps_result local_pass(const struct solution *solution, const struct local_setting *setting)
{
    const ps_host *host = solution->elements.host;
    size_t workers = setting->pass->thread_count;
    struct work work = {.solution = solution, .setting = setting, .host = host};
    work.most = longest_chain(solution) + 1;
    work.candidates =
        host->allocate(host, workers * work.most * sizeof *work.candidates, "radiosity links");
    work.rays =
        host->allocate(host, workers * PS_TILE_PIXELS * sizeof *work.rays, "radiosity links");
    work.hits =
        host->allocate(host, workers * PS_TILE_PIXELS * sizeof *work.hits, "radiosity links");
    ps_result result = work.candidates && work.rays && work.hits
                           ? host->for_each_tile(host, light_tile, &work)
                           : PS_ERROR_MEMORY;
    host->release(host, work.candidates);
    host->release(host, work.rays);
    host->release(host, work.hits);
    return result;
}
