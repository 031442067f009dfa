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

PS_FOOTPRINT_CHOICES

struct state {
    PS_FOOTPRINT_MEMBERS
};

static uint32_t resolution(const void *state)
{
    (void)state;
    return 0;
}

static ps_footprint_settings boxes(const void *opaque)
{
    const struct state *state = opaque;
    return PS_FOOTPRINT_SETTINGS(state);
}

static void place(const void *opaque, const ps_host *host, const ps_photon *photons,
                  const ps_hit *hits, size_t n, ps_splat *splats)
{
    const struct state *state = opaque;
    ps_footprint_settings settings = boxes(state);
    host->place_footprints(host, &settings, photons, hits, n, splats);
    ps_open_full_bundles(&settings, splats, n);
}

static void visible_tile(const ps_host *host, const ps_splat *splat, const ps_vec3 *points,
                         size_t n, uint8_t *lit)
{
    ps_ray rays[PS_TILE_PIXELS];
    size_t owners[PS_TILE_PIXELS], count = 0;
    uint8_t blocked[PS_TILE_PIXELS];
    ps_vec3 back = ps_scale(splat->axis_w, -1.0f);
    for (size_t i = 0; i < n; i++) {
        ps_vec3 place = ps_bundle_place(splat, points[i]);
        float length = place.z - ps_bundle_start(splat, place.x, place.y);
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

static void visible(const void *state, const ps_host *host, const ps_splat *splat,
                    const ps_vec3 *points, size_t n, uint8_t *lit)
{
    (void)state;
    for (size_t first = 0; first < n; first += PS_TILE_PIXELS) {
        size_t count = n - first < PS_TILE_PIXELS ? n - first : PS_TILE_PIXELS;
        visible_tile(host, splat, points + first, count, lit + first);
    }
}

static const ps_param params[] = {PS_FOOTPRINT_PARAMS(struct state, "full", "yes")};

static const ps_visibility_vtable vtable = {
    .size = sizeof vtable,
    .resolution = resolution,
    .boxes = boxes,
    .place = place,
    .visible = visible,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_VISIBILITY,
    .name = "raycast",
    .version = "1.0",
    .summary = "one ray a pixel-splat pair: the reference of visibility",
    .paper = "Hoet 2014, section 3.3, at unlimited resolution; Whitted 1980 (shadow rays)",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(visibility, raycast, &descriptor)
