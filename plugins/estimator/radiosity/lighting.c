#include "lighting.h"

#include "landings.h"

enum {
    POINTS = 16, /* of an element */
    PARTS = 4    /* the quarters of a triangle, in turn, hold them */
};

/* Sets of random numbers. */
enum { SET_PLACES = 0x100, SET_LIGHTS, SET_DIRECTIONS };

/* --- one element --- */

/* Points of an element, and the surface there. */
struct sampling {
    uint64_t indices[POINTS];
    float numbers[POINTS][4];
    ps_ray rays[POINTS];
    ps_hit hits[POINTS];
    uint32_t numbers_of[POINTS]; /* which of the points these are */
    size_t count;                /* of points where there is a surface */
};

/* From weights in the whole triangle to those of the same point of one of its four parts. */
static void move_to_part(uint32_t part, float weights[2])
{
    float sign = part == 3 ? -0.5f : 0.5f;
    for (uint32_t k = 0; k < 2; k++)
        weights[k] = sign * weights[k] + (part == 3 || part == k + 1 ? 0.5f : 0.0f);
}

static void place_points(const struct elements *elements, size_t index, struct sampling *sampling)
{
    const ps_host *host = elements->host;
    const struct element *element = elements_at(elements, index);
    const struct side *side = &elements->sides[element->side];
    ps_surface_point points[POINTS];
    for (uint32_t i = 0; i < POINTS; i++)
        sampling->indices[i] = (uint64_t)index * POINTS + i;
    host->samples(host, PS_STREAM_PLUGIN, SET_PLACES, sampling->indices, POINTS, sampling->numbers);
    for (uint32_t i = 0; i < POINTS; i++) {
        float weights[2], at[2];
        element_weights(sampling->numbers[i], weights);
        move_to_part(i % PARTS, weights);
        for (int k = 0; k < 2; k++)
            at[k] = (1.0f - weights[0] - weights[1]) * element->places[0][k] +
                    weights[0] * element->places[1][k] + weights[1] * element->places[2][k];
        points[i] = (ps_surface_point){side->object, side->triangle, at[0], at[1], side->back};
    }
    host->surface_points(host, points, POINTS, sampling->rays, sampling->hits);
    sampling->count = 0;
    for (uint32_t i = 0; i < POINTS; i++) {
        if (sampling->hits[i].object == PS_NO_OBJECT)
            continue;
        sampling->numbers_of[sampling->count] = i;
        sampling->rays[sampling->count] = sampling->rays[i];
        sampling->hits[sampling->count++] = sampling->hits[i];
    }
}

/* Whether rays all around from the points meet the scene. */
static bool is_enclosed(const struct elements *elements, const struct sampling *sampling)
{
    const ps_host *host = elements->host;
    float numbers[POINTS][4];
    ps_ray rays[POINTS];
    uint8_t blocked[POINTS];
    host->samples(host, PS_STREAM_PLUGIN, SET_DIRECTIONS, sampling->indices, sampling->count,
                  numbers);
    for (size_t i = 0; i < sampling->count; i++) {
        ps_vec3 normal = sampling->hits[i].geometric_normal;
        rays[i] = ps_leave_surface(sampling->hits[i].position, normal,
                                   ps_cosine_direction(normal, numbers[i][0], numbers[i][1]),
                                   elements->offset * elements->unit);
    }
    host->occluded(host, rays, sampling->count, blocked);
    for (size_t i = 0; i < sampling->count; i++)
        if (!blocked[i])
            return false;
    return sampling->count > 0;
}

/* The largest, of any channel. */
static float difference_of(const ps_rgb parts[PARTS])
{
    ps_rgb low = parts[0], high = parts[0];
    for (int i = 1; i < PARTS; i++) {
        low = (ps_rgb){ps_min(low.r, parts[i].r), ps_min(low.g, parts[i].g),
                       ps_min(low.b, parts[i].b)};
        high = (ps_rgb){ps_max(high.r, parts[i].r), ps_max(high.g, parts[i].g),
                        ps_max(high.b, parts[i].b)};
    }
    return ps_rgb_maximum((ps_rgb){high.r - low.r, high.g - low.g, high.b - low.b});
}

static void light_element(struct elements *elements, size_t index)
{
    const ps_host *host = elements->host;
    struct element *element = elements_at(elements, index);
    struct sampling sampling;
    ps_rgb albedos[POINTS], radiance[POINTS];
    place_points(elements, index, &sampling);
    element->enclosed = is_enclosed(elements, &sampling);
    for (size_t i = 0; i < sampling.count; i++) {
        albedos[i] = sampling.hits[i].albedo;
        sampling.hits[i].albedo = (ps_rgb){1, 1, 1};
        sampling.hits[i].normal = sampling.hits[i].geometric_normal;
        sampling.hits[i].flags &= ~PS_HIT_SPECULAR;
    }
    host->direct_radiance(host, sampling.rays, sampling.hits, PS_STREAM_PLUGIN, SET_LIGHTS,
                          sampling.indices, sampling.count, radiance);
    ps_rgb direct = {0, 0, 0}, reflected = {0, 0, 0}, albedo = {0, 0, 0}, parts[PARTS] = {0};
    for (size_t i = 0; i < sampling.count; i++) {
        ps_rgb leaves = ps_rgb_multiply(albedos[i], radiance[i]);
        ps_rgb *part = &parts[sampling.numbers_of[i] % PARTS];
        direct = ps_rgb_add(direct, radiance[i]);
        reflected = ps_rgb_add(reflected, leaves);
        albedo = ps_rgb_add(albedo, albedos[i]);
        *part = ps_rgb_add(*part, leaves);
    }
    element->uneven = difference_of(parts) * PS_PI * PARTS / POINTS;
    element->direct = ps_rgb_scale(direct, PS_PI / POINTS);
    element->reflected = ps_rgb_scale(reflected, PS_PI / POINTS);
    element->albedo = ps_rgb_scale(albedo, 1.0f / POINTS);
}

struct adding {
    struct elements *elements;
    size_t first;
};

static void light_in_loop(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct adding *adding = user;
    size_t at = adding->first + index;
    const struct element *element = elements_at(adding->elements, at);
    if (!element_is_cluster(element) && element->child_count == 0)
        light_element(adding->elements, at);
}

void lighting_add(struct elements *elements, size_t first, size_t end)
{
    struct adding adding = {elements, first};
    elements->host->parallel_for(elements->host, end - first, light_in_loop, &adding);
}

void lighting_pull(struct elements *elements)
{
    for (size_t i = elements->tree.count; i-- > 0;) {
        struct element *whole = elements_at(elements, i);
        if (whole->child_count == 0)
            continue;
        whole->direct = whole->reflected = whole->albedo = (ps_rgb){0, 0, 0};
        for (uint32_t k = 0; k < whole->child_count; k++) {
            const struct element *child = elements_at(elements, whole->child + k);
            float share = child->area / whole->area;
            whole->direct = ps_rgb_add(whole->direct, ps_rgb_scale(child->direct, share));
            whole->reflected = ps_rgb_add(whole->reflected, ps_rgb_scale(child->reflected, share));
            whole->albedo = ps_rgb_add(whole->albedo, ps_rgb_scale(child->albedo, share));
        }
        if (whole->child_count == PARTS) {
            ps_rgb parts[PARTS];
            for (uint32_t k = 0; k < PARTS; k++)
                parts[k] = elements_at(elements, whole->child + k)->reflected;
            whole->uneven = difference_of(parts);
            for (uint32_t k = 0; k < PARTS; k++)
                whole->uneven =
                    ps_max(whole->uneven, elements_at(elements, whole->child + k)->uneven);
        }
    }
}

/* Lights all, and divides elements, and their parts, whose quarters differ by more than a part of
 * the scene's light. */
static ps_result divide_uneven(struct elements *elements, double epsilon)
{
    const ps_host *host = elements->host;
    lighting_add(elements, 0, elements->tree.count);
    lighting_pull(elements);
    const struct element *scene = elements_at(elements, 0);
    float allowed = (float)epsilon * ps_rgb_maximum(scene->reflected) * scene->area;
    for (size_t first = 0, end = elements->tree.count; first < end;) {
        for (uint32_t i = (uint32_t)first; i < end; i++) {
            const struct element *element = elements_at(elements, i);
            if (element->child_count > 0 || !(element->uneven * element->area > allowed))
                continue;
            if (!elements_divide(elements, i))
                return PS_ERROR_MEMORY;
        }
        first = end;
        end = elements->tree.count;
        lighting_add(elements, first, end);
        if (host->cancelled(host))
            return PS_CANCELLED;
    }
    lighting_pull(elements);
    return PS_OK;
}

ps_result lighting_begin(struct elements *elements, double epsilon)
{
    ps_result result = landings_divide(elements);
    return result == PS_OK ? divide_uneven(elements, epsilon) : result;
}

void lighting_finish(struct elements *elements)
{
    lighting_pull(elements);
    const struct element *scene = elements_at(elements, 0);
    double unit = (double)elements->unit;
    double direct = (double)scene->direct.r + (double)scene->direct.g + (double)scene->direct.b;
    double arrived = direct * (double)scene->area * unit * unit;
    if (!(arrived > 0.0) || !(elements->power > 0.0))
        return;
    float scale = (float)(elements->power / arrived);
    for (size_t i = 0; i < elements->tree.count; i++) {
        struct element *element = elements_at(elements, i);
        element->direct = ps_rgb_scale(element->direct, scale);
        element->reflected = ps_rgb_scale(element->reflected, scale);
    }
}
