/* scene.c: the services for the scene: rays, surfaces, triangles and the camera. */
#include "direct/direct.h"
#include "host/host.h"
#include "scene/triangles.h"
#include "trace/surface.h"
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

static void intersect(const ps_host *host, bool specular_alone, const ps_ray *rays,
                      const float *spreads, size_t n, ps_hit *hits)
{
    const struct trace *trace = render_of(host)->trace;
    if (specular_alone)
        trace_intersect_specular(trace, rays, n, hits);
    else
        trace_intersect(trace, RAYS_INCOHERENT, rays, spreads, n, hits);
}

/* Rays that are no numbers meet nothing. */
static void intersect_rays(const ps_host *host, bool specular_alone, const ps_ray *rays,
                           const float *spreads, size_t n, ps_hit *hits)
{
    if (are_rays(rays, n)) {
        intersect(host, specular_alone, rays, spreads, n, hits);
        return;
    }
    for (size_t i = 0; i < n; i++) {
        const float *spread = spreads ? &spreads[i] : NULL;
        hits[i] = (ps_hit){.distance = INFINITY, .object = PS_NO_OBJECT};
        if (is_ray(&rays[i]))
            intersect(host, specular_alone, &rays[i], spread, 1, &hits[i]);
        else
            count_bad_ray(host);
    }
}

static void host_intersect_cones(const ps_host *host, const ps_ray *rays, const float *spreads,
                                 size_t n, ps_hit *hits)
{
    intersect_rays(host, false, rays, spreads, n, hits);
}

static void host_intersect(const ps_host *host, const ps_ray *rays, size_t n, ps_hit *hits)
{
    intersect_rays(host, false, rays, NULL, n, hits);
}

static void host_intersect_specular(const ps_host *host, const ps_ray *rays, size_t n, ps_hit *hits)
{
    intersect_rays(host, true, rays, NULL, n, hits);
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

static int32_t host_is_shown(const ps_host *host, uint32_t object)
{
    const struct scene *scene = render_of(host)->scene;
    if (!has_object(host, object, "is_shown"))
        return 0;
    const struct instance *instance = scene_instance_of(scene, object);
    return !(instance && instance->hidden) && !scene_shape_of(scene, object)->hidden;
}

/* Whether the point's object has that triangle. */
static bool has_triangle(const ps_host *host, const ps_surface_point *point)
{
    if (!has_object(host, point->object, "surface_points"))
        return false;
    uint64_t count = triangles_of_shape(scene_shape_of(render_of(host)->scene, point->object));
    if (point->triangle < count)
        return true;
    host_refuse_index(host, "surface_points", point->triangle, count);
    return false;
}

static void host_surface_points(const ps_host *host, const ps_surface_point *points, size_t n,
                                ps_ray *rays, ps_hit *hits)
{
    for (size_t i = 0; i < n; i++) {
        rays[i] = (ps_ray){{0, 0, 0}, 0, {0, 0, 1}, 0};
        hits[i] = (ps_hit){.distance = INFINITY, .object = PS_NO_OBJECT};
        if (has_triangle(host, &points[i]))
            hits[i] = surface_at(render_of(host)->scene, &points[i], &rays[i]);
    }
}

static void host_sample_bsdf(const ps_host *host, ps_direction direction, const ps_ray *rays,
                             const ps_hit *hits, const float (*samples)[4], size_t n,
                             ps_bsdf_sample *scattered)
{
    const struct scene *scene = render_of(host)->scene;
    for (size_t i = 0; i < n; i++)
        scattered[i] = material_scatter(&scene->materials[hits[i].material], scene->microfacets,
                                        direction, &rays[i], &hits[i], samples[i], NULL);
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

/* Shadow rays alone, and fewer choices than for a point that is seen: there are many such points
 * behind each pixel. */
static struct lighting lighting_of_paths(const struct render *render)
{
    return (struct lighting){
        .scene = render->scene,
        .trace = render->trace,
        .choices = render->scene->path_light_choices,
        .light_threshold = render->importance.light_threshold,
    };
}

static void host_direct_radiance_of(const ps_host *host, const ps_ray *rays, const ps_hit *hits,
                                    const uint8_t *groups, uint32_t stream, uint32_t set,
                                    const uint64_t *indices, size_t n, ps_rgb *radiance)
{
    const struct render *render = render_of(host);
    struct light_numbers numbers = {render->settings->seed, stream, set, indices};
    struct lighting lighting = lighting_of_paths(render);
    direct_radiance(&lighting, rays, hits, groups, n, &numbers, radiance);
}

static void host_direct_radiance(const ps_host *host, const ps_ray *rays, const ps_hit *hits,
                                 uint32_t stream, uint32_t set, const uint64_t *indices, size_t n,
                                 ps_rgb *radiance)
{
    host_direct_radiance_of(host, rays, hits, NULL, stream, set, indices, n, radiance);
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
    host_hand_over(host, "camera", described, &whole, sizeof whole);
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
    host->intersect_cones = host_intersect_cones;
    host->intersect_specular = host_intersect_specular;
    host->occluded = host_occluded;
    host->intersect_packets = host_intersect_packets;
    host->sample_bsdf = host_sample_bsdf;
    host->evaluate_bsdf = host_evaluate_bsdf;
    host->direct_radiance = host_direct_radiance;
    host->direct_radiance_of = host_direct_radiance_of;
    host->emitted_radiance = host_emitted_radiance;
    host->light_of_object = host_light_of_object;
    host->is_shown = host_is_shown;
    host->surface_points = host_surface_points;
    host->scene_bounds = host_scene_bounds;
    host->triangle_count = host_triangle_count;
    host->triangles = host_triangles;
    host->camera = host_camera;
    host->project = host_project;
}
