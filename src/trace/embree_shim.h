/* embree_shim.h: the part of Embree that psplat uses, the same for Embree 3.13 and 4.
 *
 * Embree 4 renamed the query context, moved its flags to an arguments struct and changed the order
 * of arguments; everything else in use is alike.
 */
#ifndef TRACE_EMBREE_SHIM_H
#define TRACE_EMBREE_SHIM_H

#if defined(PSPLAT_EMBREE4)
#include <embree4/rtcore.h>

static inline void shim_intersect16(const int *valid, RTCScene scene, struct RTCRayHit16 *rays,
                                    int coherent)
{
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcIntersect16(valid, scene, rays, &arguments);
}

static inline void shim_occluded16(const int *valid, RTCScene scene, struct RTCRay16 *rays,
                                   int coherent)
{
    struct RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcOccluded16(valid, scene, rays, &arguments);
}

#else
#include <embree3/rtcore.h>

static inline void shim_intersect16(const int *valid, RTCScene scene, struct RTCRayHit16 *rays,
                                    int coherent)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags =
        coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    rtcIntersect16(valid, scene, &context, rays);
}

static inline void shim_occluded16(const int *valid, RTCScene scene, struct RTCRay16 *rays,
                                   int coherent)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags =
        coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    rtcOccluded16(valid, scene, &context, rays);
}
#endif

/* Members of lane `lane` of a filter's N rays, likewise (below), in the order of struct
 * RTCRay16. */
static inline float shim_ray_direction(const struct RTCRayN *rays, unsigned n, unsigned lane,
                                       unsigned axis)
{
    return ((const float *)(const void *)rays)[(4 + axis) * n + lane];
}

static inline unsigned shim_ray_mask(const struct RTCRayN *rays, unsigned n, unsigned lane)
{
    return ((const unsigned *)(const void *)rays)[9 * n + lane];
}

/* Members of lane `lane` of a filter's N hits, for which Embree has accessors in C++ alone: arrays
 * of N in the order of struct RTCHit16. */
static inline float shim_hit_normal(const struct RTCHitN *hits, unsigned n, unsigned lane,
                                    unsigned axis)
{
    return ((const float *)(const void *)hits)[axis * n + lane];
}

/* RTC_INVALID_GEOMETRY_ID outside of instances. */
static inline unsigned shim_hit_instance(const struct RTCHitN *hits, unsigned n, unsigned lane)
{
    return ((const unsigned *)(const void *)hits)[7 * n + lane];
}

static inline unsigned shim_hit_triangle(const struct RTCHitN *hits, unsigned n, unsigned lane)
{
    return ((const unsigned *)(const void *)hits)[5 * n + lane];
}

static inline unsigned shim_hit_geometry(const struct RTCHitN *hits, unsigned n, unsigned lane)
{
    return ((const unsigned *)(const void *)hits)[6 * n + lane];
}

static inline float shim_hit_u(const struct RTCHitN *hits, unsigned n, unsigned lane)
{
    return ((const float *)(const void *)hits)[3 * n + lane];
}

static inline float shim_hit_v(const struct RTCHitN *hits, unsigned n, unsigned lane)
{
    return ((const float *)(const void *)hits)[4 * n + lane];
}

#endif
