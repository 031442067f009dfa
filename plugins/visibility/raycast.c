/* raycast.c: one ray for every pair of pixel and splat: the reference of visibility.
 *
 * The bundle's ray that would reach a point is followed from the point back to where the bundle
 * starts; the point is lit where nothing is met on the way. There are neither texels nor a depth
 * tolerance: it is what a depth map converges to as its resolution grows. Shadow rays from the
 * point rather than from the bundle's start, because the point's surface is known there and an
 * offset along its normal is enough to clear it at any slope.
 *
 * Without a map a full bundle is not cut to what it meets, so more tiles are tested, too.
 */
#include <psplat/plugin.h>

static void visible_tile(const ps_host *host, const ps_bundle *bundle, const ps_vec3 *points,
                         size_t n, uint8_t *lit)
{
    ps_ray rays[PS_TILE_PIXELS];
    size_t owners[PS_TILE_PIXELS], count = 0;
    uint8_t blocked[PS_TILE_PIXELS];
    ps_vec3 back = ps_scale(bundle->axis_w, -1.0f);
    for (size_t i = 0; i < n; i++) {
        ps_vec3 place = ps_bundle_place(bundle, points[i]);
        float length = place.z - ps_bundle_start(bundle, place.x, place.y);
        lit[i] = 1;
        if (!(length > 0.0f)) /* the core lets points below the start plane take their part */
            continue;
        rays[count] = (ps_ray){points[i], 0.0f, back, length};
        owners[count++] = i;
    }
    host->occluded(host, rays, count, blocked);
    for (size_t i = 0; i < count; i++)
        lit[owners[i]] = !blocked[i];
}

static void visible(const void *state, const ps_host *host, const ps_bundle *bundle,
                    const ps_vec3 *points, size_t n, uint8_t *lit)
{
    (void)state;
    for (size_t first = 0; first < n; first += PS_TILE_PIXELS) {
        size_t count = n - first < PS_TILE_PIXELS ? n - first : PS_TILE_PIXELS;
        visible_tile(host, bundle, points + first, count, lit + first);
    }
}

static const ps_visibility_vtable vtable = {.size = sizeof vtable, .visible = visible};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_VISIBILITY,
    .name = "raycast",
    .version = "1.0",
    .summary = "one ray for every pair of pixel and splat: the reference of visibility",
    .paper = "Hoet 2014, section 3.3, at unlimited resolution; Whitted 1980 (shadow rays)",
    .vtable = &vtable,
};

PS_MODULE(visibility, raycast, &descriptor)
