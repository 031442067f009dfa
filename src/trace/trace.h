/* trace.h: ray queries against a scene. The only module that knows Embree.
 *
 * All queries may run on any number of threads at once, and a ray's answer does not depend on the
 * rays that travel beside it.
 */
#ifndef TRACE_TRACE_H
#define TRACE_TRACE_H

#include "scene/scene.h"
#include <psplat/types.h>

struct trace;

/* Coherent rays run close together; those of the camera do, and do not see hidden objects. */
enum ray_kind { RAYS_INCOHERENT, RAYS_COHERENT, RAYS_CAMERA };

/* Builds the acceleration structure over the scene, which must outlive it. `isa`: "baseline",
 * "avx2" or "avx512" limits the instructions used, NULL does not. */
ps_result trace_create(const struct scene *scene, const char *isa, struct trace **trace,
                       struct error *error);
void trace_destroy(struct trace *trace);

/* Bytes that the acceleration structure takes now. */
size_t trace_bytes(const struct trace *trace);

/* First hits of n rays. `spreads`: of the cones that they stand for (surface_resolve); NULL:
 * none. */
void trace_intersect(const struct trace *trace, enum ray_kind kind, const ps_ray *rays,
                     const float *spreads, size_t n, ps_hit *hits);

/* The same, but a ray that meets a surface without PS_HIT_SPECULAR first has no hit. */
void trace_intersect_specular(const struct trace *trace, const ps_ray *rays, size_t n,
                              ps_hit *hits);

/* 1 where something lies between tnear and tfar. */
void trace_occluded(const struct trace *trace, const ps_ray *rays, size_t n, uint8_t *blocked);

/* Shortens tfar of each ray of n packets to its first hit. `coherent`: whether rays of a packet run
 * close together. */
void trace_packets(const struct trace *trace, ps_ray_packet *packets, size_t n, bool coherent);

#endif
