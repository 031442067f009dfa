#include "support/reflected_light.h"

#include "base/sample.h"
#include "trace/trace.h"
#include <psplat/math.h>

#define SEEDS 8
#define RAYS 64
#define TURNS 400 /* of each ray */

static double reflected(const struct lighting *lighting, uint64_t seed)
{
    const struct scene *scene = lighting->scene;
    double sum = 0.0;
    for (uint64_t i = 0; i < (uint64_t)RAYS * TURNS; i++) {
        float x = 4.0f + (float)(i % RAYS % 8), y = 8.0f + 0.5f * (float)(i % RAYS / 8);
        ps_ray eye = camera_ray(&scene->camera, x, y, NULL), on;
        ps_hit hit, met;
        ps_rgb asked, emitted;
        float numbers[4];
        const struct light_numbers from = {seed, PS_STREAM_LIGHT, 0, &i};
        trace_intersect(lighting->trace, RAYS_INCOHERENT, &eye, NULL, 1, &hit);
        direct_radiance(lighting, &eye, &hit, NULL, 1, &from, &asked);
        sum += (double)asked.g;
        sample_point(sample_key(seed, PS_STREAM_PATH, 0), i, numbers);
        ps_bsdf_sample scattered =
            material_scatter(&scene->materials[hit.material], scene->microfacets, PS_FROM_CAMERA,
                             &eye, &hit, numbers, NULL);
        if (scattered.lobe == PS_DIFFUSE)
            continue;
        on = ps_leave_surface(hit.position, scattered.normal, scattered.direction,
                              scene->surface_offset);
        trace_intersect(lighting->trace, RAYS_INCOHERENT, &on, NULL, 1, &met);
        emitted_radiance(lighting, &on, &met, &scattered.pdf, 1, &emitted);
        sum += (double)(scattered.weight.g * emitted.g);
    }
    return sum / (RAYS * TURNS);
}

struct estimate reflected_light(const struct lighting *lighting)
{
    double values[SEEDS];
    for (int i = 0; i < SEEDS; i++)
        values[i] = reflected(lighting, (uint64_t)i + 1);
    return estimate_of(values, SEEDS);
}
