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

static void add_line(psplat_error *told, const char *text)
{
    size_t used = strlen(told->message);
    snprintf(told->message + used, sizeof told->message - used, "%s%s", used > 0 ? "\n" : "", text);
}

/* What options assign has a place among them, which is none in a file. */
static bool is_in_a_file(const struct origin *origin)
{
    return origin->file && origin->line > 0 && strcmp(origin->file, "--param") != 0 &&
           strcmp(origin->file, "--set") != 0;
}

static void add_problem(void *user, enum severity severity, const struct origin *origin,
                        const char *text)
{
    psplat_error *told = user;
    char line[4200];
    if (severity != SEVERITY_ERROR)
        return;
    if (told->message[0] && !origin->file) {
        snprintf(line, sizeof line, "psplat: error: %s", text);
        text = line;
    }
    if (told->message[0] == '\0')
        told->has_place = origin->file != NULL;
    if (told->message[0] == '\0' && is_in_a_file(origin)) {
        snprintf(told->file, sizeof told->file, "%s", origin->file);
        told->line = origin->line;
        told->column = origin->column;
    }
    add_line(told, text);
}

ps_result report_problems(psplat_error *told, ps_result result, const struct diagnostics *sink)
{
    char count[DIAGNOSTICS_COUNT_TEXT];
    if (!told)
        return result;
    *told = (psplat_error){.result = result};
    diagnostics_each(sink, add_problem, told);
    if (diagnostics_count_text(sink, count))
        add_line(told, count);
    return result;
}

ps_result report_of_process(psplat_error *told, ps_result result, const struct processes *processes)
{
    bool is_told_by_first = !processes_is_first(processes) && result != PS_OK &&
                            (!processes->has_agreed || result == PS_CANCELLED);
    if (!is_told_by_first)
        return result;
    if (told)
        *told = (psplat_error){.result = PS_CANCELLED};
    return PS_CANCELLED;
}

struct audience {
    psplat_listener listener;
    void *user;
};

static void pass_on(void *user, enum severity severity, const struct origin *origin,
                    const char *text)
{
    const struct audience *audience = user;
    if (severity == SEVERITY_WARNING)
        audience->listener(audience->user,
                           origin->file ? PSPLAT_WARNING_WITH_PLACE : PSPLAT_WARNING, text);
}

void report_warnings(psplat_listener listener, void *user, const struct diagnostics *sink)
{
    struct audience audience = {listener, user};
    char count[DIAGNOSTICS_COUNT_TEXT];
    if (!listener)
        return;
    diagnostics_each(sink, pass_on, &audience);
    if (diagnostics_warnings_text(sink, count))
        listener(user, PSPLAT_WARNING_WITH_PLACE, count);
}
