#include "tools/progress_callbacks.h"

static void show_progress(void *user, const char *stage, double fraction)
{
    progress_update(user, stage, fraction);
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
