/* child.c: fork, limits and how a child ended. */
#include "import/child.h"

#include "base/machine.h"
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__)
#define SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANITIZED 1
#endif
#endif
#ifndef SANITIZED
#define SANITIZED 0
#endif

static void set_limit(int resource, rlim_t wanted)
{
    struct rlimit limit;
    if (getrlimit(resource, &limit) != 0)
        return;
    if (limit.rlim_max == RLIM_INFINITY || wanted < limit.rlim_max)
        limit.rlim_cur = wanted;
    setrlimit(resource, &limit);
}

bool child_has_memory_limit(void)
{
    return !SANITIZED;
}

void child_extend_time(unsigned seconds)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_CPU, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        set_limit(RLIMIT_CPU, limit.rlim_cur + seconds);
}

/* A crash is reported by the parent: no dump, no words of the C++ library, no handler of the
 * program. A sanitizer's report is for developers, and stays. */
static void prepare(const struct child_limits *limits)
{
    static const int signals[] = {SIGABRT, SIGSEGV, SIGBUS,  SIGFPE, SIGILL,
                                  SIGINT,  SIGTERM, SIGPIPE, SIGXCPU};
    set_limit(RLIMIT_CORE, 0);
    set_limit(RLIMIT_CPU, limits->seconds);
    if (SANITIZED)
        return;
    for (size_t i = 0; i < sizeof signals / sizeof signals[0]; i++)
        signal(signals[i], SIG_DFL);
    if (isfinite(limits->bytes))
        set_limit(RLIMIT_DATA, (rlim_t)(machine_data_of_process() + limits->bytes));
    int silent = open("/dev/null", O_WRONLY);
    if (silent >= 0)
        dup2(silent, STDERR_FILENO);
}

static ps_result report_end(int status, struct error *error)
{
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
        return error_set(error, PS_ERROR_INVALID, "took too long");
    if (WIFSIGNALED(status))
        return error_set(error, PS_ERROR_INVALID, "crashed (%s)", strsignal(WTERMSIG(status)));
    if (WEXITSTATUS(status) != 0)
        return error_set(error, PS_ERROR_INVALID, "crashed (status %d)", WEXITSTATUS(status));
    return PS_OK;
}

ps_result child_run(void (*work)(void *context), void *context, const struct child_limits *limits,
                    struct error *error)
{
    int status = 0;
    pid_t ended, child = fork();
    if (child < 0)
        return error_set(error, PS_ERROR_IO, "no child process: %s", strerror(errno));
    if (child == 0) {
        prepare(limits);
        work(context);
        _exit(0); /* flushes nothing that the parent has not written yet */
    }
    do
        ended = waitpid(child, &status, 0);
    while (ended < 0 && errno == EINTR);
    /* Where the caller's SIGCHLD is ignored, nobody is told how children end. */
    if (ended < 0 && errno != ECHILD)
        return error_set(error, PS_ERROR_IO, "waiting for a child: %s", strerror(errno));
    return ended < 0 ? PS_OK : report_end(status, error);
}
