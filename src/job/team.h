/* team.h: processes that render one job together.
 *
 * Rank 0 deals the passes out, one by one to whoever asks, so that slow processes hold nobody up; a
 * thread of its own answers the others while it renders itself. Each rank adds its passes to a film
 * of its own. Now and then, when rank 0 wants to see the film of all, and at the end, the films are
 * gathered: along a binomial tree, each rank merges what its children send and passes the sum on,
 * in log2(size) steps. Sums are exact (film/exact_plane.h), so the film is that of one process, bit
 * for bit, whoever rendered what.
 *
 * Ranks other than 0 only render: budgets, files and signals are rank 0's, and a signal to one of
 * them ends the job as one to rank 0 does. A rank that dies takes the job with it, as is the way of
 * MPI; it goes on from its checkpoint.
 */
#ifndef JOB_TEAM_H
#define JOB_TEAM_H

#include "film/film_sum.h"
#include "job/transport.h"

struct team;

/* Whether all ranks come with the same digest; said to all of them. `odd_rank`: the first that
 * differs from rank 0, for rank 0. Every rank calls it once. */
bool team_agrees(const struct transport *transport, uint64_t digest, int *odd_rank);

/* Joins the others; `film`, which is borrowed, is this rank's. Rank 0 deals the passes from `first`
 * to before `end` that its film lacks. */
ps_result team_create(const struct transport *transport, struct film_sum *film, uint32_t first,
                      uint32_t end, struct team **team, struct error *error);

/* The next pass of this rank; false: there is none. Ranks other than 0 take part in gatherings on
 * the way; what fails there, team_end tells. */
bool team_next_pass(struct team *team, uint32_t *number);

/* Rank 0: gathers the films now. Its own then holds all passes that are done. */
ps_result team_gather(struct team *team, struct error *error);

/* Gathers the films for the last time, and ends dealing. `stopped`: this rank was told to stop, or
 * failed; the others stop after their passes, too. Each rank calls it once. */
ps_result team_end(struct team *team, bool stopped, struct error *error);

/* Rank 0: whether a rank was told to stop, or failed. Any thread. */
bool team_was_stopped(const struct team *team);

/* Rank 0: passes that are done, here or elsewhere, with those of the film at the start. */
uint32_t team_passes_done(const struct team *team);

/* After team_end. NULL is nobody. */
void team_destroy(struct team *team);

#endif
