/* shadowmap.c: a small orthographic depth map for every splat (Hoet 2014, section 3.3).
 *
 * Rays of a bundle are parallel and close together, so a map is traced in packets of 4x4 texels.
 * Back faces count: a map that starts inside of something must see its far side, or light leaks
 * through.
 *
 * A pixel is compared with the texel it falls into, so its depth may differ by the slope of its
 * surface times its distance to the texel's centre. The bias grants just that: 1.5 texels *
 * tan(theta), theta between the light and the pixel's normal. A constant bias either shadows slopes
 * (acne, and energy lost) or leaks at contacts; it stays selectable, for comparison with the
 * thesis.
 */
#include <psplat/plugin.h>

PS_BOX_CHOICES

#define BLOCK 4 /* texels along the side of a packet */
#define SLOPE_TEXELS 1.5f
#define FLAT_TEXELS 0.1f /* tolerance where the light arrives at a right angle */

enum { STEP_BACK_FULL = 1 };

static const char *const bias_choices[] = {"slope", NULL};

struct state {
    PS_BOX_MEMBERS
    int64_t resolution;
    ps_number_or_choice bias;
};

static uint32_t resolution(const void *state)
{
    return (uint32_t)((const struct state *)state)->resolution;
}

static void place(const void *opaque, const ps_host *host, const ps_source *sources,
                  const ps_hit *hits, size_t n, ps_splat *splats)
{
    const struct state *state = opaque;
    ps_box_settings settings = PS_BOX_SETTINGS(state);
    host->place_boxes(host, &settings, sources, hits, n, splats);
    int open_ended = state->step_back.choice == STEP_BACK_FULL && state->depth.choice >= 0;
    for (size_t i = 0; i < n; i++) {
        float texel = 2.0f * splats[i].half_width / (float)state->resolution;
        int by_slope = state->bias.choice >= 0;
        splats[i].bias_constant =
            by_slope ? FLAT_TEXELS * texel : (float)fmin(state->bias.number, 1e9);
        splats[i].bias_slope = by_slope ? SLOPE_TEXELS * texel : 0.0f;
        if (open_ended)
            splats[i].far_depth = INFINITY;
    }
}

/* One ray of the map: where it starts, as a depth, and its origin. */
static float load_ray(const ps_splat *splat, float u, float v, ps_packet *packet, int lane)
{
    float start = splat->start_depth + u * splat->start_slope_u + v * splat->start_slope_v;
    ps_vec3 origin = ps_add_scaled(splat->centre, u, splat->axis_u);
    origin = ps_add_scaled(origin, v, splat->axis_v);
    origin = ps_add_scaled(origin, start, splat->axis_w);
    packet->origin_x[lane] = origin.x;
    packet->origin_y[lane] = origin.y;
    packet->origin_z[lane] = origin.z;
    packet->direction_x[lane] = splat->axis_w.x;
    packet->direction_y[lane] = splat->axis_w.y;
    packet->direction_z[lane] = splat->axis_w.z;
    packet->tnear[lane] = 0.0f;
    packet->tfar[lane] = fmaxf(splat->far_depth - start, 0.0f);
    return start;
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* Texels (left .. left + 3, top .. top + 3); those past the border repeat the last. */
static void trace_block(const ps_host *host, const ps_splat *splat, int side, int left, int top,
                        float *depths)
{
    _Alignas(64) ps_packet packet;
    float start[BLOCK * BLOCK], reach[BLOCK * BLOCK];
    float texel = 2.0f * splat->half_width / (float)side;
    for (int lane = 0; lane < BLOCK * BLOCK; lane++) {
        int column = least(left + lane % BLOCK, side - 1),
            row = least(top + lane / BLOCK, side - 1);
        float u = ((float)column + 0.5f) * texel - splat->half_width;
        float v = ((float)row + 0.5f) * texel - splat->half_width;
        start[lane] = load_ray(splat, u, v, &packet, lane);
        reach[lane] = packet.tfar[lane];
    }
    host->intersect_packets(host, &packet, 1);
    for (int lane = 0; lane < BLOCK * BLOCK; lane++) {
        int column = left + lane % BLOCK, row = top + lane / BLOCK;
        if (column < side && row < side)
            depths[row * side + column] =
                packet.tfar[lane] < reach[lane] ? start[lane] + packet.tfar[lane] : INFINITY;
    }
}

static void depth_maps(const void *opaque, const ps_host *host, const ps_splat *splats, size_t n,
                       float *depths)
{
    int side = (int)((const struct state *)opaque)->resolution;
    for (size_t i = 0; i < n; i++) {
        if (!(splats[i].half_width > 0.0f))
            continue;
        for (int top = 0; top < side; top += BLOCK)
            for (int left = 0; left < side; left += BLOCK)
                trace_block(host, &splats[i], side, left, top, depths + i * (size_t)(side * side));
    }
}

static const ps_param params[] = {
    PS_BOX_PARAMS(struct state, "full"),
    PS_INT(struct state, resolution, "8", 1, 64, "texels", "side of a depth map"),
    PS_NUMBER_OR(struct state, bias, "slope", 0, INFINITY, 0, bias_choices, "scene units",
                 "depth tolerance; slope: 1.5 texels times the receiver's slope"),
};

static const ps_visibility_vtable vtable = {
    .size = sizeof vtable,
    .resolution = resolution,
    .place = place,
    .depth_maps = depth_maps,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_VISIBILITY,
    .name = "shadowmap",
    .version = "1.0",
    .summary = "lights what a small orthographic depth map of the bundle sees",
    .paper = "Hoet 2014, section 3.3; full beams after Herzog et al. 2007",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(visibility, shadowmap, &descriptor)
