#include "cli/tev.h"

#include <assert.h>
#include <errno.h>
#include <netdb.h>
#include <poll.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#define PATIENCE 5               /* seconds without any progress */
#define ROWS_BYTES (1024 * 1024) /* of samples in a packet, about */

enum packet_kind { CREATE_IMAGE = 4, UPDATE_IMAGE = 6 };

/* --- address
 * -------------------------------------------------------------------------------------- */

static bool is_port(const char *text)
{
    char *end;
    long port = strtol(text, &end, 10);
    return text[0] >= '0' && text[0] <= '9' && *end == '\0' && strlen(text) <= 5 && port >= 1 &&
           port <= UINT16_MAX;
}

bool tev_parse_address(const char *text, struct tev_address *address)
{
    *address = (struct tev_address){TEV_HOST, TEV_PORT};
    if (text[0] == '\0')
        return true;
    if (text[0] != ':')
        return false;
    bool has_brackets = text[1] == '[';
    const char *host = text + (has_brackets ? 2 : 1);
    size_t length = strcspn(host, has_brackets ? "]" : ":");
    const char *rest = host + length;
    if (has_brackets && *rest++ != ']')
        return false;
    if (length == 0 || length >= sizeof address->host)
        return false;
    snprintf(address->host, sizeof address->host, "%.*s", (int)length, host);
    if (*rest == '\0')
        return true;
    if (*rest != ':' || !is_port(rest + 1))
        return false;
    snprintf(address->port, sizeof address->port, "%s", rest + 1);
    return true;
}

/* --- connection
 * ----------------------------------------------------------------------------------- */

/* Waits for a connection under way; the reason where it fails. */
static int finish_connecting(int connection)
{
    struct pollfd wait = {.fd = connection, .events = POLLOUT};
    int reason = 0;
    socklen_t size = sizeof reason;
    int ready = poll(&wait, 1, PATIENCE * 1000);
    if (ready == 0)
        return ETIMEDOUT;
    if (ready < 0 || getsockopt(connection, SOL_SOCKET, SO_ERROR, &reason, &size) != 0)
        return errno;
    return reason;
}

/* Negative where it fails; errno says why. Sending blocks, for so long. */
static int connect_to(const struct addrinfo *at)
{
    int kind = at->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC;
    int connection = socket(at->ai_family, kind, at->ai_protocol);
    if (connection < 0)
        return -1;
    int reason = connect(connection, at->ai_addr, at->ai_addrlen) == 0 ? 0 : errno;
    if (reason == EINPROGRESS)
        reason = finish_connecting(connection);
    if (reason == 0)
        return connection;
    close(connection);
    errno = reason;
    return -1;
}

ps_result tev_connect(const struct tev_address *address, int *connection, struct error *error)
{
    const struct addrinfo hints = {.ai_socktype = SOCK_STREAM};
    struct addrinfo *found;
    *connection = -1;
    int failed = getaddrinfo(address->host, address->port, &hints, &found);
    if (failed != 0)
        return error_set(error, PS_ERROR_IO, "no viewer tev at %s: %s", address->host,
                         gai_strerror(failed));
    for (const struct addrinfo *at = found; at && *connection < 0; at = at->ai_next)
        *connection = connect_to(at);
    int reason = errno;
    freeaddrinfo(found);
    return *connection >= 0 ? PS_OK
                            : error_set(error, PS_ERROR_IO, "no viewer tev at %s, port %s: %s",
                                        address->host, address->port, strerror(reason));
}

static ps_result send_bytes(int connection, const char *bytes, size_t count, struct error *error)
{
    while (count > 0) {
        ssize_t sent = send(connection, bytes, count, MSG_NOSIGNAL);
        if (sent > 0) {
            bytes += sent;
            count -= (size_t)sent;
            continue;
        }
        struct pollfd wait = {.fd = connection, .events = POLLOUT};
        bool waits = sent < 0 && (errno == EAGAIN || errno == EINTR);
        if (!waits)
            return error_set(error, PS_ERROR_IO, "the viewer tev is gone: %s", strerror(errno));
        if (poll(&wait, 1, PATIENCE * 1000) == 0)
            return error_set(error, PS_ERROR_IO, "the viewer tev took nothing for %d seconds",
                             PATIENCE);
    }
    return PS_OK;
}

/* --- packets
 * -------------------------------------------------------------------------------------- */

/* A packet that grows; `bytes` is NULL when out of memory. */
struct packet {
    FILE *stream;
    char *bytes;
    size_t length;
};

static void put(struct packet *packet, const void *bytes, size_t count)
{
    fwrite(bytes, 1, count, packet->stream);
}

static void put_byte(struct packet *packet, int value)
{
    fputc(value, packet->stream);
}

static void put_int(struct packet *packet, size_t value)
{
    int32_t number = (int32_t)value;
    put(packet, &number, sizeof number);
}

static void put_long(struct packet *packet, int64_t value)
{
    put(packet, &value, sizeof value);
}

static void put_text(struct packet *packet, const char *text)
{
    put(packet, text, strlen(text) + 1);
}

static bool begin(struct packet *packet, enum packet_kind kind, bool takes_focus, const char *name)
{
    *packet = (struct packet){.bytes = NULL};
    packet->stream = open_memstream(&packet->bytes, &packet->length);
    if (!packet->stream)
        return false;
    put_int(packet, 0); /* the length, which is not known yet */
    put_byte(packet, kind);
    put_byte(packet, takes_focus);
    put_text(packet, name);
    return true;
}

static ps_result end_and_send(struct packet *packet, int connection, struct error *error)
{
    bool there = !ferror(packet->stream);
    there &= fclose(packet->stream) == 0;
    ps_result result = PS_OK;
    if (there) {
        uint32_t length = (uint32_t)packet->length;
        memcpy(packet->bytes, &length, sizeof length);
        result = send_bytes(connection, packet->bytes, packet->length, error);
    } else {
        result = error_memory(error, packet->length, "a packet for tev");
    }
    free(packet->bytes);
    return result;
}

/* What is shown: some channels of a picture. */
struct shown {
    const psplat_picture *picture;
    bool has_display;
};

/* NULL: it has no other. `channel` goes on to the one after it. */
static const char *next_channel(const struct shown *shown, size_t *channel)
{
    for (;;) {
        const char *name = psplat_picture_channel_name(shown->picture, (*channel)++);
        if (!name || shown->has_display || strncmp(name, "display.", 8) != 0)
            return name;
    }
}

static ps_result create_image(int connection, const char *name, const struct shown *shown,
                              struct error *error)
{
    struct packet packet;
    const char *channel;
    size_t count = 0;
    if (!begin(&packet, CREATE_IMAGE, true, name))
        return error_memory(error, 4096, "a packet for tev");
    for (size_t next = 0; next_channel(shown, &next);)
        count++;
    put_int(&packet, psplat_picture_width(shown->picture));
    put_int(&packet, psplat_picture_height(shown->picture));
    put_int(&packet, count);
    for (size_t next = 0; (channel = next_channel(shown, &next));)
        put_text(&packet, channel);
    return end_and_send(&packet, connection, error);
}

static ps_result update_rows(int connection, const char *name, const struct shown *shown,
                             const char *channel, size_t row, size_t rows, struct error *error)
{
    struct packet packet;
    size_t width = psplat_picture_width(shown->picture), pixels = rows * width;
    const float *samples = psplat_picture_channel(shown->picture, channel) + row * width;
    if (!begin(&packet, UPDATE_IMAGE, false, name))
        return error_memory(error, pixels * sizeof *samples, "a packet for tev");
    put_int(&packet, 1); /* channels */
    put_text(&packet, channel);
    put_int(&packet, 0);
    put_int(&packet, row);
    put_int(&packet, width);
    put_int(&packet, rows);
    put_long(&packet,
             0); /* where the channel begins among the floats, and the step to the next pixel */
    put_long(&packet, 1);
    put(&packet, samples, pixels * sizeof *samples);
    return end_and_send(&packet, connection, error);
}

ps_result tev_send(int connection, const char *name, const psplat_picture *picture,
                   bool has_display, bool is_new, struct error *error)
{
    const struct shown shown = {picture, has_display};
    size_t height = psplat_picture_height(picture);
    size_t at_once = ROWS_BYTES / (psplat_picture_width(picture) * sizeof(float)) + 1;
    ps_result result = is_new ? create_image(connection, name, &shown, error) : PS_OK;
    assert(strlen(name) < 256);
    for (size_t row = 0; row < height && result == PS_OK; row += at_once) {
        size_t left = height - row, rows = left < at_once ? left : at_once;
        const char *channel;
        for (size_t next = 0; result == PS_OK && (channel = next_channel(&shown, &next));)
            result = update_rows(connection, name, &shown, channel, row, rows, error);
    }
    return result;
}
