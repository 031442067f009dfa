/* report.h: errors and warnings of the core, as callers of psplat.h get them. */
#ifndef API_REPORT_H
#define API_REPORT_H

#include "parser/yaml/diagnostic.h"
#include "render_job/processes.h"
#include <psplat/psplat.h>

/* Tells an error, where `told` is not NULL. Returns `result`. */
ps_result report_error(psplat_error *told, ps_result result, const struct error *error);

/* Tells the errors among the diagnostics as one. Returns `result`. */
ps_result report_problems(psplat_error *told, ps_result result, const struct diagnostics *sink);

/* What a process among others tells of `result`: one beside the first leaves it to that one,
 * PS_CANCELLED and no message, where they have not agreed, or where it was cancelled. */
ps_result report_of_process(psplat_error *told, ps_result result,
                            const struct processes *processes);

/* Tells the warnings among them, one by one, where there is a listener. */
void report_warnings(psplat_listener listener, void *user, const struct diagnostics *sink);

#endif
