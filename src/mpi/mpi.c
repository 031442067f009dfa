/* mpi.c: MPI as the transport of a job's processes (job/transport.h); a module of its own, which
 * only `--mpi` loads, so that the program neither needs MPI nor starts slower where it is there.
 *
 * MPI counts elements in an int, so large messages go in pieces. Whoever waits for a message asks
 * for it now and then, and sleeps between: MPI's own waiting takes a processor, from the passes of
 * its own process. Errors end the job, as MPI has it by default.
 */
#include "job/transport.h"

#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define MOST_BYTES ((size_t)16 << 20) /* of a piece */

static void send_bytes(int to, int tag, const void *bytes, size_t size)
{
    const char *rest = bytes;
    do {
        size_t piece = size < MOST_BYTES ? size : MOST_BYTES;
        MPI_Send(rest, (int)piece, MPI_BYTE, to, tag, MPI_COMM_WORLD);
        rest += piece;
        size -= piece;
    } while (size > 0);
}

#define SHORTEST_SLEEP 10000L /* nanoseconds */
#define LONGEST_SLEEP 1000000L

/* Waits until a message can be received; from whom. */
static int await_message(int from, int tag)
{
    struct timespec sleep = {.tv_nsec = SHORTEST_SLEEP};
    MPI_Status status;
    int there = 0;
    MPI_Iprobe(from, tag, MPI_COMM_WORLD, &there, &status);
    while (!there) {
        nanosleep(&sleep, NULL);
        sleep.tv_nsec = sleep.tv_nsec < LONGEST_SLEEP / 2 ? 2 * sleep.tv_nsec : LONGEST_SLEEP;
        MPI_Iprobe(from, tag, MPI_COMM_WORLD, &there, &status);
    }
    return status.MPI_SOURCE;
}

static void receive_bytes(int from, int tag, void *bytes, size_t size)
{
    char *rest = bytes;
    do {
        size_t piece = size < MOST_BYTES ? size : MOST_BYTES;
        await_message(from, tag);
        MPI_Recv(rest, (int)piece, MPI_BYTE, from, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        rest += piece;
        size -= piece;
    } while (size > 0);
}

/* Where there is no room for a piece, there is none for the job. */
static void skip_bytes(int from, int tag, size_t size)
{
    void *room = malloc(MOST_BYTES);
    if (!room)
        MPI_Abort(MPI_COMM_WORLD, 1);
    do {
        size_t piece = size < MOST_BYTES ? size : MOST_BYTES;
        receive_bytes(from, tag, room, piece);
        size -= piece;
    } while (size > 0);
    free(room);
}

static int receive_from_any(int tag, void *bytes, size_t size)
{
    int from = await_message(MPI_ANY_SOURCE, tag);
    MPI_Recv(bytes, (int)size, MPI_BYTE, from, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return from;
}

static void end(void)
{
    MPI_Finalize();
}

int psplat_transport_v1(struct transport *transport, char *message, size_t size);

int psplat_transport_v1(struct transport *transport, char *message, size_t size)
{
    int provided = MPI_THREAD_SINGLE;
    if (MPI_Init_thread(NULL, NULL, MPI_THREAD_MULTIPLE, &provided) != MPI_SUCCESS) {
        snprintf(message, size, "MPI could not be started");
        return 0;
    }
    if (provided < MPI_THREAD_MULTIPLE) {
        snprintf(message, size, "this MPI does not let several threads of a process use it");
        MPI_Finalize();
        return 0;
    }
    *transport = (struct transport){
        .send = send_bytes,
        .receive = receive_bytes,
        .skip = skip_bytes,
        .receive_any = receive_from_any,
        .end = end,
    };
    MPI_Comm_rank(MPI_COMM_WORLD, &transport->rank);
    MPI_Comm_size(MPI_COMM_WORLD, &transport->size);
    return 1;
}
