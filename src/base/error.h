/* error.h: result codes with a message to the caller.
 *
 * A function that can fail returns a ps_result and takes a `struct error *`, which it fills when it
 * fails; the caller owns it. No message is kept in a global, so threads never share one.
 */
#ifndef BASE_ERROR_H
#define BASE_ERROR_H

#include <psplat/types.h>

#if defined(__GNUC__)
#define PRINTF_LIKE(format_index, first_argument)                                                  \
    __attribute__((format(printf, format_index, first_argument)))
#else
#define PRINTF_LIKE(format_index, first_argument)
#endif

struct error {
    char text[4096]; /* what, where, and what to do; no trailing newline */
};

/* Formats the message and returns `code`, so that `return error_set(...)` reads as one thought. */
ps_result error_set(struct error *error, ps_result code, const char *format, ...) PRINTF_LIKE(3, 4);

/* "out of memory (wanted N bytes for WHAT)" */
ps_result error_memory(struct error *error, size_t bytes, const char *what);

#endif
