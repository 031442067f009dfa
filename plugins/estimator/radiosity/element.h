/* element.h: the hierarchy of surfaces between which light is exchanged.
 *
 * Hanrahan, Salzman and Aupperle 1991 divide each polygon, here each triangle, into four by the
 * middles of its edges, where and as often as the exchange needs it. Smits, Arvo and Greenberg 1994
 * put a hierarchy of clusters on top of the polygons, so that n of them do not have to be looked at
 * in n^2 pairs. Here both are one tree of elements: its root is the scene, a cluster has two
 * children, which lie close together or face alike, a triangle none or four. As surfaces reflect on
 * both sides, each triangle of the scene is there twice: its front, and its back, wound the other
 * way.
 *
 * Lengths are in radii of the scene, and the scene's centre is the origin: areas and their products
 * stay numbers whatever the scene's size is. Children have larger indices than their parent.
 */
#ifndef PSPLAT_ESTIMATOR_RADIOSITY_ELEMENT_H
#define PSPLAT_ESTIMATOR_RADIOSITY_ELEMENT_H

#include "array.h"

#define ELEMENT_NONE UINT32_MAX

struct element {
    /* Of a triangle, counter-clockwise; of a cluster, the least and the largest corner of its
     * box. */
    ps_vec3 corners[3];
    ps_vec3 centre;
    float radius; /* around the centre */
    ps_vec3 normal;
    float cone; /* cosine of the angle around `normal` that all normals lie within */
    float area;
    float slack; /* how far the true surface, that of a sphere, is from the triangle */
    uint32_t parent, child, child_count; /* the children lie in a row */
    uint32_t side;      /* of the triangle it is a part of, or ELEMENT_NONE: a cluster */
    float places[3][2]; /* where its corners are on that: weights of the second and third corner */
    ps_rgb reflected;   /* direct light that leaves it, W/m^2 */
    ps_rgb direct;      /* direct light that arrives, W/m^2 */
    ps_rgb albedo;
    float uneven; /* by how much the direct light that leaves it differs between its parts, W/m^2 */
    float ambient; /* indirect light that arrives, about, W/m^2 */
    bool enclosed; /* no ray that was sent from it left the scene */
};

/* One side of a triangle of the scene. */
struct side {
    uint32_t object, triangle; /* that of the object */
    uint32_t back;             /* 1: the back */
    uint32_t element;
};

struct elements {
    const ps_host *host;
    ps_vec3 origin;    /* scene units */
    float unit;        /* scene units; the scene's radius */
    float offset;      /* of rays from surfaces, in units */
    struct array tree; /* of struct element; the root is the first */
    struct side *sides;
    size_t side_count;
    /* Of the lights, W, the sum of the channels, where all of it lands in the scene; else 0. */
    double power;
};

static inline struct element *elements_at(const struct elements *elements, size_t index)
{
    return (struct element *)elements->tree.items + index;
}

static inline bool element_is_cluster(const struct element *element)
{
    return element->side == ELEMENT_NONE;
}

/* To the elements' units, and back. */
static inline ps_vec3 elements_place(const struct elements *elements, ps_vec3 position)
{
    return ps_scale(ps_subtract(position, elements->origin), 1.0f / elements->unit);
}

static inline ps_vec3 elements_position(const struct elements *elements, ps_vec3 place)
{
    return ps_add_scaled(elements->origin, elements->unit, place);
}

/* Builds the tree over the scene's triangles; none where there are none. PS_ERROR_MEMORY; either
 * way released by elements_release. */
ps_result elements_create(const ps_host *host, const ps_pass *pass, struct elements *elements);
void elements_release(struct elements *elements);

/* Centre and radius of a triangle, by its corners. */
void element_measure(struct element *element);

/* Divides a triangle without children into four. false: no memory. Pointers to elements are void
 * from then on. */
bool elements_divide(struct elements *elements, uint32_t index);

/* The undivided triangle at a place of an object's surface, whose front looks along `normal`;
 * ELEMENT_NONE where the object has none that does. `guess`: an element of a triangle that it may
 * be, which is tried first, or ELEMENT_NONE. */
uint32_t elements_find(const struct elements *elements, ps_vec3 place, ps_vec3 normal,
                       uint32_t object, uint32_t guess);

/* A point of the element, uniform over its area, and the undivided triangle that it lies on, from
 * two numbers of [0, 1). `weights`: of that triangle's second and third corner. */
uint32_t elements_sample(const struct elements *elements, uint32_t index, const float numbers[2],
                         float weights[2]);

/* The undivided part of a triangle at a place on it. */
uint32_t elements_part(const struct elements *elements, uint32_t index, ps_vec3 place);

static inline ps_vec3 element_point(const struct element *element, const float weights[2])
{
    ps_vec3 p = ps_scale(element->corners[0], 1.0f - weights[0] - weights[1]);
    p = ps_add_scaled(p, weights[0], element->corners[1]);
    return ps_add_scaled(p, weights[1], element->corners[2]);
}

/* Two numbers of [0, 1) to weights, uniform over the area (Turk 1990). */
static inline void element_weights(const float numbers[2], float weights[2])
{
    float root = sqrtf(numbers[0]);
    weights[0] = root * (1.0f - numbers[1]);
    weights[1] = root * numbers[1];
}

/* A point moved off its surface, so that rays from and to it do not meet that. */
static inline ps_vec3 element_lift(const struct elements *elements, const struct element *element,
                                   ps_vec3 place)
{
    return ps_add_scaled(place, elements->offset + element->slack, element->normal);
}

/* A ray between two places, in scene units. */
static inline ps_ray elements_ray(const struct elements *elements, ps_vec3 from, ps_vec3 to)
{
    ps_vec3 way = ps_subtract(to, from);
    float length = ps_length(way);
    return (ps_ray){elements_position(elements, from), 0.0f,
                    length > 0.0f ? ps_scale(way, 1.0f / length) : (ps_vec3){0, 0, 1},
                    length * elements->unit};
}

#endif
