/* host.h: the services of psplat/host.h, on top of a render's state. */
#ifndef HOST_HOST_H
#define HOST_HOST_H

#include "render/state.h"

/* Fills render->hosts, one for each kind of strategy and one for psplat itself. */
void host_create(struct render *render);

/* Each fills in its part of the services. */
void host_add_scene(ps_host *host);   /* rays, surfaces, triangles, the camera */
void host_add_lights(ps_host *host);  /* lights */
void host_add_tiles(ps_host *host);   /* tiles of the picture */
void host_add_photons(ps_host *host); /* photons and splats */

/* Whether a service may be called now; else the callback under way fails, with the service's
 * name. */
bool host_in_place(const ps_host *host, bool there, const char *service);

/* A call with an index that is too large: the callback under way fails. */
void host_refuse_index(const ps_host *host, const char *service, uint64_t index, uint64_t count);

/* Gives the caller as much of a struct as it knows: the size at its front, which must have been
 * set. */
void host_hand_over(const ps_host *host, const char *service, void *theirs, const void *ours,
                    uint32_t size);

/* Tells how far the pass's estimate is, 0..1. */
void host_tell_progress(const ps_host *host, double fraction);

/* Runs the loop, in which no other may begin. False, and nothing done, inside of another. */
bool host_loop(const ps_host *host, const char *service, uint64_t count, ps_body body, void *user);

/* Whether the user wants to stop. */
bool host_is_cancelled(const struct render *render);

#endif
