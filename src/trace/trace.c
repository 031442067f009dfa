/* trace.c: Embree behind trace.h.
 *
 * Rays go in packets of 16, also incoherent ones: faster than one by one on processors with vectors
 * of 8 or 16, and bit for bit the same. ROBUST scene: splat maps send grids of parallel rays along
 * edges, which the fast mode lets slip through. The structure is built by one thread: a parallel
 * build may order leaves differently for another number of threads, and then rays that tie choose
 * other triangles.
 *
 * Shadow rays are never announced as coherent: Embree 3.13's frustum traversal of occlusion queries
 * runs for ever in scenes with instances.
 */
#include "trace/trace.h"

#include "trace/embree_shim.h"
#include "trace/surface.h"
#include <psplat/math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PACKET 16

/* Rays of the camera see geometry with the first bit, all others geometry with the second. */
#define MASK_CAMERA 1u
#define MASK_LIGHT 2u

struct trace {
    const struct scene *scene;
    RTCDevice device;
    RTCScene embree;
    RTCScene *groups; /* group_count entries */
    atomic_llong bytes;
};

static bool count_bytes(void *user, ssize_t bytes, bool post)
{
    struct trace *trace = user;
    (void)post;
    atomic_fetch_add(&trace->bytes, (long long)bytes);
    return true;
}

static ps_result embree_error(struct trace *trace, const char *what, struct error *error)
{
    enum RTCError code = rtcGetDeviceError(trace->device);
    ps_result result = code == RTC_ERROR_OUT_OF_MEMORY ? PS_ERROR_MEMORY : PS_ERROR_INVALID;
    return error_set(error, result, "Embree failed to %s (error %d)", what, (int)code);
}

/* Triangles stay where the scene has them. */
static RTCGeometry create_mesh(RTCDevice device, const struct shape *shape)
{
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, shape->vertices,
                               0, sizeof *shape->vertices, shape->vertex_count);
    rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, shape->triangles,
                               0, sizeof *shape->triangles, shape->triangle_count);
    return mesh;
}

static RTCGeometry create_sphere(RTCDevice device, const struct shape *shape)
{
    RTCGeometry sphere = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    const float data[4] = {shape->center.x, shape->center.y, shape->center.z, shape->radius};
    void *buffer = rtcSetNewGeometryBuffer(sphere, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                           sizeof data, 1);
    if (buffer)
        memcpy(buffer, data, sizeof data);
    return sphere;
}

static RTCGeometry create_geometry(const struct trace *trace, const struct shape *shape)
{
    return shape->kind == SHAPE_SPHERE ? create_sphere(trace->device, shape)
                                       : create_mesh(trace->device, shape);
}

/* A hit as Embree tells it: instances are numbered after the world's shapes. */
static struct intersection intersection_of(const struct scene *scene, uint32_t instance,
                                           uint32_t geometry, uint32_t triangle)
{
    bool in_world = instance == RTC_INVALID_GEOMETRY_ID;
    return (struct intersection){
        .instance = in_world ? NO_INSTANCE : instance - (uint32_t)scene->world_shape_count,
        .shape = geometry,
        .triangle = triangle,
    };
}

/* Lets rays through where there is no surface, and those of the camera where it is not seen from
 * behind. */
static void filter_hits(const struct RTCFilterFunctionNArguments *arguments)
{
    const struct scene *scene = ((const struct trace *)arguments->geometryUserPtr)->scene;
    const struct RTCHitN *hits = arguments->hit;
    const struct RTCRayN *rays = arguments->ray;
    unsigned n = arguments->N;
    for (unsigned i = 0; i < n; i++) {
        if (arguments->valid[i] != -1)
            continue;
        struct intersection at =
            intersection_of(scene, shim_hit_instance(hits, n, i), shim_hit_geometry(hits, n, i),
                            shim_hit_triangle(hits, n, i));
        at.u = shim_hit_u(hits, n, i);
        at.v = shim_hit_v(hits, n, i);
        at.normal = (ps_vec3){shim_hit_normal(hits, n, i, 0), shim_hit_normal(hits, n, i, 1),
                              shim_hit_normal(hits, n, i, 2)};
        ps_vec3 direction = {shim_ray_direction(rays, n, i, 0), shim_ray_direction(rays, n, i, 1),
                             shim_ray_direction(rays, n, i, 2)};
        bool of_camera = shim_ray_mask(rays, n, i) == MASK_CAMERA;
        if (!surface_is_opaque(scene, &at) ||
            (of_camera && !surface_shows_side(scene, &at, direction)))
            arguments->valid[i] = 0;
    }
}

/* Whether instances give their groups materials with cut-outs, or show fronts alone, for each
 * group; freed by the caller. */
static bool *find_filtered(const struct scene *scene)
{
    bool *filtered = calloc(scene->group_count + 1, sizeof *filtered);
    for (size_t i = 0; filtered && i < scene->instance_count; i++) {
        const struct instance *instance = &scene->instances[i];
        if (instance->front_only ||
            (instance->material != NO_MATERIAL && scene->materials[instance->material].has_opacity))
            filtered[instance->group - scene->groups] = true;
    }
    return filtered;
}

static void set_filter(struct trace *trace, RTCGeometry geometry)
{
    rtcSetGeometryUserData(geometry, trace);
    rtcSetGeometryIntersectFilterFunction(geometry, filter_hits);
    rtcSetGeometryOccludedFilterFunction(geometry, filter_hits);
}

static unsigned mask_of(bool hidden)
{
    return hidden ? MASK_LIGHT : MASK_CAMERA | MASK_LIGHT;
}

/* Attaches a run of shapes to a scene, numbered from 0. `filtered`: some of their materials, other
 * than their own, have holes, or they are seen from the front alone. */
static void attach_shapes(struct trace *trace, RTCScene embree, size_t first, size_t count,
                          bool filtered)
{
    for (size_t i = 0; i < count; i++) {
        const struct shape *shape = &trace->scene->shapes[first + i];
        RTCGeometry geometry = create_geometry(trace, shape);
        if (filtered || shape->front_only || trace->scene->materials[shape->material].has_opacity)
            set_filter(trace, geometry);
        rtcSetGeometryMask(geometry, mask_of(shape->hidden));
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(embree, geometry, (unsigned)i);
        rtcReleaseGeometry(geometry);
    }
}

/* A tree for each shape and one over those, which Embree builds at its low quality, or one tree for
 * all triangles together: the former finds hits in rooms of a few walls and blocks a fifth sooner,
 * the latter where large meshes lie inside of one another. */
#define MOST_TRIANGLES_BY_SHAPE 65536

static enum RTCBuildQuality build_quality(const struct shape *shapes, size_t count)
{
    size_t triangles = 0;
    for (size_t i = 0; i < count; i++)
        triangles += shapes[i].triangle_count;
    return triangles <= MOST_TRIANGLES_BY_SHAPE ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
}

/* For a run of shapes. */
static RTCScene new_scene(struct trace *trace, size_t first, size_t count)
{
    RTCScene embree = rtcNewScene(trace->device);
    rtcSetSceneFlags(embree, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(embree, build_quality(trace->scene->shapes + first, count));
    return embree;
}

static void build_groups(struct trace *trace, const bool *filtered)
{
    for (size_t i = 0; i < trace->scene->group_count; i++) {
        const struct group *group = &trace->scene->groups[i];
        trace->groups[i] = new_scene(trace, group->first_shape, group->shape_count);
        attach_shapes(trace, trace->groups[i], group->first_shape, group->shape_count, filtered[i]);
        rtcCommitScene(trace->groups[i]);
    }
}

/* Instances are numbered after the world's shapes. */
static void attach_instances(struct trace *trace)
{
    const struct scene *scene = trace->scene;
    for (size_t i = 0; i < scene->instance_count; i++) {
        const struct instance *instance = &scene->instances[i];
        RTCGeometry geometry = rtcNewGeometry(trace->device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(geometry, trace->groups[instance->group - scene->groups]);
        _Static_assert(sizeof(struct affine) == 12 * sizeof(float), "columns without gaps");
        rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                                &instance->placement);
        rtcSetGeometryMask(geometry, mask_of(instance->hidden));
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(trace->embree, geometry, (unsigned)(scene->world_shape_count + i));
        rtcReleaseGeometry(geometry);
    }
}

static ps_result build(struct trace *trace, struct error *error)
{
    const struct scene *scene = trace->scene;
    trace->groups = calloc(scene->group_count + 1, sizeof *trace->groups);
    bool *filtered = find_filtered(scene);
    if (!trace->groups || !filtered) {
        free(filtered);
        return error_memory(error, scene->group_count * sizeof *trace->groups, "the ray tracer");
    }
    build_groups(trace, filtered);
    free(filtered);
    attach_shapes(trace, trace->embree, 0, scene->world_shape_count, false);
    attach_instances(trace);
    rtcCommitScene(trace->embree);
    if (rtcGetDeviceError(trace->device) != RTC_ERROR_NONE)
        return embree_error(trace, "build the scene", error);
    return PS_OK;
}

ps_result trace_create(const struct scene *scene, const char *isa, struct trace **created,
                       struct error *error)
{
    char configuration[64] = "threads=1,set_affinity=0";
    size_t length = strlen(configuration);
    if (isa)
        snprintf(configuration + length, sizeof configuration - length, ",isa=%s",
                 strcmp(isa, "baseline") == 0 ? "sse2" : isa);
    struct trace *trace = calloc(1, sizeof *trace);
    if (!trace)
        return error_memory(error, sizeof *trace, "the ray tracer");
    trace->scene = scene;
    trace->device = rtcNewDevice(configuration);
    if (!trace->device) {
        free(trace);
        return error_set(error, PS_ERROR_INVALID, "Embree can't start (error %d)",
                         (int)rtcGetDeviceError(NULL));
    }
    rtcSetDeviceMemoryMonitorFunction(trace->device, count_bytes, trace);
    trace->embree = new_scene(trace, 0, scene->world_shape_count);
    ps_result result = build(trace, error);
    if (result != PS_OK) {
        trace_destroy(trace);
        return result;
    }
    *created = trace;
    return PS_OK;
}

void trace_destroy(struct trace *trace)
{
    if (!trace)
        return;
    rtcReleaseScene(trace->embree);
    for (size_t i = 0; trace->groups && i < trace->scene->group_count; i++)
        if (trace->groups[i])
            rtcReleaseScene(trace->groups[i]);
    rtcReleaseDevice(trace->device);
    free(trace->groups);
    free(trace);
}

size_t trace_bytes(const struct trace *trace)
{
    long long bytes = atomic_load(&trace->bytes);
    return bytes > 0 ? (size_t)bytes : 0;
}

/* What all rays of a packet have in common. */
static void set_common(struct RTCRay16 *rays, unsigned mask)
{
    memset(rays->time, 0, sizeof rays->time);
    memset(rays->flags, 0, sizeof rays->flags);
    for (size_t lane = 0; lane < PACKET; lane++)
        rays->mask[lane] = mask;
}

static void load_packet(struct RTCRay16 *rays, const ps_ray_packet *packet)
{
    memcpy(rays->org_x, packet->origin_x, sizeof rays->org_x);
    memcpy(rays->org_y, packet->origin_y, sizeof rays->org_y);
    memcpy(rays->org_z, packet->origin_z, sizeof rays->org_z);
    memcpy(rays->tnear, packet->tnear, sizeof rays->tnear);
    memcpy(rays->dir_x, packet->direction_x, sizeof rays->dir_x);
    memcpy(rays->dir_y, packet->direction_y, sizeof rays->dir_y);
    memcpy(rays->dir_z, packet->direction_z, sizeof rays->dir_z);
    memcpy(rays->tfar, packet->tfar, sizeof rays->tfar);
}

static void load_ray(struct RTCRay16 *rays, size_t lane, const ps_ray *ray)
{
    rays->org_x[lane] = ray->origin.x;
    rays->org_y[lane] = ray->origin.y;
    rays->org_z[lane] = ray->origin.z;
    rays->tnear[lane] = ray->tnear;
    rays->dir_x[lane] = ray->direction.x;
    rays->dir_y[lane] = ray->direction.y;
    rays->dir_z[lane] = ray->direction.z;
    rays->tfar[lane] = ray->tfar;
}

/* Fills up to 16 lanes; the rest are marked invalid, and hold what Embree's checks accept. */
static void load_rays(struct RTCRay16 *packet, int valid[PACKET], const ps_ray *rays, size_t n,
                      uint32_t mask)
{
    set_common(packet, mask);
    for (size_t lane = 0; lane < PACKET; lane++) {
        valid[lane] = lane < n ? -1 : 0;
        load_ray(packet, lane, &rays[lane < n ? lane : 0]);
    }
}

/* Finds the hits of the rays. */
static void intersect(const struct trace *trace, const int valid[PACKET], struct RTCRayHit16 *hits,
                      bool coherent)
{
    memset(hits->hit.geomID, 0xff, sizeof hits->hit.geomID);
    memset(hits->hit.instID, 0xff, sizeof hits->hit.instID);
    shim_intersect16(valid, trace->embree, hits, coherent);
}

struct query {
    enum ray_kind kind;
    const float *spreads;
    bool specular_alone;
};

static ps_hit resolve(const struct trace *trace, const struct query *query, const ps_ray *rays,
                      size_t ray, const struct RTCRayHit16 *hits, size_t lane)
{
    const ps_hit none = {.distance = INFINITY, .object = PS_NO_OBJECT};
    uint32_t geometry = hits->hit.geomID[lane], instance = hits->hit.instID[0][lane];
    if (geometry == RTC_INVALID_GEOMETRY_ID)
        return none;
    struct intersection at =
        intersection_of(trace->scene, instance, geometry, hits->hit.primID[lane]);
    at.u = hits->hit.u[lane];
    at.v = hits->hit.v[lane];
    at.normal = (ps_vec3){hits->hit.Ng_x[lane], hits->hit.Ng_y[lane], hits->hit.Ng_z[lane]};
    at.distance = hits->ray.tfar[lane];
    if (query->specular_alone && !surface_is_specular(trace->scene, &at))
        return none;
    float spread = query->spreads ? query->spreads[ray] : 0.0f;
    return surface_resolve(trace->scene, &rays[ray], spread, &at);
}

static void find_hits(const struct trace *trace, const struct query *query, const ps_ray *rays,
                      size_t n, ps_hit *hits)
{
    _Alignas(64) struct RTCRayHit16 packet;
    _Alignas(64) int valid[PACKET];
    for (size_t first = 0; first < n; first += PACKET) {
        size_t lanes = n - first < PACKET ? n - first : PACKET;
        load_rays(&packet.ray, valid, rays + first, lanes,
                  query->kind == RAYS_CAMERA ? MASK_CAMERA : MASK_LIGHT);
        intersect(trace, valid, &packet, query->kind != RAYS_INCOHERENT);
        for (size_t lane = 0; lane < lanes; lane++)
            hits[first + lane] = resolve(trace, query, rays, first + lane, &packet, lane);
    }
}

void trace_intersect(const struct trace *trace, enum ray_kind kind, const ps_ray *rays,
                     const float *spreads, size_t n, ps_hit *hits)
{
    find_hits(trace, &(struct query){.kind = kind, .spreads = spreads}, rays, n, hits);
}

void trace_intersect_specular(const struct trace *trace, const ps_ray *rays, size_t n, ps_hit *hits)
{
    find_hits(trace, &(struct query){.kind = RAYS_INCOHERENT, .specular_alone = true}, rays, n,
              hits);
}

/* Never as a coherent packet: with instances or cut-outs Embree 3.13 then may not come back. */
void trace_occluded(const struct trace *trace, const ps_ray *rays, size_t n, uint8_t *blocked)
{
    _Alignas(64) struct RTCRay16 packet;
    _Alignas(64) int valid[PACKET];
    for (size_t first = 0; first < n; first += PACKET) {
        size_t lanes = n - first < PACKET ? n - first : PACKET;
        load_rays(&packet, valid, rays + first, lanes, MASK_LIGHT);
        shim_occluded16(valid, trace->embree, &packet, 0);
        for (size_t lane = 0; lane < lanes; lane++)
            blocked[first + lane] = packet.tfar[lane] < 0.0f; /* -inf: something was met */
    }
}

void trace_packets(const struct trace *trace, ps_ray_packet *packets, size_t n, bool coherent)
{
    _Alignas(64) static const int valid[PACKET] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                   -1, -1, -1, -1, -1, -1, -1, -1};
    _Alignas(64) struct RTCRayHit16 hits;
    set_common(&hits.ray, MASK_LIGHT);
    for (size_t i = 0; i < n; i++) {
        load_packet(&hits.ray, &packets[i]);
        intersect(trace, valid, &hits, coherent);
        memcpy(packets[i].tfar, hits.ray.tfar, sizeof packets[i].tfar);
    }
}
