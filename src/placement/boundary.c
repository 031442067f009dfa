/* boundary.c: short rays around a photon, and the straight walls that they tell of. */
#include "placement/boundary.h"

#include "placement/footprint.h"
#include <assert.h>
#include <psplat/math.h>
#include <stdbool.h>
#include <string.h>

#define AZIMUTHS 16

/* How far walls are looked for, in radii: a pixel whose ray starts at the rim has half of its disc
 * beyond it. */
#define LOOK 2.0f

/* How many times as long the way along the surface may be as that across a bundle. */
#define MOST_SLOPE 8.0f

/* Of the rays along a surface, so many are stopped near the ground where it is hollow, and get half
 * as far again or more where they run higher. */
#define MOST_AZIMUTHS 12
#define HIGHER_LENGTH 1.5f

/* Cosine and sine of an odd number of sixteenths of pi. */
#define C1 0.98078528f
#define C3 0.83146961f
#define C5 0.55557023f
#define C7 0.19509032f

static const float cosine[AZIMUTHS] = {C1,  C3,  C5,  C7,  -C7, -C5, -C3, -C1,
                                       -C1, -C3, -C5, -C7, C7,  C5,  C3,  C1};
static const float sine[AZIMUTHS] = {C7,  C5,  C3,  C1,  C1,  C3,  C5,  C7,
                                     -C7, -C5, -C3, -C1, -C1, -C3, -C5, -C7};

/* How far rays get along the tangent plane of a photon. */
struct star {
    float x[AZIMUTHS], y[AZIMUTHS], z[AZIMUTHS]; /* directions */
    float distances[AZIMUTHS];                   /* INFINITY: nothing is met */
};

/* The same across a splat's bundle: where they run, and how far in parts of the way to look; 1: all
 * of it. */
struct free_way {
    float cosine[AZIMUTHS], sine[AZIMUTHS];
    float length[AZIMUTHS];
};

/* A wall: points (u, v) with u a + v b = 1, so that 1 / length = a cosine + b sine. */
struct border {
    float a, b;
};

/* How far to look for the walls of a splat: across a bundle that leaves at a slope the way is
 * shorter. */
static float length_for(const ps_photon *photon, const struct splat *splat)
{
    return LOOK * splat->bundle.radius * ps_min(1.0f / footprint_cosine(photon), MOST_SLOPE);
}

/* `height` above the surface, so far as `length`. */
static struct star look_around(const ps_host *host, const ps_photon *photon, float height,
                               float length)
{
    _Alignas(64) ps_ray_packet packet;
    struct star star;
    ps_vec3 u, v, origin = ps_add_scaled(photon->position, height, photon->normal);
    ps_frame(photon->normal, &u, &v);
#pragma omp simd
    for (int i = 0; i < AZIMUTHS; i++) {
        ps_vec3 direction = ps_add(ps_scale(u, cosine[i]), ps_scale(v, sine[i]));
        ps_packet_set(&packet, (size_t)i, (ps_ray){origin, 0.0f, direction, length});
        star.x[i] = direction.x;
        star.y[i] = direction.y;
        star.z[i] = direction.z;
    }
    host->intersect_packets(host, &packet, 1, 0);
#pragma omp simd
    for (int i = 0; i < AZIMUTHS; i++)
        star.distances[i] = packet.tfar[i] < length ? packet.tfar[i] : INFINITY;
    return star;
}

static struct free_way way_across(const struct star *star, const struct splat *splat)
{
    struct free_way way;
    ps_vec3 axis_u = splat->bundle.axis_u, axis_v = splat->bundle.axis_v;
    float nearer = 1.0f / (LOOK * splat->bundle.radius);
#pragma omp simd
    for (int i = 0; i < AZIMUTHS; i++) {
        ps_vec3 direction = {star->x[i], star->y[i], star->z[i]};
        float u = ps_dot(direction, axis_u), v = ps_dot(direction, axis_v);
        float across = ps_max(sqrtf(u * u + v * v), 1e-6f);
        way.cosine[i] = u / across;
        way.sine[i] = v / across;
        way.length[i] = ps_min(ps_max(star->distances[i] * across * nearer, 1e-3f), 1.0f);
    }
    return way;
}

/* How many rays get no farther than this part of the `other` ones' way. */
static int count_stopped(const struct free_way *way, const struct free_way *other, float part)
{
    int count = 0;
#pragma omp simd reduction(+ : count)
    for (int i = 0; i < AZIMUTHS; i++)
        count += (way->length[i] < 1.0f) & (way->length[i] <= part * other->length[i]);
    return count;
}

static inline float free_to(const struct border *border, const struct free_way *way, int i)
{
    float inverse = border->a * way->cosine[i] + border->b * way->sine[i];
    return inverse > 1.0f ? 1.0f / inverse : 1.0f;
}

/* The wall through the hit of ray i and the nearer one of its neighbours'. */
static struct border through(const struct free_way *way, int i)
{
    int left = (i + AZIMUTHS - 1) % AZIMUTHS, right = (i + 1) % AZIMUTHS;
    int j = way->length[left] < way->length[right] ? left : right;
    float at_i = 1.0f / way->length[i], at_j = 1.0f / way->length[j];
    if (!(way->length[j] < 1.0f))
        return (struct border){way->cosine[i] * at_i, way->sine[i] * at_i};
    float determinant = way->cosine[i] * way->sine[j] - way->cosine[j] * way->sine[i];
    return (struct border){
        (at_i * way->sine[j] - at_j * way->sine[i]) / determinant,
        (at_j * way->cosine[i] - at_i * way->cosine[j]) / determinant,
    };
}

/* Whether the rays that a wall there would stop were stopped: a pole or a table's leg is none. Far
 * out, where a wall stops one ray or two, a pole counts as one; there it makes up for next to
 * nothing. */
static bool stands(const struct border *border, const struct free_way *way)
{
    int expected = 0, met = 0;
#pragma omp simd reduction(+ : expected, met)
    for (int i = 0; i < AZIMUTHS; i++) {
        float length = free_to(border, way, i);
        expected += length < 0.9f;
        met += (length < 0.9f) & (way->length[i] < 1.1f * length);
    }
    return 4 * met >= 3 * expected;
}

/* Forgets the rays that a wall stops: how far the others get stays in `left`, 1 for those. */
static void explain(const struct border *border, const struct free_way *way, float left[AZIMUTHS])
{
#pragma omp simd
    for (int i = 0; i < AZIMUTHS; i++)
        left[i] = way->length[i] > 0.9f * free_to(border, way, i) ? 1.0f : left[i];
}

/* The ray that is stopped first of those left; -1: none. */
static int first_stopped(const float left[AZIMUTHS])
{
    int nearest = -1;
    float least = 1.0f;
    for (int i = 0; i < AZIMUTHS; i++)
        if (left[i] < least) {
            nearest = i;
            least = left[i];
        }
    return nearest;
}

static void add_boundary(const struct border *border, struct splat *splat)
{
    assert(splat->bundle.boundary_count < PS_MOST_BOUNDARIES);
    float inverse = sqrtf(border->a * border->a + border->b * border->b);
    ps_boundary *added = &splat->bundle.boundaries[splat->bundle.boundary_count++];
    *added = (ps_boundary){border->a / inverse, border->b / inverse, LOOK / inverse};
}

static void find(const struct free_way *way, struct splat *splat)
{
    float left[AZIMUTHS];
    memcpy(left, way->length, sizeof left);
    for (uint32_t n = 0; n < PS_MOST_BOUNDARIES; n++) {
        int nearest = first_stopped(left);
        if (nearest < 0)
            return;
        struct border border = through(way, nearest);
        if (!stands(&border, way))
            return;
        add_boundary(&border, splat);
        explain(&border, way, left);
    }
}

/* The way around a photon, and where its bundle starts. A hollow surface rises all around: its own
 * walls are no others, and its bundle starts higher. */
static struct free_way look(const ps_host *host, float surface_offset, const ps_photon *photon,
                            const struct star *star, struct splat *splat)
{
    struct free_way low = way_across(star, splat);
    if (count_stopped(&low, &low, 1.0f) >= MOST_AZIMUTHS) {
        float clearance = footprint_clearance(surface_offset, splat->bundle.radius, true);
        struct star above = look_around(host, photon, clearance, length_for(photon, splat));
        struct free_way high = way_across(&above, splat);
        if (count_stopped(&low, &high, 1.0f / HIGHER_LENGTH) >= MOST_AZIMUTHS)
            return high;
    }
    footprint_start(photon, footprint_clearance(surface_offset, splat->bundle.radius, false),
                    splat);
    return low;
}

static bool same_place(const ps_photon *a, const ps_photon *b)
{
    return ps_same(a->position, b->position) && ps_same(a->normal, b->normal);
}

/* Of photons in one place, which share their star. */
static void find_around(const ps_host *host, float surface_offset, const ps_photon *photons,
                        size_t n, struct splat *splats)
{
    float length = 0.0f;
    for (size_t i = 0; i < n; i++)
        length = ps_max(length, length_for(&photons[i], &splats[i]));
    if (!(length > 0.0f))
        return;
    struct star star = look_around(host, &photons[0], surface_offset, length);
    for (size_t i = 0; i < n; i++) {
        if (!(splats[i].bundle.radius > 0.0f))
            continue;
        struct free_way way = look(host, surface_offset, &photons[i], &star, &splats[i]);
        find(&way, &splats[i]);
    }
}

void boundary_find(const ps_host *host, float surface_offset, const ps_photon *photons, size_t n,
                   struct splat *splats)
{
    for (size_t first = 0, end; first < n; first = end) {
        for (end = first + 1; end < n && same_place(&photons[first], &photons[end]);)
            end++;
        find_around(host, surface_offset, photons + first, end - first, splats + first);
    }
}
