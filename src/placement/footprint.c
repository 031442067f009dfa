/* footprint.c: frame, beginning, end and extent of the box, and the bias of its depths. */
#include "placement/footprint.h"

#include "base/sample.h"
#include "placement/radius.h"
#include <assert.h>
#include <psplat/math.h>

/* The axes u, v turn by an angle of their own for each photon, so that texel borders don't line up.
 */
static void set_frame(const struct placement_scene *scene, const ps_photon *photon,
                      struct splat *splat)
{
    ps_vec3 u, v;
    ps_frame(photon->direction, &u, &v);
    uint32_t key = sample_key(scene->seed, PS_STREAM_SPLAT, photon->bounce);
    float turn = (float)(sample_hash((uint64_t)key << 32 ^ photon->path) >> 8) * 0x1p-24f;
    float c = cosf(2.0f * PS_PI * turn), s = sinf(2.0f * PS_PI * turn);
    splat->bundle.axis_u = ps_add_scaled(ps_scale(u, c), s, v);
    splat->bundle.axis_v = ps_add_scaled(ps_scale(v, c), -s, u);
    splat->bundle.axis_w = photon->direction;
}

static float slope_of(float cosine)
{
    float c = ps_max(cosine, 1e-4f);
    return ps_min(sqrtf(ps_max(1.0f - c * c, 0.0f)) / c, FOOTPRINT_STEEPEST);
}

/* A full bundle starts this far above the photon's tangent plane, as a fraction of the radius:
 * surfaces are not quite flat, and hollow ones rise above their tangent plane, by R^2 / 2r at the
 * bundle's edge, and must not block their own light. The bundle passes what lies lower, which makes
 * a furnished room too bright where all surfaces are taken for hollow. */
#define CLEARANCE 0.03125f
#define HOLLOW_CLEARANCE 0.125f

float footprint_clearance(float surface_offset, float radius, bool hollow)
{
    return ps_max(surface_offset, (hollow ? HOLLOW_CLEARANCE : CLEARANCE) * radius);
}

#define GRAZING_COSINE 0.015625f

float footprint_cosine(const ps_photon *photon)
{
    return ps_max(ps_dot(photon->normal, photon->direction), GRAZING_COSINE);
}

void footprint_start(const ps_photon *photon, float clearance, struct splat *splat)
{
    float cosine = footprint_cosine(photon);
    splat->bundle.start_depth =
        splat->photon_depth + ps_min(clearance / cosine, -0.5f * splat->photon_depth);
}

static float step_back(const struct footprint_params *settings, float radius, float distance,
                       float slope)
{
    float wanted = settings->step_back.choice < 0 ? (float)fmin(settings->step_back.number, 1e9)
                                                  : radius * slope + 0.5f * radius;
    return ps_min(wanted, distance);
}

void footprint_stand_in(const ps_photon *photon, float distance, ps_hit *hit)
{
    hit->distance = distance;
    hit->position = ps_add_scaled(photon->position, distance, photon->direction);
    hit->normal = (ps_vec3){0, 0, 0};
}

/* Around a bundle that starts at its photon. Pixels with narrow parts of its disc take it from
 * below the start plane (kernel.h), so the box begins at the photon's plane itself. */
static void place_full(const struct placement_scene *scene, const struct footprint_params *settings,
                       const ps_photon *photon, float distance, float largest, struct splat *splat)
{
    float cosine = footprint_cosine(photon);
    splat->bundle.start_slope_u = -ps_dot(photon->normal, splat->bundle.axis_u) / cosine;
    splat->bundle.start_slope_v = -ps_dot(photon->normal, splat->bundle.axis_v) / cosine;
    splat->photon_depth = -distance;
    footprint_start(photon, footprint_clearance(scene->surface_offset, splat->bundle.radius, true),
                    splat);
    float slope = sqrtf(splat->bundle.start_slope_u * splat->bundle.start_slope_u +
                        splat->bundle.start_slope_v * splat->bundle.start_slope_v);
    splat->near_depth = ps_min(splat->photon_depth - slope * splat->bundle.radius, 0.0f);
    splat->bandwidth_scale = (float)fmin(settings->bandwidth_scale, 1e9);
    splat->blend_distance = radius_blend_distance(scene, photon);
    splat->widest = largest;
    splat->narrowest = radius_smallest(scene, photon, distance, splat->widest);
}

struct splat footprint_place(const struct placement_scene *scene,
                             const struct footprint_params *settings, const ps_photon *photon,
                             const ps_hit *hit, float largest, float radius)
{
    assert(radius >= 0.0f && isfinite(radius));
    struct splat splat = {.power = photon->power, .merged = photon->merged, .path = photon->path};
    if (!(radius > 0.0f && hit->distance < INFINITY))
        return splat;
    float slope = slope_of(-ps_dot(photon->direction, hit->normal));
    set_frame(scene, photon, &splat);
    splat.bundle.centre = hit->position;
    splat.bundle.radius = radius;
    splat.bundle.far_depth = settings->depth.number > 0
                                 ? radius_bounded(scene, settings->depth.number)
                                 : radius * slope + radius;
    if (settings->step_back.choice == STEP_BACK_FULL) {
        place_full(scene, settings, photon, hit->distance, largest, &splat);
    } else {
        splat.near_depth = -step_back(settings, radius, hit->distance, slope);
        splat.bundle.start_depth = splat.near_depth;
    }
    return splat;
}

void footprint_cut(struct splat *splat, const float *depths, uint32_t resolution)
{
    assert(resolution > 0);
    float farthest = -INFINITY;
    for (uint32_t i = 0; i < resolution * resolution; i++)
        farthest = ps_max(depths[i], farthest);
    float tolerance = splat->bias_constant + splat->bias_slope * FOOTPRINT_STEEPEST;
    splat->bundle.far_depth = ps_min(farthest + tolerance, splat->bundle.far_depth);
}

void footprint_open(const struct footprint_params *settings, struct splat *splats, size_t n)
{
    if (settings->step_back.choice != STEP_BACK_FULL || settings->depth.number > 0)
        return;
    for (size_t i = 0; i < n; i++)
        splats[i].bundle.far_depth = INFINITY;
}

void footprint_set_bias(const struct footprint_params *settings, struct splat *splats, size_t n)
{
    static const float slope_texels = 0.75f;
    static const float flat_texels = 0.1f; /* where the light arrives at a right angle */
    for (size_t i = 0; i < n; i++) {
        float texel = 2.0f * splats[i].bundle.radius / (float)settings->resolution;
        bool by_slope = settings->bias.choice >= 0;
        splats[i].bias_constant =
            by_slope ? flat_texels * texel : (float)fmin(settings->bias.number, 1e9);
        splats[i].bias_slope = by_slope ? slope_texels * texel : 0.0f;
    }
}

/* --- extent
 * --------------------------------------------------------------------------------------- */

#define RAYS 16

/* A ray stands for what lies around it: this much farther from the axis. */
#define MARGIN 1.3f

/* Where the rays run, in radii: a golden-angle spiral, even over the disc. */
static const float place_u[RAYS] = {0.1768f,  -0.2258f, 0.0346f,  0.2846f,  -0.5222f, 0.4947f,
                                    -0.1655f, -0.3156f, 0.6846f,  -0.7123f, 0.3434f,  0.2537f,
                                    -0.7647f, 0.8971f,  -0.5475f, -0.1265f};
static const float place_v[RAYS] = {0.0000f,  0.2068f,  -0.3938f, 0.3712f, -0.0924f, -0.3147f,
                                    0.6155f,  -0.6076f, 0.2500f,  0.2940f, -0.7337f, 0.8089f,
                                    -0.4432f, -0.1972f, 0.7788f,  -0.9761f};

/* Rays beside the axis, which start where the bundle's do on even ground. */
static void trace_disc(const struct placement *placement, const ps_photon *photon, float radius,
                       ps_ray_packet *packet)
{
    ps_vec3 u, v, w = photon->direction;
    ps_frame(w, &u, &v);
    float clearance = footprint_clearance(placement->scene.surface_offset, radius, false);
    ps_vec3 start = ps_add_scaled(photon->position, clearance, photon->normal);
    float cosine = footprint_cosine(photon);
    for (int i = 0; i < RAYS; i++) {
        ps_vec3 offset = ps_add(ps_scale(u, radius * place_u[i]), ps_scale(v, radius * place_v[i]));
        float ahead = -ps_dot(photon->normal, offset) / cosine;
        ps_vec3 origin = ps_add(start, ps_add_scaled(offset, ahead, w));
        ps_packet_set(packet, (size_t)i, (ps_ray){origin, 0.0f, w, INFINITY});
    }
    placement->host->intersect_packets(placement->host, packet, 1, 1);
}

/* How large the footprint must be for what the rays met: as far out as the outermost of them whose
 * pixels would take in the axis, and no smaller than `least`. */
static float extent_of(const struct placement *placement, const ps_photon *photon,
                       const ps_ray_packet *packet, float largest, float least)
{
    for (int i = RAYS - 1; i >= 0; i--) { /* inwards */
        float aside = largest * sqrtf(place_u[i] * place_u[i] + place_v[i] * place_v[i]);
        float extent = ps_min(MARGIN * aside, largest);
        if (extent <= least)
            break;
        if (packet->tfar[i] < INFINITY && radius_at(&placement->scene, placement->settings, photon,
                                                    largest, packet->tfar[i]) > aside)
            return extent;
    }
    return least;
}

/* How far away along the axis the nearest thing lies that the rays met; INFINITY: they met
 * nothing. */
static float nearest_of(const ps_ray_packet *packet, const ps_photon *photon)
{
    float nearest = INFINITY;
    for (size_t i = 0; i < RAYS; i++) {
        ps_vec3 origin = {packet->origin_x[i], packet->origin_y[i], packet->origin_z[i]};
        ps_vec3 ahead = ps_subtract(origin, photon->position);
        nearest = ps_min(nearest, ps_dot(ahead, photon->direction) + packet->tfar[i]);
    }
    return ps_max(nearest, 0.0f);
}

static void find_one(const struct placement *placement, const ps_photon *photon, ps_hit *hit,
                     float *radius)
{
    _Alignas(64) ps_ray_packet packet;
    const struct placement_scene *scene = &placement->scene;
    float largest = *radius;
    float least = radius_at(scene, placement->settings, photon, largest, hit->distance);
    bool met = hit->distance < INFINITY;
    if (met && !(least < largest))
        return;
    trace_disc(placement, photon, largest, &packet);
    if (!met) {
        float nearest = nearest_of(&packet, photon);
        least = radius_at(scene, placement->settings, photon, largest, nearest);
        /* Bundles start before half of that. */
        footprint_stand_in(photon, nearest < INFINITY ? ps_max(nearest, largest) : largest, hit);
    }
    *radius = extent_of(placement, photon, &packet, largest, least);
}

void footprint_find_extents(const struct placement *placement, const ps_photon *photons, size_t n,
                            ps_hit *hits, float *radii)
{
    for (size_t i = 0; i < n; i++)
        if (radii[i] > 0.0f)
            find_one(placement, &photons[i], &hits[i], &radii[i]);
}
