/* photon_pilot.c: see photon_pilot.h. */
#include "render/photon_pilot.h"

#include "placement/caustics.h"
#include "render/photons.h"
#include "render/state.h"
#include <math.h>
#include <psplat/math.h>

/* Flux, and first and second moments of where it lands. */
struct landing {
    double flux, x, y, z, distance2;
};

static void add_landing(const ps_photon *photon, struct landing *sum)
{
    double flux = (double)ps_luminance(photon->power);
    double x = photon->position.x, y = photon->position.y, z = photon->position.z;
    sum->flux += flux;
    sum->x += flux * x;
    sum->y += flux * y;
    sum->z += flux * z;
    sum->distance2 += flux * (x * x + y * y + z * z);
}

static float spread_of(const struct landing *sum)
{
    if (!(sum->flux > 0.0))
        return 0.0f;
    double x = sum->x / sum->flux, y = sum->y / sum->flux, z = sum->z / sum->flux;
    return (float)sqrt(fmax(sum->distance2 / sum->flux - x * x - y * y - z * z, 0.0));
}

/* Whether the picture may see a place, straight or by one surface more. */
static bool is_near(const struct importance *importance, ps_vec3 place)
{
    ps_vec3 from = ps_subtract(place, importance->center);
    return !(importance->radius > 0.0f) ||
           ps_dot(from, from) < importance->radius * importance->radius;
}

/* How wide light lands, and which part of the paths lands, where the picture may see it. */
static void find_spread(struct photon_stream *stream)
{
    const struct importance *importance = &stream->render->importance;
    struct landing sum = {.flux = 0.0};
    double near = 0.0, landings = 0.0;
    for (int i = 0; i < PHOTON_CHUNKS; i++)
        for (size_t j = 0; j < stream->chunks[i].count; j++) {
            const ps_photon *photon = &stream->chunks[i].items[j];
            if (photon->bounce != 1)
                continue;
            landings += 1.0;
            if (is_near(importance, photon->position)) {
                near += 1.0;
                add_landing(photon, &sum);
            }
        }
    stream->spread = spread_of(&sum);
    stream->near_share = near > 0.0 ? near / landings : 1.0;
}

/* Every so many-th photon of the caustics, so that no more than CAUSTIC_LANDINGS are kept. */
static size_t spacing_of_caustics(const struct photon_stream *stream)
{
    size_t count = 0;
    for (int i = 0; i < PHOTON_CHUNKS; i++)
        for (size_t j = 0; j < stream->chunks[i].count; j++)
            count += stream->chunks[i].items[j].bounce == 0;
    return (count + CAUSTIC_LANDINGS - 1) / CAUSTIC_LANDINGS;
}

static void land(struct photon_stream *stream, const ps_ray *rays, size_t n)
{
    const ps_host *host = own_host(stream->render);
    ps_hit hits[PS_PATH_CHUNK];
    host->intersect(host, rays, n, hits);
    for (size_t i = 0; i < n; i++)
        if (hits[i].distance < INFINITY)
            stream->caustics[stream->caustic_count++] = hits[i].position;
}

static void find_caustics(struct photon_stream *stream)
{
    ps_ray rays[PS_PATH_CHUNK];
    size_t spacing = spacing_of_caustics(stream), number = 0, n = 0;
    uint64_t first_paths = (uint64_t)PHOTON_CHUNKS * PS_PATH_CHUNK;
    uint64_t traced = stream->path_count < first_paths ? stream->path_count : first_paths;
    stream->caustic_count = 0;
    for (int i = 0; i < PHOTON_CHUNKS; i++)
        for (size_t j = 0; j < stream->chunks[i].count; j++) {
            const ps_photon *photon = &stream->chunks[i].items[j];
            if (photon->bounce > 0 || number++ % spacing > 0)
                continue;
            rays[n++] = ps_leave_surface(photon->position, photon->normal, photon->direction,
                                         stream->render->scene->surface_offset);
            if (n == PS_PATH_CHUNK) {
                land(stream, rays, n);
                n = 0;
            }
        }
    land(stream, rays, n);
    stream->photons_per_caustic =
        traced > 0 ? (double)spacing * (double)stream->path_count / (double)traced : 1.0;
}

void photon_pilot_find(struct photon_stream *stream)
{
    find_spread(stream);
    find_caustics(stream);
}
