#include "explore/explore.h"

#include "explore/server.h"
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#define WATCH_NANOSECONDS 200000000L

extern char **environ;

void explore_request_release(struct explore_request *request)
{
    option_list_release(&request->fixed);
    option_list_release(&request->options);
}

/* A page that leads to the address, which only this user can read: command lines of browsers all
 * users can. */
struct redirect {
    char folder[PATH_MAX], file[PATH_MAX + 16];
};

static bool redirect_write(const struct redirect *redirect, const char *address)
{
    int descriptor = open(redirect->file, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    FILE *stream = descriptor >= 0 ? fdopen(descriptor, "w") : NULL;
    if (!stream) {
        if (descriptor >= 0)
            close(descriptor);
        return false;
    }
    fprintf(
        stream,
        "<!doctype html><meta http-equiv=\"refresh\" content=\"0; url=%s\"><title>psplat</title>\n",
        address);
    return fclose(stream) == 0;
}

static bool redirect_create(struct redirect *redirect, const char *address)
{
    const char *parent = getenv("TMPDIR");
    snprintf(redirect->folder, sizeof redirect->folder, "%s/psplat-XXXXXX",
             parent && parent[0] == '/' ? parent : "/tmp");
    if (!mkdtemp(redirect->folder)) {
        redirect->folder[0] = '\0';
        return false;
    }
    snprintf(redirect->file, sizeof redirect->file, "%s/explore.html", redirect->folder);
    return redirect_write(redirect, address);
}

static void redirect_remove(struct redirect *redirect)
{
    if (!redirect->folder[0])
        return;
    unlink(redirect->file);
    rmdir(redirect->folder);
    redirect->folder[0] = '\0';
}

/* A child of a child, which nobody needs to wait for; without a word, and with the signals that
 * this one blocks. */
static void open_browser(const char *file)
{
    char shell[] = "sh", flag[] = "-c", script[] = "xdg-open \"$0\" >/dev/null 2>&1 </dev/null &";
    char copy[PATH_MAX + 16];
    char *const words[] = {shell, flag, script, copy, NULL};
    posix_spawnattr_t attributes;
    sigset_t none;
    pid_t child;
    snprintf(copy, sizeof copy, "%s", file);
    sigemptyset(&none);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    posix_spawnattr_setsigmask(&attributes, &none);
    if (posix_spawnp(&child, "sh", NULL, &attributes, words, environ) == 0)
        while (waitpid(child, NULL, 0) < 0 && errno == EINTR)
            ;
    posix_spawnattr_destroy(&attributes);
}

/* Until a signal of the set comes. */
static void watch_until(struct explorer *explorer, const sigset_t *signals)
{
    const struct timespec pause = {.tv_nsec = WATCH_NANOSECONDS};
    while (sigtimedwait(signals, NULL, &pause) < 0)
        explorer_watch(explorer);
}

static bool is_set(const char *name)
{
    const char *value = getenv(name);
    return value && value[0];
}

static void announce(const struct explore_request *request, const struct server *server,
                     struct redirect *redirect)
{
    char address[128];
    snprintf(address, sizeof address, "http://%s/%s/", server->hosts[0], server->token);
    printf("%s\n", address);
    fflush(stdout);
    bool has_desktop = is_set("DISPLAY") || is_set("WAYLAND_DISPLAY");
    if (request->opens_browser && has_desktop && redirect_create(redirect, address))
        open_browser(redirect->file);
}

/* Until a signal of the set comes; another one then ends the process, as it would have before. */
static ps_result serve(const struct explore_request *request, struct explorer *explorer,
                       const sigset_t *signals, const sigset_t *before, struct error *error)
{
    struct server server;
    struct redirect redirect = {.folder = ""};
    if (explorer_start(explorer) != PS_OK)
        return error_set(error, PS_ERROR_MEMORY, "no threads to render in");
    ps_result result = server_start(&server, explorer, request->port, error);
    if (result != PS_OK)
        return result;
    announce(request, &server, &redirect);
    watch_until(explorer, signals);
    redirect_remove(&redirect);
    pthread_sigmask(SIG_SETMASK, before, NULL);
    explorer_stop(explorer);
    server_stop(&server);
    return PS_OK;
}

/* The signals are blocked before there are threads, so that all of them leave these to the
 * first. */
static ps_result run(const struct explore_request *request, struct explorer *explorer,
                     struct error *error)
{
    sigset_t signals, before;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals, &before);
    ps_result result = serve(request, explorer, &signals, &before, error);
    explorer_stop(explorer); /* where it could not be served */
    explorer_release(explorer);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return result;
}

ps_result explore(struct explore_request *request, psplat_error *error)
{
    struct explorer explorer;
    struct error reason;
    ps_result result = explorer_create(&explorer, request->path, &request->fixed, &request->options,
                                       request->passes, error);
    request->fixed = (struct option_list){0};
    if (result != PS_OK)
        return result;
    if (error->message[0])
        fprintf(stderr, "%s\n", error->message);
    result = run(request, &explorer, &reason);
    *error = (psplat_error){.result = result};
    if (result != PS_OK)
        snprintf(error->message, sizeof error->message, "%s", reason.text);
    return result;
}
