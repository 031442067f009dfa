/* light_cluster.h: bounds of lights that lie together: where they are, where they face, how strong
 * they are.
 *
 * Conty Estevez and Kulla 2018, "Importance sampling of many lights with adaptive tree splitting",
 * in the form of Pharr, Jakob and Humphreys, "Physically based rendering", 4th edition, section
 * 12.6.3. A box holds the lights. A cone of half angle theta_o holds the normals of their surfaces,
 * and no normal sends light farther away from itself than theta_e. `intensity` is what they send
 * along their normals, all together.
 */
#ifndef SCENE_LIGHT_CLUSTER_H
#define SCENE_LIGHT_CLUSTER_H

#include <psplat/types.h>
#include <stdbool.h>

struct light_cluster {
    ps_vec3 low, high; /* the box */
    ps_vec3 axis;      /* of the cone, unit */
    float cos_theta_o; /* -1: the normals face all around */
    float cos_theta_e; /* of the angle past which no light leaves a surface */
    float intensity;   /* W/sr, the sum of red, green and blue */
    bool both_sides;   /* the surfaces shine from their backs too */
};

/* Both clusters together. */
struct light_cluster light_cluster_join(const struct light_cluster *a,
                                        const struct light_cluster *b);

#define LIGHT_LANES 8

/* Clusters of which importance is asked together; see light_cluster. Those without intensity have
 * none. */
struct light_lanes {
    float x[LIGHT_LANES], y[LIGHT_LANES], z[LIGHT_LANES]; /* of a sphere around the box */
    float radius[LIGHT_LANES];
    float axis_x[LIGHT_LANES], axis_y[LIGHT_LANES], axis_z[LIGHT_LANES];
    float cos_theta_o[LIGHT_LANES], sin_theta_o[LIGHT_LANES], cos_theta_e[LIGHT_LANES];
    float back[LIGHT_LANES]; /* -1: both sides shine; else 1 */
    float intensity[LIGHT_LANES];
};

void light_lanes_set(struct light_lanes *lanes, int lane, const struct light_cluster *cluster);

/* What the lights give to a point, by their bounds: intensity cos(theta') cos(theta_i') / d^2, with
 * the least angles that any point of the sphere has; 0 only where all of them give nothing.
 * `normal`: unit, of a surface there; 0: none. d, which is that of the middle, is at least half of
 * the radius. All numbers are finite. */
void light_lanes_importance(const struct light_lanes *lanes, ps_vec3 position, ps_vec3 normal,
                            float importance[LIGHT_LANES]);

/* What it costs to have these lights in one node of a tree: intensity times the solid angle of
 * their directions (M_Omega) times the squared diagonal of the box, which unlike its surface tells
 * lights in a line apart. */
float light_cluster_cost(const struct light_cluster *cluster);

#endif
