/* trace.c: Embree behind trace.h.
 *
 * Rays go in packets of 16, also incoherent ones: faster than one by one on processors with vectors
 * of 8 or 16, and bit for bit the same. ROBUST scene: splat maps send grids of parallel rays along
 * edges, which the fast mode lets slip through. The structure is built by one thread: a parallel
 * build may order leaves differently for another number of threads, and then rays that tie choose
 * other triangles.
 */
#include "trace/trace.h"

#include "trace/embree_shim.h"
#include <psplat/math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PACKET 16

_Static_assert(sizeof(struct RTCRayHit16) <= sizeof(ps_packet), "ps_packet must hold RTCRayHit16");
_Static_assert(offsetof(struct RTCRay16, tfar) == offsetof(ps_packet, tfar), "ps_packet order");
_Static_assert(offsetof(struct RTCRayHit16, hit) == offsetof(ps_packet, tail), "ps_packet order");

struct trace {
    const struct scene *scene;
    RTCDevice device;
    RTCScene embree;
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

static void *fill_buffer(RTCGeometry geometry, enum RTCBufferType type, enum RTCFormat format,
                         const void *data, size_t stride, size_t count)
{
    void *buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, stride, count);
    if (buffer)
        memcpy(buffer, data, stride * count);
    return buffer;
}

static RTCGeometry create_geometry(struct trace *trace, const struct shape *shape)
{
    if (shape->kind == SHAPE_SPHERE) {
        RTCGeometry sphere = rtcNewGeometry(trace->device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        float data[4] = {shape->center.x, shape->center.y, shape->center.z, shape->radius};
        fill_buffer(sphere, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, data, sizeof data, 1);
        return sphere;
    }
    RTCGeometry mesh = rtcNewGeometry(trace->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    fill_buffer(mesh, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, shape->vertices,
                sizeof *shape->vertices, shape->vertex_count);
    fill_buffer(mesh, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, shape->triangles,
                sizeof *shape->triangles, shape->triangle_count);
    return mesh;
}

static ps_result add_shapes(struct trace *trace, struct error *error)
{
    for (size_t i = 0; i < trace->scene->shape_count; i++) {
        RTCGeometry geometry = create_geometry(trace, &trace->scene->shapes[i]);
        rtcSetGeometryMask(geometry, 0xffffffffu);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(trace->embree, geometry, (unsigned)i);
        rtcReleaseGeometry(geometry);
    }
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
    trace->embree = rtcNewScene(trace->device);
    rtcSetSceneFlags(trace->embree, RTC_SCENE_FLAG_ROBUST);
    ps_result result = add_shapes(trace, error);
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
    rtcReleaseDevice(trace->device);
    free(trace);
}

size_t trace_bytes(const struct trace *trace)
{
    long long bytes = atomic_load(&trace->bytes);
    return bytes > 0 ? (size_t)bytes : 0;
}

static void load_ray(ps_packet *packet, size_t lane, const ps_ray *ray)
{
    packet->origin_x[lane] = ray->origin.x;
    packet->origin_y[lane] = ray->origin.y;
    packet->origin_z[lane] = ray->origin.z;
    packet->tnear[lane] = ray->tnear;
    packet->direction_x[lane] = ray->direction.x;
    packet->direction_y[lane] = ray->direction.y;
    packet->direction_z[lane] = ray->direction.z;
    packet->tfar[lane] = ray->tfar;
}

/* Fills up to 16 lanes; the rest are marked invalid. */
static void load_rays(ps_packet *packet, int valid[PACKET], const ps_ray *rays, size_t n)
{
    memset(packet, 0, sizeof *packet);
    memset(packet->mask, 0xff, sizeof packet->mask);
    struct RTCRayHit16 *embree = (struct RTCRayHit16 *)(void *)packet;
    memset(embree->hit.geomID, 0xff, sizeof embree->hit.geomID);
    memset(embree->hit.instID, 0xff, sizeof embree->hit.instID);
    for (size_t lane = 0; lane < PACKET; lane++) {
        valid[lane] = lane < n ? -1 : 0;
        load_ray(packet, lane, &rays[lane < n ? lane : 0]);
    }
}

/* Barycentric interpolation of the vertices: more exact than origin + distance * direction. */
static ps_vec3 mesh_position(const struct shape *shape, uint32_t triangle, float u, float v)
{
    const uint32_t *corner = shape->triangles[triangle];
    ps_vec3 p = ps_scale(shape->vertices[corner[0]], 1.0f - u - v);
    p = ps_add_scaled(p, u, shape->vertices[corner[1]]);
    return ps_add_scaled(p, v, shape->vertices[corner[2]]);
}

static ps_vec3 sphere_position(const struct shape *shape, const ps_ray *ray, float distance)
{
    ps_vec3 p = ps_add_scaled(ray->origin, distance, ray->direction);
    ps_vec3 outward = ps_normalize(ps_subtract(p, shape->center));
    return ps_add_scaled(shape->center, shape->radius, outward);
}

static ps_hit resolve(const struct trace *trace, const ps_ray *ray, const struct RTCRayHit16 *hits,
                      size_t lane)
{
    uint32_t geometry = hits->hit.geomID[lane];
    if (geometry == RTC_INVALID_GEOMETRY_ID)
        return (ps_hit){.distance = INFINITY, .object = PS_NO_OBJECT};
    const struct shape *shape = &trace->scene->shapes[geometry];
    ps_vec3 normal = {hits->hit.Ng_x[lane], hits->hit.Ng_y[lane], hits->hit.Ng_z[lane]};
    /* By the largest component first: the square of a very small or large one is no float. */
    float largest = fmaxf(fabsf(normal.x), fmaxf(fabsf(normal.y), fabsf(normal.z)));
    normal = ps_normalize(ps_scale(normal, 1.0f / largest));
    if (ps_dot(normal, ray->direction) > 0.0f)
        normal = ps_scale(normal, -1.0f);
    float distance = hits->ray.tfar[lane];
    return (ps_hit){
        .position = shape->kind == SHAPE_MESH ? mesh_position(shape, hits->hit.primID[lane],
                                                              hits->hit.u[lane], hits->hit.v[lane])
                                              : sphere_position(shape, ray, distance),
        .distance = distance,
        .normal = normal,
        .object = geometry,
        .albedo = trace->scene->materials[shape->material].diffuse,
        .material = shape->material,
    };
}

void trace_intersect(const struct trace *trace, enum coherence coherence, const ps_ray *rays,
                     size_t n, ps_hit *hits)
{
    _Alignas(64) ps_packet packet;
    _Alignas(64) int valid[PACKET];
    for (size_t first = 0; first < n; first += PACKET) {
        size_t lanes = n - first < PACKET ? n - first : PACKET;
        load_rays(&packet, valid, rays + first, lanes);
        struct RTCRayHit16 *embree = (struct RTCRayHit16 *)(void *)&packet;
        shim_intersect16(valid, trace->embree, embree, coherence == RAYS_COHERENT);
        for (size_t lane = 0; lane < lanes; lane++)
            hits[first + lane] = resolve(trace, &rays[first + lane], embree, lane);
    }
}

void trace_occluded(const struct trace *trace, enum coherence coherence, const ps_ray *rays,
                    size_t n, uint8_t *blocked)
{
    _Alignas(64) ps_packet packet;
    _Alignas(64) int valid[PACKET];
    for (size_t first = 0; first < n; first += PACKET) {
        size_t lanes = n - first < PACKET ? n - first : PACKET;
        load_rays(&packet, valid, rays + first, lanes);
        struct RTCRayHit16 *embree = (struct RTCRayHit16 *)(void *)&packet;
        shim_occluded16(valid, trace->embree, &embree->ray, coherence == RAYS_COHERENT);
        for (size_t lane = 0; lane < lanes; lane++)
            blocked[first + lane] = packet.tfar[lane] < 0.0f; /* -inf: something was met */
    }
}

void trace_packets(const struct trace *trace, ps_packet *packets, size_t n)
{
    _Alignas(64) static const int valid[PACKET] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                   -1, -1, -1, -1, -1, -1, -1, -1};
    for (size_t i = 0; i < n; i++) {
        struct RTCRayHit16 *embree = (struct RTCRayHit16 *)(void *)&packets[i];
        memset(packets[i].time, 0, sizeof packets[i].time);
        memset(packets[i].mask, 0xff, sizeof packets[i].mask);
        memset(packets[i].flags, 0, sizeof packets[i].flags);
        memset(embree->hit.geomID, 0xff, sizeof embree->hit.geomID);
        memset(embree->hit.instID, 0xff, sizeof embree->hit.instID);
        shim_intersect16(valid, trace->embree, embree, 1);
    }
}
