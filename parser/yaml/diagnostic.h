/* diagnostic.h: errors and warnings about a text, in compiler style.
 *
 *     scene.psd:12:9: error: unknown key 'radios' in spotlight; did you mean 'radius'?
 *        12 |         radios: 60
 *           |         ^~~~~~
 *
 * A sink collects them so that one run reports as many as it can. It keeps each source text that
 * was registered, to print the line. Not thread-safe; owned by the caller.
 */
#ifndef PARSER_YAML_DIAGNOSTIC_H
#define PARSER_YAML_DIAGNOSTIC_H

#include "base/error.h"
#include "base/origin.h"
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>

/* Errors, and warnings, past this many are counted but not kept, where no other number is asked
 * for. */
#define DIAGNOSTICS_KEPT 20

enum severity { SEVERITY_WARNING, SEVERITY_ERROR };

struct diagnostics;

/* NULL when out of memory. */
struct diagnostics *diagnostics_create(void);
/* `kept`: of errors, and as many of warnings. */
struct diagnostics *diagnostics_create_for(size_t kept);
void diagnostics_destroy(struct diagnostics *sink);

/* Registers (and copies) the text of a file so that its lines can be shown; a name that is known
 * gets the new text. Returns the sink's own copy of the name, which origins may hold as long as
 * the sink lives; NULL when out of memory. */
const char *diagnostics_add_source(struct diagnostics *sink, const char *name, const char *text,
                                   size_t length);

/* Says which place in which file includes that one, whose first message is printed below "In file
 * included from scene.psd:3:10:". False: out of memory. */
bool diagnostics_set_includer(struct diagnostics *sink, const char *name,
                              const struct origin *from);

/* `width` characters from the origin are underlined (0 counts as 1). An origin of NULL or with
 * line 0 has no position. What was reported before, word by word, is not reported again. */
void diagnostics_report(struct diagnostics *sink, enum severity severity,
                        const struct origin *origin, int width, const char *format, ...)
    PRINTF_LIKE(5, 6);
void diagnostics_report_list(struct diagnostics *sink, enum severity severity,
                             const struct origin *origin, int width, const char *format,
                             va_list arguments) PRINTF_LIKE(5, 0);

size_t diagnostics_error_count(const struct diagnostics *sink);
size_t diagnostics_warning_count(const struct diagnostics *sink);

/* Whether further errors would only be counted, so that effort on their wording is wasted. */
bool diagnostics_is_full(const struct diagnostics *sink);

/* Calls back for each, in the order of diagnostics_print, with what that prints of it: lines,
 * without the last one's end. Where it has no file, origin->file is NULL and the text the message
 * alone. Both are there until the call returns. */
typedef void (*diagnostics_visit)(void *user, enum severity severity, const struct origin *origin,
                                  const char *text);
void diagnostics_each(const struct diagnostics *sink, diagnostics_visit visit, void *user);

/* "N errors", and how many of them were kept where that is not all; false where there is no more
 * than one. */
#define DIAGNOSTICS_COUNT_TEXT 64
bool diagnostics_count_text(const struct diagnostics *sink, char text[DIAGNOSTICS_COUNT_TEXT]);

/* "N warnings", and how many of them were kept; false where that is all. */
bool diagnostics_warnings_text(const struct diagnostics *sink, char text[DIAGNOSTICS_COUNT_TEXT]);

/* Prints all in the order of file and position, with carets, and last those that have no file, as
 * "psplat: error: ...". Then how many errors there are, where there is more than one, and how many
 * warnings, where not all were kept. */
void diagnostics_print(const struct diagnostics *sink, FILE *stream);

#endif
