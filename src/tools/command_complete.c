/* command_complete.c: psplat complete: what may stand next on a command line; the shells'
 * completions ask it. */
#include "tools/candidates.h"

#include <stdlib.h>

/* All are operands: the shells put them behind "--". */
static int run(const struct argument *arguments, size_t count)
{
    const char **words = malloc(count * sizeof *words);
    if (count == 0)
        print_error("complete: which words? Try 'psplat complete --help'.");
    else if (!words)
        print_error("out of memory");
    for (size_t i = 0; i < count && words; i++)
        words[i] = arguments[i].value;
    if (count > 0 && words)
        candidates_print(words, count);
    free(words);
    if (count == 0)
        return STATUS_USAGE;
    return words ? STATUS_OK : STATUS_FAILED;
}

const struct command command_complete = {
    .name = "complete",
    .operands = "-- [WORD]...",
    .summary = "lists what may stand next on a command line, for shells",
    .run = run,
};
