/* film_message.h: films from process to process: the sums as they are, without loss.
 *
 * A plane after the other, so that the receiver needs room for one of them beside its own film.
 * Bytes: 8 for each value of a pixel that has a sum, 16 where sums are large (film/film_sum.h).
 */
#ifndef JOB_FILM_MESSAGE_H
#define JOB_FILM_MESSAGE_H

#include "film/film_sum.h"
#include "job/transport.h"

void film_message_send(const struct transport *transport, int to, int tag,
                       const struct film_sum *film);

/* Receives a film of the same job and adds it to `film`, which may have no planes yet. When out of
 * memory, PS_ERROR_MEMORY, the message is received to its end, and the film is lost: it is of no
 * passes then. */
ps_result film_message_merge(const struct transport *transport, int from, int tag,
                             struct film_sum *film, struct error *error);

#endif
