#include "splat/escape.h"

#include <psplat/math.h>

#define RAYS 16

/* Where the rays run, in half-widths: a golden-angle spiral, even over the disc. */
static const float place_u[RAYS] = {0.1768f,  -0.2258f, 0.0346f,  0.2846f,  -0.5222f, 0.4947f,
                                    -0.1655f, -0.3156f, 0.6846f,  -0.7123f, 0.3434f,  0.2537f,
                                    -0.7647f, 0.8971f,  -0.5475f, -0.1265f};
static const float place_v[RAYS] = {0.0000f,  0.2068f,  -0.3938f, 0.3712f, -0.0924f, -0.3147f,
                                    0.6155f,  -0.6076f, 0.2500f,  0.2940f, -0.7337f, 0.8089f,
                                    -0.4432f, -0.1972f, 0.7788f,  -0.9761f};

/* Distance along the axis to the nearest thing that a beam of this half-width meets past its source;
 * INFINITY if there is none. Rays start where they leave the tangent plane, but none behind the source:
 * a shading normal tilts that plane, and below it lies the source's own surface. */
static float nearest_beside(const ps_host *host, const struct box_scene *scene,
                            const ps_source *source, float half_width)
{
    _Alignas(64) ps_packet packet;
    float ahead[RAYS], nearest = INFINITY;
    ps_vec3 u, v, w = source->direction;
    ps_frame(w, &u, &v);
    ps_vec3 start = ps_add_scaled(source->position,
                                  box_clearance(scene->surface_offset, half_width), source->normal);
    for (int i = 0; i < RAYS; i++) {
        ps_vec3 offset =
            ps_add(ps_scale(u, half_width * place_u[i]), ps_scale(v, half_width * place_v[i]));
        ahead[i] = fmaxf(-ps_dot(source->normal, offset) / ps_dot(source->normal, w), 0.0f);
        ps_vec3 origin = ps_add(start, ps_add_scaled(offset, ahead[i], w));
        ps_packet_set(&packet, (size_t)i, (ps_ray){origin, 0.0f, w, INFINITY});
    }
    host->intersect_packets(host, &packet, 1);
    for (int i = 0; i < RAYS; i++)
        nearest = fminf(nearest, ahead[i] + packet.tfar[i]);
    return nearest;
}

/* A second look where the beam turned out to be narrower than the first took it for. INFINITY for beams
 * that graze their source, parts of which start below its surface. */
static float find_distance(const ps_host *host, const struct box_scene *scene,
                           const ps_box_settings *settings, const ps_source *source)
{
    if (ps_dot(source->normal, source->direction) < 1.0f / BOX_STEEPEST)
        return INFINITY;
    float widest = box_half_width(scene, settings, source, INFINITY);
    float distance = nearest_beside(host, scene, source, widest);
    float half_width = box_half_width(scene, settings, source, distance);
    return half_width < widest ? nearest_beside(host, scene, source, half_width) : distance;
}

void escape_find(const ps_host *host, const struct box_scene *scene,
                 const ps_box_settings *settings, const ps_source *sources, size_t n, ps_hit *hits)
{
    for (size_t i = 0; i < n; i++) {
        if (hits[i].distance < INFINITY)
            continue;
        float distance = find_distance(host, scene, settings, &sources[i]);
        if (!(distance < INFINITY))
            continue;
        hits[i].distance = distance;
        hits[i].position = ps_add_scaled(sources[i].position, distance, sources[i].direction);
        hits[i].normal = (ps_vec3){0, 0, 0};
    }
}
