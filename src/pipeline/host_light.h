/* host_light.h: the part of the host's services that follows light: rays, surfaces, lights. */
#ifndef PIPELINE_HOST_LIGHT_H
#define PIPELINE_HOST_LIGHT_H

#include <psplat/host.h>

/* Fills in the functions from intersect to emitted_radiance that trace and light need. */
void host_add_light_transport(ps_host *host);

#endif
