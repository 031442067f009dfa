/* processes.h: the processes that share a job (option `mpi`), as one of them sees them.
 *
 * The first reads the scene, deals the passes out, and is the one that writes and tells; what goes
 * wrong in all of them is told by the first alone. Each of them has to come as far as the
 * agreement, or leave, since the others wait for it.
 */
#ifndef RENDER_JOB_PROCESSES_H
#define RENDER_JOB_PROCESSES_H

#include "job/transport.h"
#include <stdbool.h>
#include <stdint.h>

struct processes {
    struct transport transport;
    bool has_agreed; /* or disagreed, with the others */
};

/* Joins the others that mpirun started, once in a process. PS_ERROR_IO, PS_ERROR_MEMORY. */
ps_result processes_join(struct processes **processes, struct error *error);

/* Parts from the others, whatever became of the job; after all else. NULL is nothing. */
void processes_leave(struct processes *processes);

/* Whether this one writes and tells. NULL is a process that is alone. */
bool processes_is_first(const struct processes *processes);

/* Digest of a process that failed before it had a job. */
#define NO_JOB 0

/* Whether all have the same job. The first tells what is wrong, unless it failed itself; in the
 * others the error has no text then. */
ps_result processes_agree(struct processes *processes, uint64_t digest, struct error *error);

#endif
