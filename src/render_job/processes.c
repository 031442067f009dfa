#include "render_job/processes.h"

#include "job/team.h"
#include <stdlib.h>

ps_result processes_join(struct processes **processes, struct error *error)
{
    struct processes *joined = calloc(1, sizeof *joined);
    if (!joined)
        return error_memory(error, sizeof *joined, "processes");
    ps_result result = transport_load_mpi(&joined->transport, error);
    if (result == PS_OK)
        *processes = joined;
    else
        free(joined);
    return result;
}

void processes_leave(struct processes *processes)
{
    struct error error;
    if (!processes)
        return;
    if (!processes->has_agreed)
        processes_agree(processes, NO_JOB, &error);
    processes->transport.end();
    free(processes);
}

bool processes_is_first(const struct processes *processes)
{
    return !processes || processes->transport.rank == 0;
}

ps_result processes_agree(struct processes *processes, uint64_t digest, struct error *error)
{
    int odd_rank;
    processes->has_agreed = true;
    if (team_agrees(&processes->transport, digest, &odd_rank))
        return PS_OK;
    if (digest == NO_JOB)
        return PS_ERROR_INVALID;
    if (!processes_is_first(processes))
        error->text[0] = '\0';
    else
        error_set(error, PS_ERROR_INVALID,
                  "--mpi: process %d can't load the scene, or has another scene, other settings or "
                  "another instruction set (see --isa)",
                  odd_rank);
    return PS_ERROR_INVALID;
}
