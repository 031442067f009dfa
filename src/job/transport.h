/* transport.h: how processes that render one job together reach each other.
 *
 * Messages between two processes arrive in the order in which they are sent, for each tag. Several
 * threads of a process may use it at once. What fails ends the process: there is nobody left to
 * tell.
 */
#ifndef JOB_TRANSPORT_H
#define JOB_TRANSPORT_H

#include "base/error.h"
#include <stddef.h>

/* What a message is about. */
enum transport_tag { TAG_REQUEST, TAG_ORDER, TAG_FILM, TAG_DIGEST, TAG_VERDICT, TAG_SCENE };

struct transport {
    int rank, size; /* 0 <= rank < size */
    /* Returns when `bytes` may change. Any size. */
    void (*send)(int to, int tag, const void *bytes, size_t size);
    /* Waits for a message of exactly that size. */
    void (*receive)(int from, int tag, void *bytes, size_t size);
    /* The same, and drops it. */
    void (*skip)(int from, int tag, size_t size);
    /* The same as receive, of a small message from whoever sends first; returns who. */
    int (*receive_any)(int tag, void *bytes, size_t size);
    /* After the last message; all processes call it. */
    void (*end)(void);
};

/* What a module exports by the name TRANSPORT_ENTRY: joins the job's other processes, once. 0, and
 * why in `message`, where that fails. The name changes with struct transport. */
#define TRANSPORT_ENTRY "psplat_transport_v1"
typedef int (*transport_entry)(struct transport *transport, char *message, size_t size);

/* Loads the module for MPI, which lies beside the folder of psplat's plugins, and joins.
 * PS_ERROR_IO where psplat was built without it; the module stays loaded. */
ps_result transport_load_mpi(struct transport *transport, struct error *error);

#endif
