#include "shaft.h"

/* Six sides of the box around both, at most twelve between corners, and the planes of the two. */
enum { MOST_PLANES = 6 + 12 + 2 };

/* Beyond n . p = distance nothing is in the way. */
struct plane {
    ps_vec3 normal;
    float distance;
};

struct shaft {
    const struct elements *elements;
    uint32_t ends[2]; /* triangles of the scene that the ends are parts of */
    float tolerance;
    size_t count;
    struct plane planes[MOST_PLANES];
};

static float component(ps_vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static ps_vec3 along(int axis, float a, int other, float b)
{
    float v[3] = {0, 0, 0};
    v[axis] = a;
    v[other] = b;
    return (ps_vec3){v[0], v[1], v[2]};
}

static void box_of(const struct element *triangle, ps_vec3 box[2])
{
    const ps_vec3 *c = triangle->corners;
    box[0] =
        (ps_vec3){ps_min(c[0].x, ps_min(c[1].x, c[2].x)), ps_min(c[0].y, ps_min(c[1].y, c[2].y)),
                  ps_min(c[0].z, ps_min(c[1].z, c[2].z))};
    box[1] =
        (ps_vec3){ps_max(c[0].x, ps_max(c[1].x, c[2].x)), ps_max(c[0].y, ps_max(c[1].y, c[2].y)),
                  ps_max(c[0].z, ps_max(c[1].z, c[2].z))};
}

static void add_plane(struct shaft *shaft, ps_vec3 normal, float distance)
{
    shaft->planes[shaft->count++] = (struct plane){normal, distance};
}

/* The planes through a corner of each box that are parallel to the third axis; `high`: which
 * corner. */
static void add_slanted(struct shaft *shaft, ps_vec3 boxes[2][2], int a, int b, const int high[2])
{
    float sign_a = high[0] ? 1.0f : -1.0f, sign_b = high[1] ? 1.0f : -1.0f;
    float pa = component(boxes[0][high[0]], a), pb = component(boxes[0][high[1]], b);
    float along_a = component(boxes[1][high[0]], a) - pa;
    float along_b = component(boxes[1][high[1]], b) - pb;
    float length = hypotf(along_a, along_b);
    float na = along_b, nb = -along_a;
    if (na * sign_a < 0.0f) {
        na = -na;
        nb = -nb;
    }
    if (!(na * sign_a > 0.0f && nb * sign_b > 0.0f))
        return;
    na /= length;
    nb /= length;
    add_plane(shaft, along(a, na, b, nb), na * pa + nb * pb);
}

static void make_shaft(struct shaft *shaft, const struct element *p, const struct element *q)
{
    ps_vec3 boxes[2][2];
    box_of(p, boxes[0]);
    box_of(q, boxes[1]);
    for (int axis = 0; axis < 3; axis++) {
        float low = ps_min(component(boxes[0][0], axis), component(boxes[1][0], axis));
        float high = ps_max(component(boxes[0][1], axis), component(boxes[1][1], axis));
        add_plane(shaft, along(axis, 1.0f, (axis + 1) % 3, 0.0f), high);
        add_plane(shaft, along(axis, -1.0f, (axis + 1) % 3, 0.0f), -low);
        for (int corner = 0; corner < 4; corner++)
            add_slanted(shaft, boxes, axis, (axis + 1) % 3, (const int[2]){corner % 2, corner / 2});
    }
    add_plane(shaft, ps_scale(p->normal, -1.0f), -ps_dot(p->normal, p->corners[0]));
    add_plane(shaft, ps_scale(q->normal, -1.0f), -ps_dot(q->normal, q->corners[0]));
}

/* The least of n . p over an element. */
static float least_along(const struct element *element, ps_vec3 n)
{
    const ps_vec3 *c = element->corners;
    if (element_is_cluster(element))
        return n.x * c[n.x < 0.0f].x + n.y * c[n.y < 0.0f].y + n.z * c[n.z < 0.0f].z;
    return ps_min(ps_dot(n, c[0]), ps_min(ps_dot(n, c[1]), ps_dot(n, c[2])));
}

static bool is_outside(const struct shaft *shaft, const struct element *element)
{
    for (size_t i = 0; i < shaft->count; i++)
        if (least_along(element, shaft->planes[i].normal) >=
            shaft->planes[i].distance - shaft->tolerance + element->slack)
            return true;
    return false;
}

/* Back sides stand where fronts do. */
static bool may_block(const struct shaft *shaft, uint32_t index)
{
    const struct element *element = elements_at(shaft->elements, index);
    if (is_outside(shaft, element))
        return false;
    if (element_is_cluster(element))
        return may_block(shaft, element->child) || may_block(shaft, element->child + 1);
    uint32_t triangle = element->side / 2;
    return triangle != shaft->ends[0] && triangle != shaft->ends[1];
}

bool shaft_is_empty(const struct elements *elements, uint32_t p, uint32_t q)
{
    const struct element *ends[2] = {elements_at(elements, p), elements_at(elements, q)};
    struct shaft shaft = {.elements = elements,
                          .ends = {ends[0]->side / 2, ends[1]->side / 2},
                          .tolerance = 2.0f * elements->offset};
    make_shaft(&shaft, ends[0], ends[1]);
    return !may_block(&shaft, 0);
}
