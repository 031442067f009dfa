#include "cli/progress.h"

#include "base/clock.h"
#include "cli/command.h"
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define BAR_WIDTH 30
#define UPDATE_SECONDS 0.1

void progress_start(struct progress *progress, bool quiet)
{
    *progress = (struct progress){
        .quiet = quiet,
        .terminal = isatty(STDERR_FILENO),
        .start = clock_seconds(),
        .last_tenth = -1,
    };
}

/* "1:23" from the pace so far; "-:--" while there is none. */
static void format_left(const struct progress *progress, double fraction, char *text, size_t size)
{
    double elapsed = clock_seconds() - progress->start;
    if (fraction < 0.01 || elapsed < 0.2) {
        snprintf(text, size, "-:--");
        return;
    }
    long left = (long)(elapsed * (1.0 - fraction) / fraction + 0.5);
    if (left >= 3600)
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
    char bar[BAR_WIDTH + 1], left[32];
    int filled = (int)(fraction * BAR_WIDTH);
    memset(bar, ' ', BAR_WIDTH);
    memset(bar, '#', (size_t)filled);
    bar[BAR_WIDTH] = '\0';
    format_left(progress, fraction, left, sizeof left);
    /* Floored: 100 % means done. */
    fprintf(stderr, "\r[%s] %3d %%  %s left  %-16s", bar, (int)(fraction * 100.0), left, stage);
}

static void print_line(struct progress *progress, const char *stage, double fraction)
{
    int tenth = (int)(fraction * 10.0);
    bool new_stage = strncmp(progress->stage, stage, sizeof progress->stage - 1) != 0;
    if (!new_stage && tenth == progress->last_tenth)
        return;
    progress->last_tenth = tenth;
    snprintf(progress->stage, sizeof progress->stage, "%s", stage);
    fprintf(stderr, "psplat: %3d %% %s\n", tenth * 10, stage);
}

void progress_update(struct progress *progress, const char *stage, double fraction)
{
    if (progress->quiet)
        return;
    fraction = fraction < 0 ? 0 : fraction > 1 ? 1 : fraction;
    if (progress->terminal)
        draw_bar(progress, stage, fraction);
    else
        print_line(progress, stage, fraction);
}

static void show_progress(void *user, const char *stage, double fraction)
{
    progress_update(user, stage, fraction);
}

void progress_message(const struct progress *progress, ps_log_level level, const char *message)
{
    if (level == PS_LOG_WARNING)
        print_warning(message);
    else if (level == PS_LOG_INFO && !progress->quiet)
        fprintf(stderr, "psplat: %s\n", message);
}

static void show_message(void *user, ps_log_level level, const char *message)
{
    progress_message(user, level, message);
}

struct render_callbacks progress_callbacks(struct progress *progress)
{
    return (struct render_callbacks){
        .user = progress, .progress = show_progress, .log = show_message};
}

void progress_clear(struct progress *progress)
{
    if (progress->terminal && !progress->quiet)
        fprintf(stderr, "\r%*s\r", BAR_WIDTH + 50, "");
}
