/* tev.h: the protocol by which other programs show pictures in the viewer tev
 * (github.com/Tom94/tev).
 *
 * Packets over TCP: a length of 32 bits that counts itself, a byte for the kind, and fields of 32
 * or 64 bits, texts that end in 0, and floats, all in the order of bytes of this machine. A picture
 * is created by name, size and names of channels; then its channels are sent, rows at a time. The
 * viewer answers nothing.
 */
#ifndef CLI_TEV_H
#define CLI_TEV_H

#include "base/error.h"
#include <psplat/psplat.h>
#include <stdbool.h>

#define TEV_HOST "127.0.0.1"
#define TEV_PORT "14158"

struct tev_address {
    char host[256], port[8];
};

/* Reads what follows the viewer's name: "", ":HOST", or ":HOST:PORT", where a host of colons has
 * brackets. False: another text. */
bool tev_parse_address(const char *text, struct tev_address *address);

/* Connects; the caller closes the socket. Neither this nor sending waits longer than some seconds
 * for a viewer that does nothing: PS_ERROR_IO. Any thread. */
ps_result tev_connect(const struct tev_address *address, int *connection, struct error *error);

/* Shows the channels of a picture under a name of less than 256 characters; what a display shows,
 * "display.R", if `has_display`. `is_new`: the viewer does not have it yet. */
ps_result tev_send(int connection, const char *name, const psplat_picture *picture,
                   bool has_display, bool is_new, struct error *error);

#endif
