#include "explore/answer.h"

#include "explore/json_text.h"
#include "explore/state.h"
#include <stdlib.h>
#include <string.h>

static const char *const headers[][2] = {
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
     "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cache-Control", "no-store"},
    /* So that nobody keeps a connection, of which there are few, for later. */
    {"Connection", "close"},
};

/* Takes the response over. */
static bool send_response(struct MHD_Connection *connection, unsigned status, const char *type,
                          struct MHD_Response *response)
{
    bool good = response != NULL;
    if (good && type)
        good = MHD_add_response_header(response, "Content-Type", type) == MHD_YES;
    for (size_t i = 0; i < sizeof headers / sizeof headers[0] && good; i++)
        good = MHD_add_response_header(response, headers[i][0], headers[i][1]) == MHD_YES;
    good = good && MHD_queue_response(connection, status, response) == MHD_YES;
    if (response)
        MHD_destroy_response(response);
    return good;
}

/* libmicrohttpd promises not to write to it. */
static void *readable(const void *bytes)
{
    union {
        const void *constant;
        void *variable;
    } pointer = {bytes};
    return pointer.variable;
}

bool answer_bytes(struct MHD_Connection *connection, const char *type, const void *bytes,
                  size_t length)
{
    return send_response(
        connection, MHD_HTTP_OK, type,
        MHD_create_response_from_buffer(length, readable(bytes), MHD_RESPMEM_PERSISTENT));
}

bool answer_status(struct MHD_Connection *connection, unsigned status, const char *text)
{
    size_t length = strlen(text);
    return send_response(
        connection, status, length > 0 ? "text/plain; charset=utf-8" : NULL,
        MHD_create_response_from_buffer(length, readable(text), MHD_RESPMEM_MUST_COPY));
}

bool answer_json(struct MHD_Connection *connection, unsigned status, char *text)
{
    if (!text)
        return answer_status(connection, MHD_HTTP_INTERNAL_SERVER_ERROR, "out of memory\n");
    struct MHD_Response *response =
        MHD_create_response_from_buffer(strlen(text), text, MHD_RESPMEM_MUST_FREE);
    if (!response)
        free(text);
    return send_response(connection, status, "application/json", response);
}

bool answer_message(struct MHD_Connection *connection, unsigned status, const char *message)
{
    struct json_buffer buffer;
    if (!json_buffer_begin(&buffer))
        return answer_json(connection, status, NULL);
    json_writer_open(&buffer.writer, '{');
    json_text_write_of(&buffer.writer, "message", message);
    json_writer_close(&buffer.writer, '{');
    return answer_json(connection, status, json_buffer_end(&buffer));
}

/* --- pictures
 * ---------------------------------------------------------------------------------------- */

#define BLOCK_BYTES ((size_t)256 * 1024)

struct sent_layer {
    struct shown_picture *shown; /* one reference */
    struct shown_layer layer;
};

static ssize_t read_layer(void *user, uint64_t at, char *bytes, size_t most)
{
    const struct sent_layer *sent = user;
    return (ssize_t)shown_layer_read(sent->shown, &sent->layer, at, bytes, most);
}

static void end_layer(void *user)
{
    struct sent_layer *sent = user;
    shown_picture_release(sent->shown);
    free(sent);
}

bool answer_picture(struct MHD_Connection *connection, struct shown_picture *shown,
                    const char *layer)
{
    struct sent_layer *sent = calloc(1, sizeof *sent);
    if (!sent || !shown || !layer || !shown_picture_layer(shown, layer, &sent->layer)) {
        bool memory = sent != NULL;
        shown_picture_release(shown);
        free(sent);
        return memory ? answer_status(connection, MHD_HTTP_NOT_FOUND, "no such picture\n")
                      : answer_json(connection, MHD_HTTP_OK, NULL);
    }
    sent->shown = shown;
    struct MHD_Response *response = MHD_create_response_from_callback(
        shown_layer_bytes(shown, &sent->layer), BLOCK_BYTES, read_layer, sent, end_layer);
    if (!response)
        end_layer(sent);
    return send_response(connection, MHD_HTTP_OK, "application/octet-stream", response);
}

bool answer_map(struct MHD_Connection *connection, const struct shown_picture *shown,
                const float *map)
{
    const struct shown_layer layer = {.name = "", .channel_count = 1, .planes = {map}};
    size_t length = shown_layer_bytes(shown, &layer);
    char *bytes = malloc(length);
    if (!bytes)
        return answer_json(connection, MHD_HTTP_OK, NULL);
    shown_layer_read(shown, &layer, 0, bytes, length);
    struct MHD_Response *response =
        MHD_create_response_from_buffer(length, bytes, MHD_RESPMEM_MUST_FREE);
    if (!response)
        free(bytes);
    return send_response(connection, MHD_HTTP_OK, "application/octet-stream", response);
}

/* --- events
 * ------------------------------------------------------------------------------------------ */

/* Server-sent events (https://html.spec.whatwg.org/#server-sent-events): the text of one at a time,
 * made when the reader has taken the last, so that a slow one misses states. */
struct event_stream {
    struct explorer *explorer;
    uint64_t serial; /* of the state that was sent last */
    bool has_begun;
    char *text; /* NULL: none; owned */
    size_t length, sent;
};

#define EVENT_BLOCK_BYTES ((size_t)16 * 1024)
#define PAUSE_SECONDS 0.1 /* between states */
#define COMMENT_SECONDS                                                                            \
    10.0 /* a comment then, from which a reader knows that the server is there */

static struct timespec after(double seconds)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    long whole = (long)seconds;
    time.tv_sec += whole;
    time.tv_nsec += (long)((seconds - (double)whole) * 1e9);
    if (time.tv_nsec >= 1000000000) {
        time.tv_sec++;
        time.tv_nsec -= 1000000000;
    }
    return time;
}

/* Waits for a state that was not sent; false: there is none. */
static bool wait_for_change(struct event_stream *stream)
{
    struct explorer *explorer = stream->explorer;
    const struct timespec pause = after(PAUSE_SECONDS), end = after(COMMENT_SECONDS);
    int result = 0;
    pthread_mutex_lock(&explorer->lock);
    while (stream->has_begun && !atomic_load(&explorer->stopping) && result == 0)
        result = pthread_cond_timedwait(&explorer->changed, &explorer->lock, &pause);
    result = 0;
    while (explorer->serial == stream->serial && !atomic_load(&explorer->stopping) && result == 0)
        result = pthread_cond_timedwait(&explorer->changed, &explorer->lock, &end);
    bool changed = explorer->serial != stream->serial;
    pthread_mutex_unlock(&explorer->lock);
    stream->has_begun = true;
    return changed;
}

/* False when out of memory. */
static bool next_event(struct event_stream *stream)
{
    bool changed = wait_for_change(stream);
    char *state = changed ? state_write(stream->explorer, &stream->serial) : NULL;
    free(stream->text);
    stream->text = NULL;
    stream->sent = 0;
    int length = -1;
    if (!changed || state)
        length = changed ? asprintf(&stream->text, "event: state\ndata: %s\n\n", state)
                         : asprintf(&stream->text, ": still here\n\n");
    free(state);
    if (length < 0)
        stream->text = NULL;
    stream->length = length > 0 ? (size_t)length : 0;
    return length > 0;
}

static ssize_t read_events(void *user, uint64_t at, char *bytes, size_t most)
{
    (void)at;
    struct event_stream *stream = user;
    if (stream->sent == stream->length && !atomic_load(&stream->explorer->stopping) &&
        !next_event(stream))
        return MHD_CONTENT_READER_END_WITH_ERROR;
    if (atomic_load(&stream->explorer->stopping))
        return MHD_CONTENT_READER_END_OF_STREAM;
    size_t left = stream->length - stream->sent, count = most < left ? most : left;
    memcpy(bytes, stream->text + stream->sent, count);
    stream->sent += count;
    return (ssize_t)count;
}

static void end_events(void *user)
{
    struct event_stream *stream = user;
    free(stream->text);
    free(stream);
}

bool answer_events(struct MHD_Connection *connection, struct explorer *explorer)
{
    struct event_stream *stream = calloc(1, sizeof *stream);
    if (!stream)
        return answer_json(connection, MHD_HTTP_OK, NULL);
    stream->explorer = explorer;
    struct MHD_Response *response = MHD_create_response_from_callback(
        MHD_SIZE_UNKNOWN, EVENT_BLOCK_BYTES, read_events, stream, end_events);
    if (!response)
        end_events(stream);
    return send_response(connection, MHD_HTTP_OK, "text/event-stream", response);
}
