/* child.h: runs a function in a child process, so that a crash in it is an error message here.
 *
 * fork() without exec: the child has all that the caller has, and needs no program of its own that
 * would have to be found. It is for code that is not ours and is given files that are not ours. A
 * crash, more memory or more time than the limits end the child alone.
 */
#ifndef IMPORT_CHILD_H
#define IMPORT_CHILD_H

#include "base/error.h"
#include <stdbool.h>

struct child_limits {
    /* Of memory, beside what the caller has; infinite, or under sanitizers: no limit. */
    double bytes;
    unsigned seconds; /* of processor time; child_extend_time adds to it */
};

/* Runs `work` in a child and waits for its end. What it is to leave must go through a file or
 * shared memory. PS_ERROR_IO where the system gives no process; PS_ERROR_INVALID, with how it ended
 * ("crashed (Aborted)"), unless `work` returned. */
ps_result child_run(void (*work)(void *context), void *context, const struct child_limits *limits,
                    struct error *error);

/* Whether limits on memory hold in this build. */
bool child_has_memory_limit(void);

/* Within `work`: as many seconds more. */
void child_extend_time(unsigned seconds);

#endif
