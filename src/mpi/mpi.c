/* mpi.c: MPI as the transport of a job's processes (job/transport.h); a module of its own, which only `--mpi` loads, so
 * that the program neither needs MPI nor starts slower where it is there.
 *
 * MPI counts elements in an int, so large messages go in pieces. Errors end the job, as MPI has it by default.
 */
#include "job/transport.h"

#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>

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

static void receive_bytes(int from, int tag, void *bytes, size_t size)
{
    char *rest = bytes;
    do {
        size_t piece = size < MOST_BYTES ? size : MOST_BYTES;
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
    MPI_Status status;
    MPI_Recv(bytes, (int)size, MPI_BYTE, MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &status);
    return status.MPI_SOURCE;
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
