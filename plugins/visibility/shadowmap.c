/* shadowmap.c: a small orthographic depth map for every splat (Hoet 2014, section 3.3).
 *
 * Rays of a bundle are parallel and close together, so a map is traced in packets of 4x4 texels.
 * Back faces count: a map that starts inside of something must see its far side, or light leaks
 * through.
 *
 * Pixels take light from before the boundaries beside a photon alone (ps_bundle.boundaries), but a
 * texel that such a wall cuts may have its centre behind it, from where a ray would start inside of
 * a block, or in the next room, and darken the texel's other part for nothing. So rays start before
 * the boundaries, too.
 */
#include <psplat/plugin.h>
#include <string.h>

#define BLOCK 4 /* texels along the side of a packet */
#define RAYS (BLOCK * BLOCK)

/* How far before a wall rays start at least, in radii. */
#define BEFORE_WALLS 0.05f

/* Where the centres of texels lie across a bundle of radius 1; past the border the last repeats. */
struct centres {
    float at[PS_MOST_TEXELS + BLOCK - 1];
};

static struct centres centres_of(int side)
{
    struct centres centres;
    for (int i = 0; i < side + BLOCK - 1; i++)
        centres.at[i] = ps_texel_centre(1.0f, (uint32_t)side, (uint32_t)(i < side ? i : side - 1));
    return centres;
}

/* Places across a bundle, one for each ray of a packet. */
struct places {
    float u[RAYS], v[RAYS];
};

/* Those of texels (left .. left + 3, top .. top + 3). */
static struct places places_of(const ps_bundle *bundle, const struct centres *centres, int left,
                               int top)
{
    struct places places;
    for (int row = 0; row < BLOCK; row++)
        for (int column = 0; column < BLOCK; column++) {
            places.u[row * BLOCK + column] = bundle->radius * centres->at[left + column];
            places.v[row * BLOCK + column] = bundle->radius * centres->at[top + row];
        }
    return places;
}

/* Twice, for corners: the way out of one wall may lead into the other. */
static void move_before_boundaries(const ps_bundle *bundle, struct places *places)
{
    for (int turn = 0; turn < 2; turn++)
        for (uint32_t k = 0; k < bundle->boundary_count; k++) {
            const ps_boundary wall = bundle->boundaries[k];
            float most = (wall.distance - BEFORE_WALLS) * bundle->radius;
#pragma omp simd
            for (int i = 0; i < RAYS; i++) {
                float across = places->u[i] * wall.normal_u + places->v[i] * wall.normal_v;
                float past = ps_max(across - most, 0.0f);
                places->u[i] -= past * wall.normal_u;
                places->v[i] -= past * wall.normal_v;
            }
        }
}

/* The rays of a block, and the depths at which they start. */
static void load_rays(const ps_bundle *restrict bundle, const struct places *restrict places,
                      ps_ray_packet *restrict packet, float *restrict start)
{
#pragma omp simd
    for (int i = 0; i < RAYS; i++) {
        float u = places->u[i], v = places->v[i];
        start[i] = ps_bundle_start(bundle, u, v);
        ps_vec3 origin = ps_bundle_point(bundle, u, v, start[i]);
        float length = ps_max(bundle->far_depth - start[i], 0.0f);
        ps_packet_set(packet, (size_t)i, (ps_ray){origin, 0.0f, bundle->axis_w, length});
    }
}

/* The depths of a block. */
static void trace_block(const ps_host *host, const ps_bundle *bundle, struct places places,
                        float found[RAYS])
{
    _Alignas(64) ps_ray_packet packet;
    float start[RAYS], lengths[RAYS];
    move_before_boundaries(bundle, &places);
    load_rays(bundle, &places, &packet, start);
    memcpy(lengths, packet.tfar, sizeof lengths);
    host->intersect_packets(host, &packet, 1, 1);
#pragma omp simd
    for (int i = 0; i < RAYS; i++)
        found[i] = packet.tfar[i] < lengths[i] ? start[i] + packet.tfar[i] : INFINITY;
}

static void trace_map(const ps_host *host, const ps_bundle *bundle, const struct centres *centres,
                      int side, float *depths)
{
    float found[RAYS];
    for (int top = 0; top < side; top += BLOCK)
        for (int left = 0; left < side; left += BLOCK) {
            int columns = side - left < BLOCK ? side - left : BLOCK;
            trace_block(host, bundle, places_of(bundle, centres, left, top), found);
            for (int row = 0; row < BLOCK && top + row < side; row++)
                memcpy(&depths[(top + row) * side + left], &found[row * BLOCK],
                       (size_t)columns * sizeof *depths);
        }
}

static void depth_maps(const void *state, const ps_host *host, const ps_bundle *bundles, size_t n,
                       uint32_t resolution, float *depths)
{
    (void)state;
    int side = (int)resolution;
    struct centres centres = centres_of(side);
    for (size_t i = 0; i < n; i++)
        trace_map(host, &bundles[i], &centres, side, depths + i * (size_t)(side * side));
}

static const ps_visibility_vtable vtable = {.size = sizeof vtable, .depth_maps = depth_maps};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_VISIBILITY,
    .name = "shadowmap",
    .version = "1.0",
    .summary = "lights what a small orthographic depth map of the bundle sees",
    .paper = "Hoet 2014, section 3.3; full bundles after Herzog et al. 2007",
    .vtable = &vtable,
};

PS_MODULE(visibility, shadowmap, &descriptor)
