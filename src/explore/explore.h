/* explore.h: psplat explore: a scene in a browser, by a server on this machine's loopback. */
#ifndef EXPLORE_EXPLORE_H
#define EXPLORE_EXPLORE_H

#include "explore/option_list.h"

struct explore_request {
    const char *path;           /* of the scene */
    struct option_list fixed;   /* of the command line: what holds for all views */
    struct option_list options; /* what view a begins with */
    uint32_t passes;            /* 0: as many as is usual */
    uint16_t port;              /* 0: any that is free */
    bool opens_browser;
};

void explore_request_release(struct explore_request *request);

/* Serves until SIGINT or SIGTERM, which it takes once the scene is loaded; the address is printed
 * to stdout, and errors of the scene's text to stderr. PS_OK: it was ended so. Else the error says
 * why it could not begin. */
ps_result explore(struct explore_request *request, psplat_error *error);

#endif
