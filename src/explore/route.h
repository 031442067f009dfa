/* route.h: which address and method of a request that was let in leads to what; psplat-explore(1)
 * lists them. */
#ifndef EXPLORE_ROUTE_H
#define EXPLORE_ROUTE_H

#include "explore/answer.h"

struct route_request {
    struct explorer *explorer;
    struct MHD_Connection *connection;
    const char *method;
    const char *path; /* behind the token */
    char *body;       /* terminated; NULL: none */
    size_t length;
};

/* False where no answer could be sent. */
bool route(const struct route_request *request);

#endif
