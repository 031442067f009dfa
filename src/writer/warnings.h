/* warnings.h: warnings that a converter gives once for each text, at the first place that has it.
 *
 * One thread at a time.
 */
#ifndef WRITER_WARNINGS_H
#define WRITER_WARNINGS_H

#include "parser/yaml/diagnostic.h"

/* Kinds of warnings that are told apart; a sink should keep as many. */
#define WARNINGS_KEPT ((size_t)1000)

/* Zeroed: none was given. */
struct warnings {
    char **said; /* owned, each too */
    size_t count, capacity;
};

/* Reports the warning to the sink where it is new. False: out of memory. */
bool warnings_report(struct warnings *warnings, struct diagnostics *sink,
                     const struct origin *origin, int width, const char *format, va_list arguments)
    PRINTF_LIKE(5, 0);
void warnings_release(struct warnings *warnings);

#endif
