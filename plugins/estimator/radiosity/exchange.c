#include "exchange.h"

#include "form_factor.h"
#include "shaft.h"

enum { PAIRS = 16 }; /* of points, between which shadow rays run */

#define FAR 8.0f /* radii of both, from which distance on they count as small surfaces */

/* --- who can see whom --- */

/* Whether some of q lies before the plane of triangle p. */
static bool lies_before(const struct element *p, const struct element *q, float tolerance)
{
    float most = -INFINITY;
    if (element_is_cluster(q))
        most = ps_dot(p->normal, ps_subtract(q->centre, p->centre)) + q->radius;
    for (int i = 0; i < 3 && !element_is_cluster(q); i++)
        most = ps_max(most, ps_dot(p->normal, ps_subtract(q->corners[i], p->centre)));
    return most > tolerance;
}

/* Whether some normal of cluster p may look at some of q. */
static bool cone_faces(const struct element *p, const struct element *q)
{
    ps_vec3 way = ps_subtract(q->centre, p->centre);
    float distance = ps_length(way), reach = p->radius + q->radius;
    if (p->cone <= 0.0f || reach >= distance)
        return true;
    float cosine = ps_dot(p->normal, way) / distance;
    float angle = acosf(ps_max(-1.0f, ps_min(1.0f, cosine)));
    return angle - acosf(p->cone) - asinf(reach / distance) < 0.5f * PS_PI;
}

static bool faces(const struct elements *elements, const struct element *p, const struct element *q)
{
    return element_is_cluster(p) ? cone_faces(p, q)
                                 : lies_before(p, q, 2.0f * elements->offset + p->slack);
}

bool exchange_is_possible(const struct elements *elements, uint32_t p, uint32_t q)
{
    const struct element *a = elements_at(elements, p), *b = elements_at(elements, q);
    return faces(elements, a, b) && faces(elements, b, a);
}

/* --- without shadows --- */

/* Area of p times the mean form factor of its points to triangle q. */
static float mean_exchange(const struct element *p, const struct element *q)
{
    static const float weights[3][2] = {
        {1.0f / 6.0f, 1.0f / 6.0f}, {2.0f / 3.0f, 1.0f / 6.0f}, {1.0f / 6.0f, 2.0f / 3.0f}};
    float sum = 0.0f;
    for (int i = 0; i < 3; i++)
        sum += form_factor_triangle(element_point(p, weights[i]), p->normal, q->corners);
    return p->area * sum / 3.0f;
}

/* By all pairs of some of their points, of which clusters have some on each of their triangles. */
struct point_pair {
    uint32_t triangles[2];
    ps_vec3 points[2];
    float kernel; /* cos cos' / (pi r^2) */
};

static float frac(float x)
{
    return x - floorf(x);
}

/* Numbers of [0, 1) that are stratified over the pairs, other ones for each link: R2 sequence
 * (Roberts 2018), and its like in four dimensions. */
static void pair_numbers(uint32_t p, uint32_t q, uint32_t pair, float numbers[2][2])
{
    static const float steps[4] = {0.8566749f, 0.7338919f, 0.6287067f, 0.5385973f};
    uint32_t hash = (p * 0x9e3779b1u) ^ (q * 0x85ebca77u);
    hash = (hash ^ hash >> 15) * 0x2c1b3c6du;
    for (uint32_t k = 0; k < 4; k++) {
        hash = (hash ^ hash >> 13) * 0x297a2d39u;
        float start = (float)(hash >> 8) * 0x1p-24f;
        numbers[k / 2][k % 2] = ps_min(frac(start + (float)pair * steps[k]), 0.9999999f);
    }
}

static struct point_pair pair_of_points(const struct elements *elements, uint32_t p, uint32_t q,
                                        uint32_t number)
{
    struct point_pair pair;
    float numbers[2][2], weights[2];
    pair_numbers(p, q, number, numbers);
    for (int i = 0; i < 2; i++) {
        pair.triangles[i] = elements_sample(elements, i == 0 ? p : q, numbers[i], weights);
        pair.points[i] = element_point(elements_at(elements, pair.triangles[i]), weights);
    }
    const struct element *from = elements_at(elements, pair.triangles[0]);
    const struct element *to = elements_at(elements, pair.triangles[1]);
    ps_vec3 way = ps_subtract(pair.points[1], pair.points[0]);
    pair.kernel = form_factor_small(from->normal, way, to->normal, 1.0f);
    return pair;
}

struct exchange exchange_without_shadows(const struct elements *elements, uint32_t p, uint32_t q)
{
    const struct element *a = elements_at(elements, p), *b = elements_at(elements, q);
    float distance = ps_length(ps_subtract(b->centre, a->centre)), reach = a->radius + b->radius;
    float smaller = ps_min(a->area, b->area), larger = ps_max(a->area, b->area);
    struct exchange exchange = {.visible = 1.0f};
    if (element_is_cluster(a) || element_is_cluster(b)) {
        /* Their points are looked at with the shadows; the bound is that of surfaces that face each
         * other. */
        float nearest = distance - reach, square = PS_PI * nearest * nearest;
        exchange.most = nearest > 0.0f && larger < square ? smaller * (larger / square) : smaller;
        return exchange;
    }
    if (distance > FAR * reach)
        exchange.value = a->area * form_factor_small(a->normal, ps_subtract(b->centre, a->centre),
                                                     b->normal, b->area);
    else
        exchange.value = 0.5f * (mean_exchange(a, b) + mean_exchange(b, a));
    exchange.most = exchange.value;
    return exchange;
}

/* --- shadows --- */

void exchange_add_shadows(const struct elements *elements, uint32_t p, uint32_t q,
                          struct exchange *exchange)
{
    const struct element *a = elements_at(elements, p), *b = elements_at(elements, q);
    bool has_cluster = element_is_cluster(a) || element_is_cluster(b);
    ps_ray rays[PAIRS];
    float kernels[PAIRS];
    uint8_t blocked[PAIRS];
    for (uint32_t i = 0; i < PAIRS; i++) {
        struct point_pair pair = pair_of_points(elements, p, q, i);
        ps_vec3 ends[2];
        for (int k = 0; k < 2; k++)
            ends[k] =
                element_lift(elements, elements_at(elements, pair.triangles[k]), pair.points[k]);
        rays[i] = elements_ray(elements, ends[0], ends[1]);
        kernels[i] = pair.kernel;
    }
    elements->host->occluded(elements->host, rays, PAIRS, blocked);
    float all = 0.0f, passing = 0.0f;
    for (uint32_t i = 0; i < PAIRS; i++) {
        all += kernels[i];
        passing += blocked[i] ? 0.0f : kernels[i];
    }
    exchange->visible = all > 0.0f ? passing / all : 0.0f;
    if (has_cluster)
        exchange->value = ps_min(a->area * (b->area * passing / PAIRS), exchange->most);
    else
        exchange->value *= exchange->visible;
}

bool exchange_is_clear(const struct elements *elements, uint32_t p, uint32_t q,
                       const struct exchange *exchange)
{
    const struct element *a = elements_at(elements, p), *b = elements_at(elements, q);
    return exchange->visible >= 1.0f && !element_is_cluster(a) && !element_is_cluster(b) &&
           shaft_is_empty(elements, p, q);
}
