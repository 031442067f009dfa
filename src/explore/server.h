/* server.h: an explorer's HTTP server, by libmicrohttpd; the addresses are in psplat-explore(1).
 *
 * It listens on 127.0.0.1 alone. All addresses begin with a token of 128 random bits, which other
 * users of the machine and other pages in the browser don't know; and a request has to name this
 * server as its host, and as its origin if it names one, so that no other name leads here (DNS
 * rebinding) and no other page's script.
 */
#ifndef EXPLORE_SERVER_H
#define EXPLORE_SERVER_H

#include "explore/explorer.h"

#define TOKEN_LENGTH 32 /* hexadecimal digits */

struct MHD_Daemon;

struct server {
    struct explorer *explorer;
    struct MHD_Daemon *daemon;
    uint16_t port;
    char token[TOKEN_LENGTH + 1];
    char hosts[2][32]; /* that a request may name */
};

/* Starts it. `port` 0: any that is free. PS_ERROR_IO, with why. It stays where it is. */
ps_result server_start(struct server *server, struct explorer *explorer, uint16_t port,
                       struct error *error);

/* After explorer_stop. Waits for requests that are under way. */
void server_stop(struct server *server);

#endif
