#include "explore/server.h"

#include "explore/answer.h"
#include "explore/route.h"
#include <arpa/inet.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/random.h>

#define MOST_CONNECTIONS 64
#define MOST_BODY_BYTES ((size_t)64 * 1024)
#define IDLE_SECONDS 15 /* after which a connection that asks for nothing, or takes nothing, ends */
#define ANSWER_SECONDS 600 /* of one that was let in: a scene may take long to load */

/* One request, while its body comes in. */
struct request {
    char *body; /* terminated; NULL: it has none */
    size_t length, room;
};

/* --- who may ask
 * ------------------------------------------------------------------------------------- */

static const char *header(struct MHD_Connection *connection, const char *name)
{
    return MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
}

static bool is_own_host(const struct server *server, const char *host)
{
    return host &&
           (strcasecmp(host, server->hosts[0]) == 0 || strcasecmp(host, server->hosts[1]) == 0);
}

static bool is_own_origin(const struct server *server, const char *origin)
{
    static const char scheme[] = "http://";
    return strncmp(origin, scheme, sizeof scheme - 1) == 0 &&
           is_own_host(server, origin + sizeof scheme - 1);
}

/* What follows the token in the address "/TOKEN/..."; NULL where the token is another. Takes as
 * long for every wrong one. */
static const char *path_behind_token(const struct server *server, const char *url)
{
    unsigned difference = 0;
    if (strlen(url) < TOKEN_LENGTH + 2 || url[0] != '/' || url[TOKEN_LENGTH + 1] != '/')
        return NULL;
    for (size_t i = 0; i < TOKEN_LENGTH; i++)
        difference |= (unsigned)(url[i + 1] ^ server->token[i]);
    return difference == 0 ? url + TOKEN_LENGTH + 2 : NULL;
}

/* The status that refuses a request by its head; 0: it is let in. */
static unsigned refusal(const struct server *server, struct MHD_Connection *connection,
                        const char *url)
{
    const char *origin = header(connection, "Origin");
    if (!is_own_host(server, header(connection, "Host")) ||
        (origin && !is_own_origin(server, origin)))
        return MHD_HTTP_FORBIDDEN;
    return path_behind_token(server, url) ? 0 : MHD_HTTP_NOT_FOUND;
}

/* --- bodies
 * ------------------------------------------------------------------------------------------ */

static bool is_json(const char *type)
{
    static const char json[] = "application/json";
    size_t length = sizeof json - 1;
    return type && strncasecmp(type, json, length) == 0 &&
           (type[length] == '\0' || type[length] == ';' || type[length] == ' ');
}

/* A length of a body that is said, and how long it is; the status that refuses it otherwise. */
static unsigned body_refusal(struct MHD_Connection *connection, size_t *length)
{
    const char *text = header(connection, "Content-Length");
    char *end;
    if (!text)
        return MHD_HTTP_LENGTH_REQUIRED;
    errno = 0;
    unsigned long long bytes = strtoull(text, &end, 10);
    if (errno != 0 || *end != '\0' || bytes > MOST_BODY_BYTES)
        return MHD_HTTP_CONTENT_TOO_LARGE;
    *length = (size_t)bytes;
    if (bytes == 0)
        return 0;
    return is_json(header(connection, "Content-Type")) ? 0 : MHD_HTTP_UNSUPPORTED_MEDIA_TYPE;
}

static bool brings_body(struct MHD_Connection *connection, const char *method)
{
    return strcmp(method, MHD_HTTP_METHOD_PUT) == 0 || strcmp(method, MHD_HTTP_METHOD_POST) == 0 ||
           header(connection, "Transfer-Encoding") || header(connection, "Content-Length");
}

static void request_release(struct request *request)
{
    if (!request)
        return;
    free(request->body);
    free(request);
}

static enum MHD_Result result_of(bool good)
{
    return good ? MHD_YES : MHD_NO;
}

/* The head of a request: it is refused, or a body may come. */
static enum MHD_Result begin(const struct server *server, struct MHD_Connection *connection,
                             const char *url, const char *method, void **user)
{
    size_t length = 0;
    unsigned status = refusal(server, connection, url);
    bool has_body = brings_body(connection, method);
    if (status == 0 && has_body)
        status = body_refusal(connection, &length);
    if (status != 0)
        return result_of(answer_status(connection, status, "refused\n"));
    struct request *request = calloc(1, sizeof *request);
    if (request && has_body) {
        request->room = length;
        request->body = calloc(1, length + 1);
    }
    if (!request || (has_body && !request->body)) {
        request_release(request);
        return MHD_NO;
    }
    MHD_set_connection_option(connection, MHD_CONNECTION_OPTION_TIMEOUT, (unsigned)ANSWER_SECONDS);
    *user = request;
    return MHD_YES;
}

static enum MHD_Result take_body(struct request *request, const char *bytes, size_t *count)
{
    if (!request->body || *count > request->room - request->length)
        return MHD_NO; /* more than was said */
    memcpy(request->body + request->length, bytes, *count);
    request->length += *count;
    *count = 0;
    return MHD_YES;
}

static enum MHD_Result handle(void *user, struct MHD_Connection *connection, const char *url,
                              const char *method, const char *version, const char *bytes,
                              size_t *count, void **state)
{
    const struct server *server = user;
    struct request *request = *state;
    (void)version;
    if (!request)
        return begin(server, connection, url, method, state);
    if (*count > 0)
        return take_body(request, bytes, count);
    const struct route_request routed = {
        .explorer = server->explorer,
        .connection = connection,
        .method = method,
        .path = path_behind_token(server, url),
        .body = request->body,
        .length = request->length,
    };
    return result_of(route(&routed));
}

static void end_request(void *user, struct MHD_Connection *connection, void **state,
                        enum MHD_RequestTerminationCode code)
{
    (void)user;
    (void)connection;
    (void)code;
    request_release(*state);
    *state = NULL;
}

/* --- its life
 * ---------------------------------------------------------------------------------------- */

static ps_result make_token(struct server *server, struct error *error)
{
    unsigned char bytes[TOKEN_LENGTH / 2];
    if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes)
        return error_set(error, PS_ERROR_IO, "no random numbers: %s", strerror(errno));
    for (size_t i = 0; i < sizeof bytes; i++)
        snprintf(server->token + 2 * i, 3, "%02x", bytes[i]);
    return PS_OK;
}

ps_result server_start(struct server *server, struct explorer *explorer, uint16_t port,
                       struct error *error)
{
    const struct sockaddr_in address = {
        .sin_family = AF_INET,
        .sin_port = htons(port),
        .sin_addr.s_addr = htonl(INADDR_LOOPBACK),
    };
    *server = (struct server){.explorer = explorer};
    ps_result result = make_token(server, error);
    if (result != PS_OK)
        return result;
    errno = 0;
    server->daemon = MHD_start_daemon(
        MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_THREAD_PER_CONNECTION | MHD_USE_POLL, port, NULL,
        NULL, handle, server, MHD_OPTION_SOCK_ADDR, &address, MHD_OPTION_CONNECTION_LIMIT,
        (unsigned)MOST_CONNECTIONS, MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)IDLE_SECONDS,
        MHD_OPTION_NOTIFY_COMPLETED, end_request, NULL, MHD_OPTION_END);
    if (!server->daemon)
        return error_set(error, PS_ERROR_IO, "can't listen on 127.0.0.1:%u: %s", (unsigned)port,
                         strerror(errno));
    server->port = MHD_get_daemon_info(server->daemon, MHD_DAEMON_INFO_BIND_PORT)->port;
    snprintf(server->hosts[0], sizeof server->hosts[0], "127.0.0.1:%u", (unsigned)server->port);
    snprintf(server->hosts[1], sizeof server->hosts[1], "localhost:%u", (unsigned)server->port);
    return PS_OK;
}

void server_stop(struct server *server)
{
    MHD_stop_daemon(server->daemon);
}
