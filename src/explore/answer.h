/* answer.h: answers to requests, each with the headers that keep a page to itself. */
#ifndef EXPLORE_ANSWER_H
#define EXPLORE_ANSWER_H

#include "explore/explorer.h"
#include <microhttpd.h>

/* Each sends it; false where that fails, which ends the connection. */

/* No content, or a line of text about an error. */
bool answer_status(struct MHD_Connection *connection, unsigned status, const char *text);

/* `text`: JSON, which it frees; NULL: memory is out. */
bool answer_json(struct MHD_Connection *connection, unsigned status, char *text);

/* {"message": ...} */
bool answer_message(struct MHD_Connection *connection, unsigned status, const char *message);

/* Bytes that stay. */
bool answer_bytes(struct MHD_Connection *connection, const char *type, const void *bytes,
                  size_t length);

/* A layer of a picture; 404 where it has none of that name, or `shown` is NULL, to which it takes
 * over the reference. */
bool answer_picture(struct MHD_Connection *connection, struct shown_picture *shown,
                    const char *layer);

/* A map of one channel, of the picture's size and with its number, likewise; it is copied. */
bool answer_map(struct MHD_Connection *connection, const struct shown_picture *shown,
                const float *map);

/* State after state, until the connection or the explorer ends. */
bool answer_events(struct MHD_Connection *connection, struct explorer *explorer);

#endif
