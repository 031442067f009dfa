/* extent.c: rays over the largest disc that a bundle may fill. */
#include "placement/extent.h"

#include "placement/footprint.h"
#include "placement/radius.h"
#include <psplat/math.h>

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

/* How large the footprint must be for what the rays met: as far out as the outermost of them whose pixels would
 * take in the axis, and no smaller than `least`. */
static float extent_of(const struct placement *placement, const ps_photon *photon,
                       const ps_ray_packet *packet, float largest, float least)
{
    for (int i = RAYS - 1; i >= 0; i--) { /* inwards */
        float aside = largest * sqrtf(place_u[i] * place_u[i] + place_v[i] * place_v[i]);
        float extent = ps_min(MARGIN * aside, largest);
        if (extent <= least)
            break;
        if (packet->tfar[i] < INFINITY &&
            radius_at(&placement->scene, placement->settings, photon, packet->tfar[i]) > aside)
            return extent;
    }
    return least;
}

/* How far away along the axis the nearest thing lies that the rays met; INFINITY: they met nothing. */
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
    float largest = *radius, least = radius_at(scene, placement->settings, photon, hit->distance);
    bool met = hit->distance < INFINITY;
    if (met && !(least < largest))
        return;
    trace_disc(placement, photon, largest, &packet);
    if (!met) {
        float nearest = nearest_of(&packet, photon);
        least = radius_at(scene, placement->settings, photon, nearest);
        /* Bundles start before half of that. */
        footprint_stand_in(photon, nearest < INFINITY ? ps_max(nearest, largest) : largest, hit);
    }
    *radius = extent_of(placement, photon, &packet, largest, least);
}

void extent_find(const struct placement *placement, const ps_photon *photons, size_t n,
                 ps_hit *hits, float *radii)
{
    for (size_t i = 0; i < n; i++)
        if (radii[i] > 0.0f)
            find_one(placement, &photons[i], &hits[i], &radii[i]);
}
