#include "pipeline/host_light.h"

#include "direct/direct.h"
#include "pipeline/render_state.h"

static void host_intersect(const ps_host *host, const ps_ray *rays, size_t n, ps_hit *hits)
{
    trace_intersect(render_of(host)->trace, RAYS_INCOHERENT, rays, n, hits);
}

static void host_occluded(const ps_host *host, const ps_ray *rays, size_t n, uint8_t *blocked)
{
    trace_occluded(render_of(host)->trace, rays, n, blocked);
}

static void host_intersect_packets(const ps_host *host, ps_packet *packets, size_t n, int coherent)
{
    trace_packets(render_of(host)->trace, packets, n, coherent);
}

/* A ray of a light, moved off what the light may lie on. */
static ps_rgb emit_from(const struct scene *scene, size_t light, const float numbers[4],
                        ps_ray *ray)
{
    ps_vec3 normal;
    ps_rgb flux = light_emit(&scene->lights[light], numbers, ray, &normal);
    if (light_is_delta(&scene->lights[light]))
        ray->tnear = scene->surface_offset; /* a light may lie on a surface */
    ray->origin = ps_add_scaled(ray->origin, scene->surface_offset, normal);
    return flux;
}

/* A ray of one of the lights; black where there is none. */
static ps_rgb emit(const struct scene *scene, const float numbers[4], ps_ray *ray)
{
    *ray = (ps_ray){{0, 0, 0}, 0, {0, 0, 1}, 0};
    if (scene->light_count == 0)
        return (ps_rgb){0, 0, 0};
    float probability, left[4] = {numbers[0], numbers[1], numbers[2], numbers[3]};
    size_t light = scene_choose_light(scene, &left[2], &probability);
    ps_rgb flux = emit_from(scene, light, left, ray);
    return probability > 0.0f ? ps_rgb_scale(flux, 1.0f / probability) : (ps_rgb){0, 0, 0};
}

static void host_emit_light(const ps_host *host, const float (*samples)[4], size_t n, ps_ray *rays,
                            ps_rgb *power)
{
    for (size_t i = 0; i < n; i++)
        power[i] = emit(render_of(host)->scene, samples[i], &rays[i]);
}

static uint32_t host_light_count(const ps_host *host)
{
    return (uint32_t)render_of(host)->scene->light_count;
}

static void host_light(const ps_host *host, uint32_t index, ps_light *described)
{
    *described = light_describe(&render_of(host)->scene->lights[index]);
}

static void host_light_intensity(const ps_host *host, uint32_t index, const ps_vec3 *directions,
                                 size_t n, ps_rgb *intensity)
{
    const struct light *light = &render_of(host)->scene->lights[index];
    for (size_t i = 0; i < n; i++)
        intensity[i] = light_intensity(light, directions[i]);
}

static void host_emit_from(const ps_host *host, uint32_t index, const float (*samples)[4], size_t n,
                           ps_ray *rays, ps_rgb *power)
{
    for (size_t i = 0; i < n; i++)
        power[i] = emit_from(render_of(host)->scene, index, samples[i], &rays[i]);
}

static void host_scatter(const ps_host *host, ps_direction direction, const ps_ray *rays,
                         const ps_hit *hits, const float (*samples)[4], size_t n,
                         ps_bsdf_sample *scattered)
{
    const struct scene *scene = render_of(host)->scene;
    for (size_t i = 0; i < n; i++)
        scattered[i] = material_scatter(&scene->materials[hits[i].material], scene->microfacets,
                                        direction, &rays[i], &hits[i], samples[i]);
}

static void host_direct_radiance(const ps_host *host, const ps_ray *rays, const ps_hit *hits,
                                 uint32_t stream, uint32_t set, const uint64_t *indices, size_t n,
                                 ps_rgb *radiance)
{
    const struct render *render = render_of(host);
    struct light_numbers numbers = {render->settings->seed, stream, set, indices};
    struct lighting lighting = {render->scene, render->trace, NULL};
    direct_radiance(&lighting, rays, hits, n, &numbers, radiance);
}

static void host_emitted_radiance(const ps_host *host, const ps_ray *rays, const ps_hit *hits,
                                  const float *pdfs, size_t n, ps_rgb *radiance)
{
    emitted_radiance(render_of(host)->scene, rays, hits, pdfs, n, radiance);
}

void host_add_light_transport(ps_host *host)
{
    host->intersect = host_intersect;
    host->occluded = host_occluded;
    host->intersect_packets = host_intersect_packets;
    host->emit_light = host_emit_light;
    host->light_count = host_light_count;
    host->light = host_light;
    host->light_intensity = host_light_intensity;
    host->emit_from = host_emit_from;
    host->scatter = host_scatter;
    host->direct_radiance = host_direct_radiance;
    host->emitted_radiance = host_emitted_radiance;
}
