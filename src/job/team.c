#include "job/team.h"

#include "job/film_message.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

/* Of a rank that asks for work. */
struct request {
    uint32_t done;    /* 1: it has rendered what it was last dealt */
    uint32_t stopped; /* 1: it was told to stop, or failed */
};

enum order_kind { ORDER_PASS, ORDER_GATHER, ORDER_END };

struct order {
    uint32_t kind; /* enum order_kind */
    uint32_t pass;
};

/* What rank 0 knows of another one. */
struct member {
    bool waits; /* for an order */
    bool told;  /* of the gathering, or end, that is called for */
};

struct team {
    const struct transport *transport;
    struct film_sum *film;
    bool has_pass;      /* in hand, of this rank */
    bool was_told_end;  /* this rank, by rank 0 */
    ps_result gathered; /* the first failure of a gathering */
    struct error error; /* its reason */
    /* Of rank 0. */
    pthread_t dealer;
    bool has_dealer;
    pthread_mutex_t lock; /* of what follows */
    struct member *members;
    struct pass_set before; /* passes that need not be made */
    uint32_t next, end;     /* to be dealt */
    enum order_kind call;   /* what ranks are called to; ORDER_PASS: to work */
    _Atomic(bool) stopped;
    _Atomic(uint32_t) done;
};

/* --- dealing, under the lock of rank 0
 * -------------------------------------------------------------- */

/* The next pass that nobody has; false where there is none. */
static bool deal(struct team *team, uint32_t *pass)
{
    *pass = pass_set_next_missing(&team->before, team->next);
    if (*pass >= team->end || atomic_load(&team->stopped))
        return false;
    team->next = *pass + 1;
    return true;
}

/* Gives a rank that waits something to do. Without passes it goes on waiting, for the end, unless
 * there are some when it is asked next. */
static void answer(struct team *team, int rank)
{
    struct member *member = &team->members[rank];
    struct order order = {.kind = (uint32_t)team->call};
    if (team->call == ORDER_PASS ? !deal(team, &order.pass) : member->told)
        return;
    member->waits = false;
    member->told = team->call != ORDER_PASS;
    team->transport->send(rank, TAG_ORDER, &order, sizeof order);
}

/* Calls all ranks to something else. */
static void call_to(struct team *team, enum order_kind call)
{
    pthread_mutex_lock(&team->lock);
    team->call = call;
    for (int rank = 1; rank < team->transport->size; rank++)
        team->members[rank].told = false;
    for (int rank = 1; rank < team->transport->size; rank++)
        if (team->members[rank].waits)
            answer(team, rank);
    pthread_mutex_unlock(&team->lock);
}

static bool all_told_of_end(const struct team *team)
{
    bool told = team->call == ORDER_END;
    for (int rank = 1; rank < team->transport->size; rank++)
        told &= team->members[rank].told;
    return told;
}

static void *answer_requests(void *user)
{
    struct team *team = user;
    bool ended = false;
    while (!ended) {
        struct request request;
        int rank = team->transport->receive_any(TAG_REQUEST, &request, sizeof request);
        pthread_mutex_lock(&team->lock);
        atomic_fetch_add(&team->done, request.done);
        if (request.stopped)
            atomic_store(&team->stopped, true);
        /* Rank 0 sends one when it has called to the end, of which some may have been told by
         * that. */
        if (rank > 0) {
            team->members[rank].waits = true;
            answer(team, rank);
        }
        ended = all_told_of_end(team);
        pthread_mutex_unlock(&team->lock);
    }
    return NULL;
}

/* --- starting
 * --------------------------------------------------------------------------------------- */

bool team_agrees(const struct transport *transport, uint64_t digest, int *odd_rank)
{
    uint32_t verdict = 1;
    *odd_rank = 0;
    if (transport->rank > 0) {
        transport->send(0, TAG_DIGEST, &digest, sizeof digest);
        transport->receive(0, TAG_VERDICT, &verdict, sizeof verdict);
        return verdict != 0;
    }
    for (int rank = transport->size - 1; rank > 0; rank--) {
        uint64_t other;
        transport->receive(rank, TAG_DIGEST, &other, sizeof other);
        *odd_rank = other == digest ? *odd_rank : rank;
    }
    verdict = *odd_rank == 0;
    for (int rank = 1; rank < transport->size; rank++)
        transport->send(rank, TAG_VERDICT, &verdict, sizeof verdict);
    return verdict != 0;
}

/* Rank 0 alone. */
static ps_result start_dealing(struct team *team, struct error *error)
{
    size_t members = (size_t)team->transport->size * sizeof *team->members;
    ps_result result = pass_set_add_all(&team->before, &team->film->passes, error);
    team->members = calloc((size_t)team->transport->size, sizeof *team->members);
    atomic_store(&team->done, pass_set_size(&team->before));
    if (result == PS_OK && !team->members)
        result = error_memory(error, members, "the ranks of the job");
    if (result != PS_OK || team->transport->size == 1)
        return result;
    team->has_dealer = pthread_create(&team->dealer, NULL, answer_requests, team) == 0;
    return team->has_dealer ? PS_OK
                            : error_set(error, PS_ERROR_MEMORY, "no thread to deal passes with");
}

ps_result team_create(const struct transport *transport, struct film_sum *film, uint32_t first,
                      uint32_t end, struct team **created, struct error *error)
{
    struct team *team = calloc(1, sizeof *team);
    if (!team)
        return error_memory(error, sizeof *team, "the ranks of the job");
    team->transport = transport;
    team->film = film;
    team->next = first;
    team->end = end;
    team->gathered = PS_OK;
    pthread_mutex_init(&team->lock, NULL);
    *created = team;
    return transport->rank == 0 ? start_dealing(team, error) : PS_OK;
}

/* --- gathering
 * -------------------------------------------------------------------------------------- */

/* A rank receives from those 1, 2, 4, ... above it while that bit of its own number is 0, and then
 * sends the sum to the one below it by its lowest bit. */
static void gather(struct team *team)
{
    const struct transport *transport = team->transport;
    for (int step = 1; step < transport->size; step *= 2) {
        struct error error;
        if (transport->rank & step) {
            film_message_send(transport, transport->rank - step, TAG_FILM, team->film);
            film_sum_clear(team->film);
            return;
        }
        if (transport->rank + step >= transport->size)
            continue;
        ps_result merged =
            film_message_merge(transport, transport->rank + step, TAG_FILM, team->film, &error);
        if (merged != PS_OK && team->gathered == PS_OK) {
            team->gathered = merged;
            team->error = error;
        }
    }
}

static ps_result result_of_gathering(const struct team *team, struct error *error)
{
    if (team->gathered != PS_OK)
        *error = team->error;
    return team->gathered;
}

ps_result team_gather(struct team *team, struct error *error)
{
    call_to(team, ORDER_GATHER);
    gather(team);
    call_to(team, ORDER_PASS);
    return result_of_gathering(team, error);
}

/* --- the render's side
 * ------------------------------------------------------------------------------ */

/* Another rank asks rank 0 what to do, and gathers until it is something else. */
static struct order next_order(struct team *team, bool stopped)
{
    struct order order = {.kind = ORDER_GATHER};
    while (order.kind == ORDER_GATHER) {
        stopped |= team->gathered != PS_OK;
        struct request request = {.done = team->has_pass && !stopped, .stopped = stopped};
        team->has_pass = false;
        team->transport->send(0, TAG_REQUEST, &request, sizeof request);
        team->transport->receive(0, TAG_ORDER, &order, sizeof order);
        if (order.kind == ORDER_GATHER)
            gather(team);
    }
    team->has_pass = order.kind == ORDER_PASS;
    team->was_told_end = order.kind == ORDER_END;
    return order;
}

static bool deal_to_rank_0(struct team *team, uint32_t *number)
{
    pthread_mutex_lock(&team->lock);
    atomic_fetch_add(&team->done, team->has_pass);
    team->has_pass = deal(team, number);
    pthread_mutex_unlock(&team->lock);
    return team->has_pass;
}

bool team_next_pass(struct team *team, uint32_t *number)
{
    if (team->transport->rank == 0)
        return deal_to_rank_0(team, number);
    struct order order = next_order(team, false);
    *number = order.pass;
    return order.kind == ORDER_PASS;
}

static void end_dealing(struct team *team, bool stopped)
{
    atomic_fetch_add(&team->done, team->has_pass && !stopped);
    if (stopped)
        atomic_store(&team->stopped, true);
    call_to(team, ORDER_END);
    struct request wake = {.done = 0};
    if (team->has_dealer)
        team->transport->send(0, TAG_REQUEST, &wake, sizeof wake);
}

ps_result team_end(struct team *team, bool stopped, struct error *error)
{
    if (team->transport->rank == 0)
        end_dealing(team, stopped);
    while (team->transport->rank > 0 && !team->was_told_end)
        next_order(team, stopped);
    gather(team);
    if (team->has_dealer)
        pthread_join(team->dealer, NULL);
    return result_of_gathering(team, error);
}

bool team_was_stopped(const struct team *team)
{
    return atomic_load(&team->stopped);
}

uint32_t team_passes_done(const struct team *team)
{
    return atomic_load(&team->done);
}

void team_destroy(struct team *team)
{
    if (!team)
        return;
    pthread_mutex_destroy(&team->lock);
    pass_set_release(&team->before);
    free(team->members);
    free(team);
}
