#include "cli/progress.h"

#include "base/clock.h"
#include "base/machine.h"
#include "cli/command.h"
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define BAR_WIDTH 30
#define UPDATE_SECONDS 0.1
#define JSON_SECONDS 0.1
#define PLAIN_SECONDS 30.0 /* without another tenth */

bool progress_parse_mode(const char *name, enum progress_mode *mode)
{
#define WORD(mode_, word_) word_,
    static const char *const words[] = {PROGRESS_MODES(WORD)};
#undef WORD
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (strcmp(name, words[i]) == 0) {
            *mode = (enum progress_mode)i;
            return true;
        }
    fprintf(stderr,
            "psplat: error: --progress: expected auto, bar, plain, json or none, got '%s'\n", name);
    return false;
}

void progress_start(struct progress *progress, enum progress_mode mode, bool quiet)
{
    if (mode == PROGRESS_AUTO && quiet)
        mode = PROGRESS_NONE;
    else if (mode == PROGRESS_AUTO)
        mode = isatty(STDERR_FILENO) ? PROGRESS_BAR : PROGRESS_PLAIN;
    *progress = (struct progress){
        .mode = mode,
        .quiet = quiet,
        .start = clock_seconds(),
        .last_tenth = -1,
        .error = -1.0,
    };
}

/* By the pace so far; negative while there is none. */
static double seconds_left(const struct progress *progress, double fraction)
{
    double elapsed = clock_seconds() - progress->start;
    if (fraction < 0.01 || elapsed < 0.2)
        return -1.0;
    return elapsed * (1.0 - fraction) / fraction;
}

/* "1:23"; "-:--" where it is not known. */
static void format_left(const struct progress *progress, double fraction, char *text, size_t size)
{
    long left = (long)(seconds_left(progress, fraction) + 0.5);
    if (seconds_left(progress, fraction) < 0.0)
        snprintf(text, size, "-:--");
    else if (left >= 3600)
        snprintf(text, size, "%ld:%02ld:%02ld", left / 3600, left / 60 % 60, left % 60);
    else
        snprintf(text, size, "%ld:%02ld", left / 60, left % 60);
}

static void draw_bar(struct progress *progress, const char *stage, double fraction)
{
    double now = clock_seconds();
    if (now < progress->next_update)
        return;
    progress->next_update = now + UPDATE_SECONDS;
    char bar[BAR_WIDTH + 1], left[32], error[32] = "";
    int filled = (int)(fraction * BAR_WIDTH);
    memset(bar, ' ', BAR_WIDTH);
    memset(bar, '#', (size_t)filled);
    bar[BAR_WIDTH] = '\0';
    format_left(progress, fraction, left, sizeof left);
    if (progress->error >= 0.0)
        snprintf(error, sizeof error, "error %.2g %%  ", 100.0 * progress->error);
    /* Floored: 100 % means done. */
    fprintf(stderr, "\r[%s] %3d %%  %s left  %s%-16s", bar, (int)(fraction * 100.0), left, error,
            stage);
}

static void print_line(struct progress *progress, const char *stage, double fraction)
{
    int tenth = (int)(fraction * 10.0);
    double now = clock_seconds();
    if (tenth == progress->last_tenth && now < progress->next_update)
        return;
    progress->last_tenth = tenth;
    progress->next_update = now + PLAIN_SECONDS;
    fprintf(stderr, "psplat: %3d %% %s\n", tenth * 10, stage);
}

/* A number that may not be known. */
static void print_known(const char *key, double value)
{
    if (value >= 0.0)
        printf(", \"%s\": %.4g", key, value);
    else
        printf(", \"%s\": null", key);
}

static void print_json(struct progress *progress, const char *stage, double fraction)
{
    double now = clock_seconds();
    if (now < progress->next_update)
        return;
    progress->next_update = now + JSON_SECONDS;
    printf("{\"stage\": \"%s\", \"fraction\": %.4f, \"passes\": %u", stage, fraction,
           progress->passes);
    print_known("error", progress->error);
    print_known("seconds", now - progress->start);
    print_known("seconds_left", seconds_left(progress, fraction));
    printf(", \"bytes\": %.0f}\n", machine_memory_of_process());
    fflush(stdout);
}

void progress_update(struct progress *progress, const char *stage, double fraction)
{
    fraction = fraction < 0 ? 0 : fraction > 1 ? 1 : fraction;
    if (progress->mode == PROGRESS_BAR)
        draw_bar(progress, stage, fraction);
    else if (progress->mode == PROGRESS_PLAIN)
        print_line(progress, stage, fraction);
    else if (progress->mode == PROGRESS_JSON)
        print_json(progress, stage, fraction);
}

void progress_message(const struct progress *progress, ps_log_level level, const char *message)
{
    if (level == PS_LOG_WARNING)
        print_warning(message);
    else if (level == PS_LOG_INFO && !progress->quiet)
        fprintf(stderr, "psplat: %s\n", message);
}

void progress_clear(struct progress *progress)
{
    if (progress->mode == PROGRESS_BAR)
        fprintf(stderr, "\r%*s\r", BAR_WIDTH + 70, "");
    progress->next_update = 0.0;
}

void progress_end(struct progress *progress)
{
    progress->next_update = 0.0;
    if (progress->mode == PROGRESS_JSON)
        print_json(progress, "done", 1.0);
}
