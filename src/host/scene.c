/* scene.c: the services for the scene: rays, surfaces, lights, triangles and the camera. */
#include "direct/direct.h"
#include "host/host.h"
#include "scene/triangles.h"
#include <math.h>
#include <psplat/math.h>
#include <stdio.h>
#include <string.h>

static bool is_finite(ps_vec3 v)
{
    return isfinite(v.x + v.y + v.z);
}

/* Whether the ray tracer can bear it. tfar may be infinite. */
static bool is_ray(const ps_ray *ray)
{
    return is_finite(ray->origin) && is_finite(ray->direction) && ray->tnear >= 0.0f &&
           ray->tnear < INFINITY && ray->tfar == ray->tfar;
}

static bool are_rays(const ps_ray *rays, size_t n)
{
    bool good = true;
    for (size_t i = 0; i < n; i++)
        good &= is_ray(&rays[i]);
    return good;
}

static void count_bad_ray(const ps_host *host)
{
    atomic_fetch_add(&render_of(host)->refused.rays[kind_of(host)], 1);
}

static void host_intersect(const ps_host *host, const ps_ray *rays, size_t n, ps_hit *hits)
{
    const struct trace *trace = render_of(host)->trace;
    if (are_rays(rays, n)) {
        trace_intersect(trace, RAYS_INCOHERENT, rays, n, hits);
        return;
    }
    for (size_t i = 0; i < n; i++) {
        hits[i] = (ps_hit){.distance = INFINITY, .object = PS_NO_OBJECT};
        if (is_ray(&rays[i]))
            trace_intersect(trace, RAYS_INCOHERENT, &rays[i], 1, &hits[i]);
        else
            count_bad_ray(host);
    }
}

static void host_occluded(const ps_host *host, const ps_ray *rays, size_t n, uint8_t *blocked)
{
    const struct trace *trace = render_of(host)->trace;
    if (are_rays(rays, n)) {
        trace_occluded(trace, rays, n, blocked);
        return;
    }
    for (size_t i = 0; i < n; i++) {
        blocked[i] = 0;
        if (is_ray(&rays[i]))
            trace_occluded(trace, &rays[i], 1, &blocked[i]);
        else
            count_bad_ray(host);
    }
}

/* The origin and direction of a ray, summed: not finite where one of them is not. */
static bool is_packet(const ps_ray_packet *packet)
{
    int bad = 0;
#pragma omp simd reduction(+ : bad)
    for (int i = 0; i < 16; i++) {
        float sum = packet->origin_x[i] + packet->origin_y[i] + packet->origin_z[i] +
                    packet->direction_x[i] + packet->direction_y[i] + packet->direction_z[i] +
                    packet->tnear[i];
        bad += !(fabsf(sum) < INFINITY) | !(packet->tnear[i] >= 0.0f) |
               (packet->tfar[i] != packet->tfar[i]);
    }
    return bad == 0;
}

/* A packet with a bad ray meets nothing. */
static void host_intersect_packets(const ps_host *host, ps_ray_packet *packets, size_t n,
                                   int coherent)
{
    const struct trace *trace = render_of(host)->trace;
    for (size_t i = 0; i < n; i++) {
        if (is_packet(&packets[i]))
            trace_packets(trace, &packets[i], 1, coherent);
        else
            count_bad_ray(host);
    }
}

static const ps_ray nowhere = {{0, 0, 0}, 0, {0, 0, 1}, 0};

/* A ray of a light, moved off what the light may lie on; and where it starts. */
static ps_rgb emit_from(const struct scene *scene, size_t light, const float numbers[4],
                        ps_ray *ray, ps_light_sample *point)
{
    const struct light *from = &scene->lights[light];
    ps_rgb flux = light_emit(from, numbers, ray, &point->normal);
    point->position = ray->origin;
    point->distance = from->emitter == EMITTER_SUN || from->emitter == EMITTER_SKY ? INFINITY : 0;
    point->light = (uint32_t)light;
    if (light_is_delta(from))
        ray->tnear = scene->surface_offset; /* a light may lie on a surface */
    ray->origin = ps_add_scaled(ray->origin, scene->surface_offset, point->normal);
    return flux;
}

/* A ray of one of the lights; black where there is none. */
static ps_rgb emit(const struct scene *scene, const float numbers[4], ps_ray *ray,
                   ps_light_sample *point)
{
    *ray = nowhere;
    *point = (ps_light_sample){.distance = 0};
    if (scene->light_count == 0)
        return (ps_rgb){0, 0, 0};
    float left[4] = {numbers[0], numbers[1], numbers[2], numbers[3]};
    size_t light = scene_choose_light(scene, &left[2], &point->probability);
    ps_rgb flux = emit_from(scene, light, left, ray, point);
    return point->probability > 0.0f ? ps_rgb_scale(flux, 1.0f / point->probability)
                                     : (ps_rgb){0, 0, 0};
}

static void host_emit_light(const ps_host *host, const float (*samples)[4], size_t n, ps_ray *rays,
                            ps_rgb *power)
{
    ps_light_sample point;
    for (size_t i = 0; i < n; i++)
        power[i] = emit(render_of(host)->scene, samples[i], &rays[i], &point);
}

static void host_emit_points(const ps_host *host, const float (*samples)[4], size_t n, ps_ray *rays,
                             ps_rgb *power, ps_light_sample *points)
{
    for (size_t i = 0; i < n; i++)
        power[i] = emit(render_of(host)->scene, samples[i], &rays[i], &points[i]);
}

static uint32_t host_light_count(const ps_host *host)
{
    return (uint32_t)render_of(host)->scene->light_count;
}

/* Whether there is a light of that index. */
static bool has_light(const ps_host *host, uint32_t index, const char *service)
{
    size_t count = render_of(host)->scene->light_count;
    if (index < count)
        return true;
    host_refuse_index(host, service, index, count);
    return false;
}

/* Gives the caller as much of a struct as it knows: the size at its front, which must have been set. */
static void hand_over(const ps_host *host, const char *service, void *theirs, const void *ours,
                      uint32_t size)
{
    uint32_t known;
    memcpy(&known, theirs, sizeof known);
    if (known <= sizeof known) {
        char why[120];
        snprintf(why, sizeof why, "it called %s with a struct whose size is not set", service);
        host->fail(host, PS_ERROR_INVALID, why);
        return;
    }
    memcpy((char *)theirs + sizeof known, (const char *)ours + sizeof known,
           (known < size ? known : size) - sizeof known);
}

static void host_light(const ps_host *host, uint32_t index, ps_light *described)
{
    ps_light light = {.kind = PS_LIGHT_POINT, .axis = {0, 0, 1}};
    if (has_light(host, index, "light"))
        light = light_describe(&render_of(host)->scene->lights[index]);
    hand_over(host, "light", described, &light, sizeof light);
}

static void host_light_intensity(const ps_host *host, uint32_t index, const ps_vec3 *directions,
                                 size_t n, ps_rgb *intensity)
{
    bool there = has_light(host, index, "light_intensity");
    const struct light *light = there ? &render_of(host)->scene->lights[index] : NULL;
    for (size_t i = 0; i < n; i++)
        intensity[i] = light ? light_intensity(light, directions[i]) : (ps_rgb){0, 0, 0};
}

static void host_emit_from(const ps_host *host, uint32_t index, const float (*samples)[4], size_t n,
                           ps_ray *rays, ps_rgb *power)
{
    bool there = has_light(host, index, "emit_from");
    ps_light_sample point;
    for (size_t i = 0; i < n; i++) {
        rays[i] = nowhere;
        power[i] = there ? emit_from(render_of(host)->scene, index, samples[i], &rays[i], &point)
                         : (ps_rgb){0, 0, 0};
    }
}

/* One place's. */
static ps_light_sample sample_light(const struct scene *scene, ps_vec3 place,
                                    const float numbers[4])
{
    ps_light_sample sampled = {.distance = INFINITY};
    if (scene->light_count == 0)
        return sampled;
    float choice = numbers[2];
    struct light_sample sample;
    uint32_t index = (uint32_t)scene_choose_light(scene, &choice, &sampled.probability);
    const struct light *light = &scene->lights[index];
    const float point[1][2] = {{numbers[0], numbers[1]}};
    light_sample(light, &place, NULL, point, 1, &sample);
    float far = 4.0f * scene->radius;
    sampled.light = index;
    sampled.distance = sample.distance;
    sampled.direction = sample.direction;
    sampled.pdf = sample.pdf;
    sampled.position =
        ps_add_scaled(place, sample.distance < INFINITY ? sample.distance : far, sample.direction);
    sampled.normal = light_sample_normal(light, place, point[0], &sample);
    if (sampled.probability > 0.0f)
        sampled.irradiance = ps_rgb_scale(sample.weight, 1.0f / sampled.probability);
    return sampled;
}

static void host_sample_light(const ps_host *host, const ps_vec3 *places, const float (*samples)[4],
                              size_t n, ps_light_sample *sampled)
{
    for (size_t i = 0; i < n; i++)
        sampled[i] = sample_light(render_of(host)->scene, places[i], samples[i]);
}

static bool has_object(const ps_host *host, uint32_t index, const char *service)
{
    size_t count = render_of(host)->scene->object_count;
    if (index < count)
        return true;
    host_refuse_index(host, service, index, count);
    return false;
}

static uint32_t host_light_of_object(const ps_host *host, uint32_t object)
{
    return has_object(host, object, "light_of_object")
               ? render_of(host)->scene->object_lights[object]
               : PS_NO_LIGHT;
}

/* The instance that an object past the world's own shapes stands in. Instances go by their objects. */
static const struct instance *instance_of(const struct scene *scene, uint32_t object)
{
    size_t first = 0, end = scene->instance_count;
    while (end - first > 1) {
        size_t middle = first + (end - first) / 2;
        if (scene->instances[middle].first_object <= object)
            first = middle;
        else
            end = middle;
    }
    return &scene->instances[first];
}

static int32_t host_is_shown(const ps_host *host, uint32_t object)
{
    const struct scene *scene = render_of(host)->scene;
    if (!has_object(host, object, "is_shown"))
        return 0;
    if (object < scene->world_shape_count)
        return !scene->shapes[object].hidden;
    const struct instance *instance = instance_of(scene, object);
    uint32_t shape = instance->group->first_shape + (object - instance->first_object);
    return !instance->hidden && !scene->shapes[shape].hidden;
}

static ps_light_density density_of(const struct scene *scene, uint32_t light, ps_vec3 place,
                                   const ps_light_sample *point)
{
    const struct light *from = &scene->lights[light];
    ps_vec3 front = light_front(from, place, point->normal);
    return (ps_light_density){
        distribution_probability(&scene->light_choice, light) *
            light_pdf(from, place, point->direction, point->distance, front),
        light_arrival(from, place, point->direction, point->distance, front),
    };
}

/* Of all that shines from a direction, but suns without an angle. Their rays fill the same disc. */
static ps_light_density density_from_afar(const struct scene *scene, ps_vec3 place,
                                          const ps_light_sample *point)
{
    ps_light_density sum = {0, 0};
    for (uint32_t i = 0; i < scene->light_count; i++) {
        enum emitter emitter = scene->lights[i].emitter;
        if (emitter != EMITTER_SUN && emitter != EMITTER_SKY)
            continue;
        ps_light_density own = density_of(scene, i, place, point);
        sum.direct += own.direct;
        sum.arrival = own.arrival;
    }
    return sum;
}

static void host_light_densities(const ps_host *host, const ps_vec3 *places,
                                 const ps_light_sample *points, size_t n,
                                 ps_light_density *densities)
{
    const struct scene *scene = render_of(host)->scene;
    for (size_t i = 0; i < n; i++) {
        bool there = points[i].light < scene->light_count;
        bool afar = !(points[i].distance < INFINITY);
        densities[i] = (ps_light_density){0, 0};
        if (afar && !(there && light_is_delta(&scene->lights[points[i].light])))
            densities[i] = density_from_afar(scene, places[i], &points[i]);
        else if (there)
            densities[i] = density_of(scene, points[i].light, places[i], &points[i]);
    }
}

static void host_sample_bsdf(const ps_host *host, ps_direction direction, const ps_ray *rays,
                             const ps_hit *hits, const float (*samples)[4], size_t n,
                             ps_bsdf_sample *scattered)
{
    const struct scene *scene = render_of(host)->scene;
    for (size_t i = 0; i < n; i++)
        scattered[i] = material_scatter(&scene->materials[hits[i].material], scene->microfacets,
                                        direction, &rays[i], &hits[i], samples[i]);
}

static void host_evaluate_bsdf(const ps_host *host, ps_direction direction, const ps_ray *rays,
                               const ps_hit *hits, const ps_vec3 *directions, size_t n,
                               ps_bsdf_value *values)
{
    const struct scene *scene = render_of(host)->scene;
    for (size_t i = 0; i < n; i++)
        values[i] = material_evaluate(&scene->materials[hits[i].material], scene->microfacets,
                                      direction, &rays[i], &hits[i], directions[i]);
}

/* Shadow rays alone, and fewer choices than for a point that is seen: there are many such points behind each pixel. */
static struct lighting lighting_of_paths(const struct render *render)
{
    return (struct lighting){render->scene, render->trace, NULL, render->scene->path_light_choices};
}

static void host_direct_radiance(const ps_host *host, const ps_ray *rays, const ps_hit *hits,
                                 uint32_t stream, uint32_t set, const uint64_t *indices, size_t n,
                                 ps_rgb *radiance)
{
    const struct render *render = render_of(host);
    struct light_numbers numbers = {render->settings->seed, stream, set, indices};
    struct lighting lighting = lighting_of_paths(render);
    direct_radiance(&lighting, rays, hits, n, &numbers, radiance);
}

static void host_emitted_radiance(const ps_host *host, const ps_ray *rays, const ps_hit *hits,
                                  const float *pdfs, size_t n, ps_rgb *radiance)
{
    struct lighting lighting = lighting_of_paths(render_of(host));
    emitted_radiance(&lighting, rays, hits, pdfs, n, radiance);
}

static void host_scene_bounds(const ps_host *host, ps_vec3 *center, float *radius)
{
    *center = render_of(host)->scene->center;
    *radius = render_of(host)->scene->radius;
}

static uint64_t host_triangle_count(const ps_host *host)
{
    return triangles_count(render_of(host)->scene);
}

static size_t host_triangles(const ps_host *host, uint64_t first, size_t n, ps_triangle *triangles)
{
    return triangles_get(render_of(host)->scene, first, n, triangles);
}

static void host_camera(const ps_host *host, ps_camera *described)
{
    const struct scene *scene = render_of(host)->scene;
    const struct camera *camera = &scene->camera;
    ps_camera whole = {
        .projection = camera->orthographic ? PS_ORTHOGRAPHIC : PS_PERSPECTIVE,
        .width = (uint32_t)scene->width,
        .height = (uint32_t)scene->height,
        .position = camera->location,
        .forward = camera->forward,
        .corner = camera->corner,
        .across = camera->across,
        .down = camera->down,
        .aperture = camera->aperture,
        .focus = camera->focus,
    };
    hand_over(host, "camera", described, &whole, sizeof whole);
}

static void host_project(const ps_host *host, const ps_vec3 *points, size_t n, float (*pixels)[2])
{
    const struct camera *camera = &render_of(host)->scene->camera;
    for (size_t i = 0; i < n; i++)
        if (!camera_project(camera, points[i], &pixels[i][0], &pixels[i][1]))
            pixels[i][0] = pixels[i][1] = NAN;
}

void host_add_scene(ps_host *host)
{
    host->intersect = host_intersect;
    host->occluded = host_occluded;
    host->intersect_packets = host_intersect_packets;
    host->sample_bsdf = host_sample_bsdf;
    host->evaluate_bsdf = host_evaluate_bsdf;
    host->direct_radiance = host_direct_radiance;
    host->emitted_radiance = host_emitted_radiance;
    host->emit_light = host_emit_light;
    host->light_count = host_light_count;
    host->light = host_light;
    host->light_intensity = host_light_intensity;
    host->emit_from = host_emit_from;
    host->sample_light = host_sample_light;
    host->emit_points = host_emit_points;
    host->light_of_object = host_light_of_object;
    host->is_shown = host_is_shown;
    host->light_densities = host_light_densities;
    host->scene_bounds = host_scene_bounds;
    host->triangle_count = host_triangle_count;
    host->triangles = host_triangles;
    host->camera = host_camera;
    host->project = host_project;
}
