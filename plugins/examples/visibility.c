/* visibility.c: an example: depth maps by one ray for each texel. */
#include <psplat/plugin.h>

/* A ray of a bundle up to its first hit, as a depth along the axis. */
static float depth_at(const ps_host *host, const ps_bundle *bundle, float u, float v)
{
    float start = ps_bundle_start(bundle, u, v);
    float length = bundle->far_depth - start;
    ps_ray ray = {ps_bundle_point(bundle, u, v, start), 0.0f, bundle->axis_w, length};
    ps_hit hit;
    if (!(length > 0.0f))
        return INFINITY;
    host->intersect(host, &ray, 1, &hit);
    return start + hit.distance;
}

static void depth_maps(const void *state, const ps_host *host, const ps_bundle *bundles, size_t n,
                       uint32_t resolution, float *depths)
{
    (void)state;
    for (size_t b = 0; b < n; b++)
        for (uint32_t row = 0; row < resolution; row++)
            for (uint32_t column = 0; column < resolution; column++) {
                float u = ps_texel_centre(bundles[b].radius, resolution, column);
                float v = ps_texel_centre(bundles[b].radius, resolution, row);
                *depths++ = depth_at(host, &bundles[b], u, v);
            }
}

static const ps_visibility_vtable vtable = {.size = sizeof vtable, .depth_maps = depth_maps};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_VISIBILITY,
    .name = "texels",
    .version = "1.0",
    .summary = "depth maps by one ray for each texel",
    .paper = "none: an example",
    .vtable = &vtable,
};

PS_MODULE(visibility, texels, &descriptor)
