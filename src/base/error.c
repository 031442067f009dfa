#include "base/error.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>

ps_result error_set(struct error *error, ps_result code, const char *format, ...)
{
    assert(code != PS_OK);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->text, sizeof error->text, format, arguments);
    va_end(arguments);
    return code;
}

ps_result error_memory(struct error *error, size_t bytes, const char *what)
{
    return error_set(error, PS_ERROR_MEMORY, "out of memory: wanted %zu bytes for %s", bytes, what);
}
