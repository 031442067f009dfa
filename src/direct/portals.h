/* portals.h: the openings through which the points of a room see the sky.
 *
 * In a room, a ray that is drawn by the sky's radiance or by the cosine at a surface meets a wall
 * nearly always. Portals are rectangles that windows fill; rays drawn through them get out
 * (Bitterli, Novak and Jarosz 2015, "Portal-masked environment map sampling"). There the user
 * places them; here they are learnt (importance/portal_search.h), as rectangles on the faces of a
 * box around what is seen. A ray from inside of a box leaves it at one point, so where a window
 * lies in a face, all points see it in the same rectangle (as reflections in a room are looked up
 * in a box around it, Lagarde and Zanuttini 2012, "Local image-based lighting with
 * parallax-corrected cubemaps"), and each ray has one portal or none:
 *
 *     p(w) = a p_sky(w) + (1 - a) P(k | x) r^2 / (A_k cos)
 *
 * with k the portal that x sees along w, and r its distance.
 * P is about in proportion to the light that x gets through the portal: its solid angle, the cosine
 * at the surface, and how much of it is seen from that part of the box, which is learnt too.
 * Whatever was not learnt is found by p_sky, at 1/a times its weight (defensive sampling,
 * Hesterberg 1995).
 *
 * Lengths are in scene units, pdfs by solid angle. Constant once made; any thread may read it.
 */
#ifndef DIRECT_PORTALS_H
#define DIRECT_PORTALS_H

#include "scene/light.h"

enum {
    PORTALS_MOST = 32,
    PORTAL_BINS = 64, /* of a face, across and down */
    PORTAL_CELLS = 8, /* of the box, along each axis */
    PORTAL_CELL_COUNT = PORTAL_CELLS * PORTAL_CELLS * PORTAL_CELLS
};

/* A face of the box: across axis `axis` (0: x), the one on the side of +axis where `high`. Places
 * on it are counted along the next two axes. */
struct portal_face {
    uint32_t axis;
    bool high;
};

/* A rectangle of bins of a face, from `first` to before `end`. */
struct portal_bins {
    struct portal_face face;
    uint32_t first[2], end[2];
};

/* Where a ray leaves the box. */
struct portal_exit {
    struct portal_face face;
    uint32_t bin[2]; /* of the face */
    float distance;
    float cosine; /* with the face's normal */
};

struct portals {
    ps_vec3 low, high; /* the box */
    size_t count;      /* of portals */
    struct portal_bins bins[PORTALS_MOST];
    /* The same in the scene: middles, normals of the faces, areas, and radii of spheres that hold
     * them. */
    float middle[3][PORTALS_MOST], normal[3][PORTALS_MOST];
    float area[PORTALS_MOST], radius[PORTALS_MOST];
    uint8_t portal_of[3][2][PORTAL_BINS]
                     [PORTAL_BINS]; /* axis, side, bins: 1 + the portal; 0: none */
    float visibility[PORTAL_CELL_COUNT][PORTALS_MOST]; /* from each part of the box, 0..1 */
};

/* An empty set of portals on a box. */
void portals_begin(struct portals *portals, ps_vec3 low, ps_vec3 high);

/* Adds one, that all see; it must overlap no other, and there must be fewer than PORTALS_MOST. */
void portals_add(struct portals *portals, const struct portal_bins *bins);

/* Whether a point lies in the box, so that portals are known to it. */
bool portals_know(const struct portals *portals, ps_vec3 position);

/* Which part of the box a point of it lies in. */
size_t portals_cell(const struct portals *portals, ps_vec3 position);

/* Where a ray from inside leaves. */
struct portal_exit portals_exit(const struct portals *portals, ps_vec3 position, ps_vec3 direction);

/* 1 + the portal by which it leaves; 0: by none. */
uint32_t portals_at(const struct portals *portals, const struct portal_exit *exit);

/* A direction into a portal, for a point of the box, by two numbers in [0, 1). `normal` as in
 * light_sample: of a surface that counts light by the cosine, or 0. False: it sees none. */
bool portals_choose(const struct portals *portals, ps_vec3 position, ps_vec3 normal,
                    const float numbers[2], ps_vec3 *direction);

/* Like light_sample and light_pdf of light.h, for a sky. */
void portals_sample(const struct portals *portals, const struct light *sky,
                    const ps_vec3 *positions, const ps_vec3 *normals, const float (*numbers)[2],
                    size_t n, struct light_sample *samples);
float portals_pdf(const struct portals *portals, const struct light *sky, ps_vec3 position,
                  ps_vec3 direction);

#endif
