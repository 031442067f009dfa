#include "cones.h"

#define GOLDEN_ANGLE 2.39996323f
/* Thickness of layers over the width of the cone: layers as thick as a cone is wide are seldom
 * filled where surfaces meet at an edge, which lets light through. */
#define SHARPNESS 0.35f
/* How far a plane may be turned away, as seen along an axis, before its share fades. */
#define FACING 4.0f
#define LEAST_TRANSMITTANCE 0.004f /* a cone ends where less is left */

/* --- cones
 * ---------------------------------------------------------------------------------------------- */

void cones_make(uint32_t n, struct cone *cones)
{
    for (uint32_t i = 0; i < n; i++) {
        float r2 = ((float)i + 0.5f) / (float)n, angle = (float)i * GOLDEN_ANGLE;
        float height = sqrtf(1.0f - r2), radius = sqrtf(r2);
        /* The cone of this solid angle, 2 pi (1 - cos), and a square as large as its disc. */
        float cosine = ps_max(1.0f - 0.5f / ((float)n * height), 0.1f);
        float tangent = sqrtf(1.0f - cosine * cosine) / cosine;
        cones[i].axis = (ps_vec3){radius * cosf(angle), radius * sinf(angle), height};
        cones[i].spread = SHARPNESS * ps_min(sqrtf(PS_PI) * tangent, height);
    }
}

/* --- layers
 * ---------------------------------------------------------------------------------------------- */

/* A cone under way. Lengths are in voxels of the finest level. */
struct walk {
    const struct volume *volume;
    float origin[3], direction[3], normal[3];
    float plane;         /* of the receiver: x.normal = plane */
    float lowest_corner; /* of a voxel at 0: x.normal */
    float spread;
};

/* The next layer across an axis that a walk passes. */
struct layer {
    int32_t border; /* where it begins, as seen from the walk */
    uint32_t level;
    float distance; /* to its middle */
    bool is_first;
};

static uint32_t bits_at_end(uint32_t value, uint32_t most)
{
    uint32_t count = 0;
    while (count < most && !(value >> count & 1))
        count++;
    return count;
}

/* Chooses the layer that begins at a border: as thick as the walk wants it there, and as its place
 * allows, so that no layer is passed twice or left out. */
static void choose_layer(const struct walk *walk, uint32_t axis, int32_t border,
                         struct layer *layer)
{
    float along = walk->direction[axis], start = walk->origin[axis];
    int32_t end = (int32_t)walk->volume->grid.across;
    *layer = (struct layer){.border = border, .distance = INFINITY};
    if (fabsf(along) < 1e-6f || (along > 0.0f ? border >= end : border <= 0))
        return;
    float wanted = walk->spread * (((float)border - start) / along);
    uint32_t most = wanted > 1.0f ? (uint32_t)ilogbf(1.41421356f * wanted) : 0; /* log2, rounded */
    most = most < walk->volume->level_count ? most : walk->volume->level_count - 1;
    layer->level = bits_at_end((uint32_t)border, most);
    float half = 0.5f * (float)(1 << layer->level);
    layer->distance = ((float)border + (along > 0.0f ? half : -half) - start) / along;
}

static void next_layer(const struct walk *walk, uint32_t axis, struct layer *layer)
{
    int32_t thickness = 1 << layer->level;
    choose_layer(walk, axis,
                 layer->border + (walk->direction[axis] > 0.0f ? thickness : -thickness), layer);
}

/* The layer that the walk starts in: as far as its surfaces lie ahead. */
static void first_layer(const struct walk *walk, uint32_t axis, struct layer *layer)
{
    float along = walk->direction[axis], start = walk->origin[axis];
    choose_layer(walk, axis, (int32_t)(along > 0.0f ? floorf(start) : ceilf(start)), layer);
    layer->distance = layer->distance < INFINITY ? ps_max(layer->distance, 0.0f) : INFINITY;
    layer->is_first = true;
}

/* What a voxel covers of a cone, over its opacity along an axis. Of a plane with normal n that a
 * cone meets along d, those axes show the side that the cone sees for which n_k d_k has the sign of
 * n.d; the others show its back, and count for nothing. Shares of planes at a slope add up to 1 in
 * the mean alone, and more than 1 is of no use: they are raised by
 *
 *     (|n_x| + |n_y| + |n_z|)^2 = 1 + 2 sum of |n_k n_l|,
 *
 * which is 1 where surfaces lie along the axes, or in all directions. */
static float cover(const struct voxel *voxel, uint32_t axis, const float direction[3])
{
    const float *diagonal = voxel->tilt.diagonal, *mixed = voxel->tilt.mixed;
    uint32_t next = (axis + 1) % 3, last = (axis + 2) % 3;
    float along = diagonal[axis] * fabsf(direction[axis]);
    float across = mixed[axis] * direction[next] + mixed[last] * direction[last];
    float sum = along + (direction[axis] < 0.0f ? -across : across);
    if (!(along > 0.0f))
        return 1.0f;
    float slope = 2.0f * (fabsf(mixed[0]) + fabsf(mixed[1]) + fabsf(mixed[2])) /
                  (diagonal[0] + diagonal[1] + diagonal[2]);
    return ps_min(ps_max(FACING * sum / along, 0.0f), 1.0f) * (1.0f + slope);
}

/* Whether the surfaces of a voxel in a walk's first layer lie behind where it starts. */
static bool is_behind(const struct walk *walk, uint32_t axis, const struct layer *layer,
                      const struct voxel *voxel)
{
    float place = (float)layer->border + voxel->depth[axis];
    return walk->direction[axis] > 0.0f ? place < walk->origin[axis]
                                        : place - 1.0f > walk->origin[axis];
}

/* What the middle of a layer shows around the place where the walk passes it. */
struct seen {
    bool empty; /* no voxels are there */
    float opacity;
    ps_rgb light;
};

/* Adds what a voxel shows, if there is one. */
static void add_voxel(const struct walk *walk, uint32_t axis, const struct layer *layer,
                      const struct voxel *voxel, float weight, struct seen *seen)
{
    if (!voxel)
        return;
    seen->empty = false;
    if (layer->is_first && is_behind(walk, axis, layer, voxel))
        return;
    weight *= cover(voxel, axis, walk->direction);
    uint32_t side = volume_side(axis, walk->direction[axis] > 0.0f); /* what faces the cone */
    seen->opacity += weight * voxel->opacity[axis];
    seen->light = ps_rgb_add(seen->light, ps_rgb_scale(voxel->light[side], weight));
}

/* Whether all of a voxel lies above the receiver's plane. */
static bool is_above(const struct walk *walk, const int at[3], float scale)
{
    float height = walk->lowest_corner - walk->plane * scale;
    for (int k = 0; k < 3; k++)
        height += walk->normal[k] * (float)at[k];
    return height >= 0.0f;
}

/* The four voxels in the middle of a layer between which a walk passes it. */
struct crossing {
    int at[4][3];
    float weights[4];
    const struct voxel *voxels[4]; /* or NULL */
    bool empty;                    /* none of them is there */
};

static void cross(const struct walk *walk, uint32_t axis, const struct layer *layer, float scale,
                  struct crossing *crossing)
{
    const struct volume_level *level = &walk->volume->levels[layer->level];
    const uint32_t others[2] = {(axis + 1) % 3, (axis + 2) % 3};
    float share[2];
    int first[2], place_along = (layer->border >> layer->level) - (walk->direction[axis] < 0.0f);
    for (int i = 0; i < 2; i++) {
        float place = walk->origin[others[i]] + layer->distance * walk->direction[others[i]];
        first[i] = voxel_between(place * scale, &share[i]);
    }
    crossing->empty = true;
    for (int corner = 0; corner < 4; corner++) {
        int *at = crossing->at[corner], second[2] = {corner & 1, corner >> 1};
        at[axis] = place_along;
        at[others[0]] = first[0] + second[0];
        at[others[1]] = first[1] + second[1];
        crossing->weights[corner] =
            (second[0] ? share[0] : 1.0f - share[0]) * (second[1] ? share[1] : 1.0f - share[1]);
        crossing->voxels[corner] =
            volume_at(level, (uint32_t)at[0], (uint32_t)at[1], (uint32_t)at[2]);
        crossing->empty &= !crossing->voxels[corner];
    }
}

static struct seen look(const struct walk *walk, uint32_t axis, const struct layer *layer)
{
    float scale = 1.0f / (float)(1 << layer->level), total = 0.0f;
    struct seen seen = {true, 0.0f, {0, 0, 0}};
    struct crossing crossing;
    cross(walk, axis, layer, scale, &crossing);
    for (int i = 0; i < 4 && !crossing.empty; i++) {
        if (!is_above(walk, crossing.at[i], scale))
            continue;
        total += crossing.weights[i];
        add_voxel(walk, axis, layer, crossing.voxels[i], crossing.weights[i], &seen);
    }
    if (total > 0.0f) {
        seen.opacity /= total;
        seen.light = ps_rgb_scale(seen.light, 1.0f / total);
    }
    return seen;
}

/* --- a whole cone
 * -------------------------------------------------------------------------------------------- */

/* What a walk has come through. */
struct passage {
    float before; /* transmittance up to the last gap */
    float shares; /* covered since, 0..1 */
    ps_rgb sum;
};

static void pass(const struct seen *seen, struct passage *passage)
{
    float left = 1.0f - passage->shares, share = ps_min(seen->opacity, left);
    if (seen->empty) {
        passage->before *= left;
        passage->shares = 0.0f;
        return;
    }
    float part = seen->opacity > 0.0f ? share / seen->opacity : left;
    passage->sum = ps_rgb_add(passage->sum, ps_rgb_scale(seen->light, passage->before * part));
    passage->shares += share;
}

ps_rgb cone_trace(const struct volume *volume, float spread, ps_vec3 position, ps_vec3 normal,
                  ps_vec3 direction)
{
    struct walk walk = {.volume = volume, .spread = spread};
    struct layer layers[3];
    struct passage passage = {1.0f, 0.0f, {0, 0, 0}};
    if (volume->level_count == 0)
        return passage.sum;
    voxel_grid_place(&volume->grid, position, walk.origin);
    voxel_components(direction, walk.direction);
    voxel_components(normal, walk.normal);
    for (uint32_t k = 0; k < 3; k++) {
        if (!(fabsf(walk.origin[k]) < 1e6f)) /* far outside: nothing is there */
            return passage.sum;
        walk.plane += walk.origin[k] * walk.normal[k];
        walk.lowest_corner += ps_min(walk.normal[k], 0.0f);
    }
    for (uint32_t k = 0; k < 3; k++)
        first_layer(&walk, k, &layers[k]);
    while (passage.before * (1.0f - passage.shares) > LEAST_TRANSMITTANCE) {
        uint32_t axis = layers[0].distance <= layers[1].distance ? 0 : 1;
        axis = layers[axis].distance <= layers[2].distance ? axis : 2;
        if (!(layers[axis].distance < INFINITY))
            break;
        struct seen seen = look(&walk, axis, &layers[axis]);
        pass(&seen, &passage);
        next_layer(&walk, axis, &layers[axis]);
    }
    return passage.sum;
}

ps_rgb cones_irradiance(const struct volume *volume, const struct cone *cones, uint32_t n,
                        ps_vec3 position, ps_vec3 normal, float turn)
{
    ps_vec3 u, v, turned_u, turned_v;
    ps_rgb sum = {0, 0, 0};
    ps_frame(normal, &u, &v);
    turned_u = ps_add_scaled(ps_scale(u, cosf(turn)), sinf(turn), v);
    turned_v = ps_add_scaled(ps_scale(v, cosf(turn)), -sinf(turn), u);
    for (uint32_t i = 0; i < n; i++) {
        ps_vec3 axis = cones[i].axis;
        ps_vec3 in_plane = ps_add_scaled(ps_scale(turned_u, axis.x), axis.y, turned_v);
        ps_vec3 direction = ps_normalize(ps_add_scaled(in_plane, axis.z, normal));
        sum = ps_rgb_add(sum, cone_trace(volume, cones[i].spread, position, normal, direction));
    }
    return ps_rgb_scale(sum, PS_PI / (float)n);
}
