/* scene_message.h: the scene that rank 0 has read, for all ranks, so that one process asks the
 * disk, whatever their number.
 *
 * Its description goes, with the bytes of its pictures, in blocks down a binomial tree: a rank
 * hands each block on before it looks at it. Ranks have to be the same program on the same kind of
 * machine; what differs, team_agrees finds.
 */
#ifndef JOB_SCENE_MESSAGE_H
#define JOB_SCENE_MESSAGE_H

#include "job/transport.h"
#include "scene/description.h"

/* Rank 0, once. NULL: there is no scene. The description is as before when it returns. */
void scene_message_send(const struct transport *transport, struct scene_description *description);

/* Every other rank, once. PS_ERROR_INVALID: rank 0 has no scene, or is another program;
 * PS_ERROR_MEMORY. The description is released by the caller in any case. */
ps_result scene_message_receive(const struct transport *transport,
                                struct scene_description *description, struct error *error);

/* The same where nobody wants it: hands it on to other ranks. */
void scene_message_skip(const struct transport *transport);

#endif
