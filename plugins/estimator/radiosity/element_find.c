/* element_find.c: points of the elements, and the elements at points. */
#include "element.h"

/* The nearest triangle so far. */
struct search {
    const struct elements *elements;
    ps_vec3 place, normal;
    uint32_t object;
    uint32_t found;
    float square; /* of the distance */
    float weights[2];
};

static float in_unit(float x)
{
    return ps_max(0.0f, ps_min(1.0f, x));
}

/* Nearest point of a triangle (Ericson 2005, Real-time collision detection, 5.1.5). */
static void nearest_weights(const ps_vec3 corners[3], ps_vec3 p, float weights[2])
{
    ps_vec3 ab = ps_subtract(corners[1], corners[0]), ac = ps_subtract(corners[2], corners[0]);
    ps_vec3 ap = ps_subtract(p, corners[0]);
    float d1 = ps_dot(ab, ap), d2 = ps_dot(ac, ap);
    float bb = ps_dot(ab, ab), bc = ps_dot(ab, ac), cc = ps_dot(ac, ac);
    float d3 = d1 - bb, d4 = d2 - bc, d5 = d1 - bc, d6 = d2 - cc;
    float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    float v = 0.0f, w = 0.0f;
    if (d1 <= 0.0f && d2 <= 0.0f) {
        /* the first corner */
    } else if (d3 >= 0.0f && d4 <= d3) {
        v = 1.0f;
    } else if (d6 >= 0.0f && d5 <= d6) {
        w = 1.0f;
    } else if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) {
        v = d1 / (d1 - d3);
    } else if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) {
        w = d2 / (d2 - d6);
    } else if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f) {
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        v = 1.0f - w;
    } else if (va + vb + vc != 0.0f) {
        v = vb / (va + vb + vc);
        w = vc / (va + vb + vc);
    }
    weights[0] = in_unit(v);
    weights[1] = in_unit(w);
}

static void search_triangle(struct search *search, uint32_t index)
{
    const struct element *element = elements_at(search->elements, index);
    float weights[2];
    if (search->elements->sides[element->side].object != search->object ||
        !(ps_dot(element->normal, search->normal) > 0.0f))
        return;
    nearest_weights(element->corners, search->place, weights);
    ps_vec3 way = ps_subtract(element_point(element, weights), search->place);
    float square = ps_dot(way, way);
    if (!(square < search->square))
        return;
    search->square = square;
    search->found = index;
    memcpy(search->weights, weights, sizeof weights);
}

/* Square of the distance to a cluster's box. */
static float box_square(const struct element *cluster, ps_vec3 p)
{
    const ps_vec3 *box = cluster->corners;
    float x = ps_max(0.0f, ps_max(box[0].x - p.x, p.x - box[1].x));
    float y = ps_max(0.0f, ps_max(box[0].y - p.y, p.y - box[1].y));
    float z = ps_max(0.0f, ps_max(box[0].z - p.z, p.z - box[1].z));
    return x * x + y * y + z * z;
}

static float least_square(const struct search *search, uint32_t index)
{
    const struct element *element = elements_at(search->elements, index);
    return element_is_cluster(element) ? box_square(element, search->place) : 0.0f;
}

static void search_below(struct search *search, uint32_t index)
{
    const struct element *element = elements_at(search->elements, index);
    if (!element_is_cluster(element)) {
        search_triangle(search, index);
        return;
    }
    float squares[2] = {least_square(search, element->child),
                        least_square(search, element->child + 1)};
    uint32_t nearer = squares[1] < squares[0];
    for (uint32_t i = 0; i < 2; i++) {
        uint32_t which = nearer ^ i;
        if (squares[which] < search->square)
            search_below(search, element->child + which);
    }
}

/* The part of a divided triangle that weights lie in, and the weights in it. */
static uint32_t part_at(const struct element *element, float weights[3])
{
    for (uint32_t i = 0; i < 3; i++) {
        if (!(weights[i] > 0.5f))
            continue;
        for (uint32_t k = 0; k < 3; k++)
            weights[k] = 2.0f * weights[k] - (k == i ? 1.0f : 0.0f);
        return element->child + i;
    }
    for (uint32_t k = 0; k < 3; k++)
        weights[k] = 1.0f - 2.0f * weights[k];
    return element->child + 3;
}

static uint32_t undivided_part(const struct elements *elements, uint32_t index,
                               const float weights[2])
{
    float all[3] = {1.0f - weights[0] - weights[1], weights[0], weights[1]};
    while (elements_at(elements, index)->child_count > 0)
        index = part_at(elements_at(elements, index), all);
    return index;
}

uint32_t elements_part(const struct elements *elements, uint32_t index, ps_vec3 place)
{
    float weights[2];
    if (elements_at(elements, index)->child_count == 0)
        return index;
    nearest_weights(elements_at(elements, index)->corners, place, weights);
    return undivided_part(elements, index, weights);
}

uint32_t elements_find(const struct elements *elements, ps_vec3 place, ps_vec3 normal,
                       uint32_t object, uint32_t guess)
{
    struct search search = {.elements = elements,
                            .place = place,
                            .normal = normal,
                            .object = object,
                            .found = ELEMENT_NONE,
                            .square = INFINITY};
    if (elements->side_count == 0)
        return ELEMENT_NONE;
    if (guess != ELEMENT_NONE)
        search_triangle(&search, elements->sides[elements_at(elements, guess)->side].element);
    search_below(&search, 0);
    if (search.found == ELEMENT_NONE)
        return ELEMENT_NONE;
    return undivided_part(elements, search.found, search.weights);
}

uint32_t elements_sample(const struct elements *elements, uint32_t index, const float numbers[2],
                         float weights[2])
{
    const struct element *element = elements_at(elements, index);
    float choice = numbers[0];
    while (element->child_count > 0) {
        const struct element *children = elements_at(elements, element->child);
        uint32_t which = 0, last = element->child_count - 1;
        float share = children[0].area / element->area;
        while (which < last && choice >= share) {
            choice -= share;
            share = children[++which].area / element->area;
        }
        choice = in_unit(choice / share);
        index = element->child + which;
        element = &children[which];
    }
    const float rest[2] = {choice, numbers[1]};
    element_weights(rest, weights);
    return index;
}
