/* warnings.c: see warnings.h. */
#include "writer/warnings.h"

#include "writer/scene_text.h"
#include <stdlib.h>
#include <string.h>

/* Notes the text. After very many they are counted by the sink alone. False: out of memory. */
static bool note(struct warnings *warnings, const char *text)
{
    if (warnings->count == WARNINGS_KEPT)
        return true;
    char *copy = strdup(text);
    if (!copy || !scene_text_grow((void **)&warnings->said, &warnings->capacity,
                                  warnings->count + 1, sizeof *warnings->said)) {
        free(copy);
        return false;
    }
    warnings->said[warnings->count++] = copy;
    return true;
}

bool warnings_report(struct warnings *warnings, struct diagnostics *sink,
                     const struct origin *origin, int width, const char *format, va_list arguments)
{
    char text[512];
    vsnprintf(text, sizeof text, format, arguments);
    for (size_t i = 0; i < warnings->count; i++)
        if (strcmp(warnings->said[i], text) == 0)
            return true;
    if (!note(warnings, text))
        return false;
    diagnostics_report(sink, SEVERITY_WARNING, origin, width, "%s", text);
    return true;
}

void warnings_release(struct warnings *warnings)
{
    for (size_t i = 0; i < warnings->count; i++)
        free(warnings->said[i]);
    free(warnings->said);
    *warnings = (struct warnings){0};
}
