/* light_bvh.h: which of many lights to look at from a point.
 *
 * A bounding volume hierarchy over lights with orientation bounds (Conty Estevez and Kulla 2018,
 * "Importance sampling of many lights with adaptive tree splitting"; light_cluster.h has the
 * bounds). From the root down a child is chosen in proportion to its importance at the point, so
 * that lights are chosen about in proportion to what they give to it. Choices are drawn together by
 * systematic sampling: places, 1 apart, on a line as long as lights are drawn in the mean, on which
 * each node has its share of its parent. A node has no more of it than it has lights, for no light
 * is looked at twice: a lamp that outshines the others takes one place of the line, always, and
 * leaves the rest to them. No node is visited twice, and the choices have the variance of
 * stratified ones. The paper's way to lower variance is to go down both children of nodes that are
 * near; this one has a fixed cost.
 *
 * A mesh of more than LIGHT_BVH_TRIANGLES triangles is a subtree, of which triangles are chosen.
 * Sun and sky have no place and are not in the tree. Constant once made; any thread may read it.
 */
#ifndef SCENE_LIGHT_BVH_H
#define SCENE_LIGHT_BVH_H

#include "base/error.h"
#include "scene/light.h"
#include "settings/render_description.h"

#define LIGHT_BVH_TRIANGLES 64 /* those of a disc */
#define WHOLE_LIGHT UINT32_MAX

struct light_bvh;

/* The lights must outlive it. PS_ERROR_MEMORY, or PS_OK: destroy it. */
ps_result light_bvh_create(const struct light *lights, size_t count, struct light_bvh **created,
                           struct error *error);
void light_bvh_destroy(struct light_bvh *bvh);

size_t light_bvh_bytes(const struct light_bvh *bvh);

/* Lights that are in the tree: have a place and a size or intensity. */
size_t light_bvh_count(const struct light_bvh *bvh);

/* Whether points that draw so many lights draw them, and do not ask all: where there are more than
 * twice as many. To choose one costs about as much as to ask it. */
bool light_bvh_is_chosen_from(const struct light_bvh *bvh, uint32_t choices);

/* The lights that are in the tree, neighbours side by side; returns how many. */
size_t light_bvh_list(const struct light_bvh *bvh, uint32_t *lights);

/* Whether the light is a subtree. */
bool light_bvh_is_split(const struct light_bvh *bvh, size_t light);

struct light_choice {
    uint32_t light;
    uint32_t triangle; /* of a light that is split; else WHOLE_LIGHT */
    float weight;      /* how often it was drawn over how often it is in the mean */
};

/* How many lights a point draws. */
struct light_draws {
    uint32_t most; /* 1..MOST_LIGHT_CHOICES */
    bool all;      /* that is all there are */
    /* Irradiance, W/m^2, the sum of red, green and blue. What may give the point less than this
     * takes that much less of a place, so the line is shorter: such lights are drawn seldom, and
     * their weights make up for that (stochastic light culling, Tokuyoshi and Harada 2016). 0: the
     * line is `most` long, however faint the lights. */
    float threshold;
};

#define LIGHT_BVH_ALL SIZE_MAX

/* Draws lights for a point by u in [0,1); writes the different ones and returns how many, or
 * LIGHT_BVH_ALL, and writes nothing, where it asks all. Those that give nothing to the point are
 * not chosen. `normal`: unit, of a surface there, which light reaches from its front; 0: none. */
size_t light_bvh_choose(const struct light_bvh *bvh, ps_vec3 position, ps_vec3 normal,
                        const struct light_draws *draws, double u, struct light_choice *choices);

/* Draws a triangle of a light that is split; false: none gives anything. */
bool light_bvh_choose_triangle(const struct light_bvh *bvh, size_t light, ps_vec3 position,
                               ps_vec3 normal, double u, struct light_choice *choice);

/* How often light_bvh_choose draws the light in the mean, for a point without a normal; a split
 * light with all of its triangles. */
float light_bvh_expected(const struct light_bvh *bvh, size_t light, ps_vec3 position,
                         const struct light_draws *draws);

#endif
