#include "api/report.h"

#include <stdio.h>
#include <string.h>

ps_result report_error(psplat_error *told, ps_result result, const struct error *error)
{
    if (!told)
        return result;
    *told = (psplat_error){.result = result};
    snprintf(told->message, sizeof told->message, "%s", error->text);
    return result;
}

static void add_problem(void *user, enum severity severity, const struct origin *origin,
                        const char *text)
{
    psplat_error *told = user;
    size_t used = strlen(told->message);
    if (severity != SEVERITY_ERROR)
        return;
    if (used == 0 && origin->file && origin->line > 0) {
        snprintf(told->file, sizeof told->file, "%s", origin->file);
        told->line = origin->line;
        told->column = origin->column;
    }
    snprintf(told->message + used, sizeof told->message - used, "%s%s", used > 0 ? "\n" : "", text);
}

ps_result report_problems(psplat_error *told, ps_result result, const struct diagnostics *sink)
{
    if (!told)
        return result;
    *told = (psplat_error){.result = result};
    diagnostics_each(sink, add_problem, told);
    return result;
}

struct audience {
    psplat_listener listener;
    void *user;
};

static void pass_on(void *user, enum severity severity, const struct origin *origin,
                    const char *text)
{
    const struct audience *audience = user;
    (void)origin;
    if (severity == SEVERITY_WARNING)
        audience->listener(audience->user, 1, text);
}

void report_warnings(psplat_listener listener, void *user, const struct diagnostics *sink)
{
    struct audience audience = {listener, user};
    if (listener)
        diagnostics_each(sink, pass_on, &audience);
}
