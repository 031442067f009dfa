/* command.h: psplat's commands, one table for what they are, what they take and their help. */
#ifndef CLI_COMMAND_H
#define CLI_COMMAND_H

#include <psplat/psplat.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* Exit status, as in psplat(1). */
enum status {
    STATUS_OK = 0,
    STATUS_FAILED = 1,
    STATUS_USAGE = 2,
    STATUS_SIGNAL = 128 /* plus the number of the signal that ended it */
};

struct option {
    char letter;          /* 0: none */
    const char *name;     /* long, without the dashes */
    const char *argument; /* what it takes, for the help; NULL: nothing */
    const char *help;     /* one line */
};

/* One option or operand of a command line, in the order given. */
struct argument {
    const struct option *option; /* NULL: an operand */
    const char *value;           /* NULL where the option takes nothing */
};

struct command {
    const char *name;
    const char *operands; /* for the usage line */
    const char *summary;  /* one line */
    const struct option *options;
    size_t option_count;
    int (*run)(const struct argument *arguments, size_t count);
};

extern const struct command command_render, command_check, command_plugins, command_info,
    command_compare, command_diff, command_view, command_schema, command_debug, command_merge,
    command_resolve, command_new, command_import, command_explore, command_fmt, command_complete;

/* All commands; the first is what runs when none is named. */
extern const struct command *const commands[];
extern const size_t command_count;

/* Whether the argument is the option of that long name. */
static inline bool argument_is(const struct argument *argument, const char *name)
{
    return argument->option && strcmp(argument->option->name, name) == 0;
}

/* Splits the words that follow a command's name. Prints what is wrong to stderr and returns false;
 * --help is handled by the caller. `arguments` has room for `count` entries; *parsed is how many
 * came out. */
bool command_parse(const struct command *command, char *const words[], size_t count,
                   struct argument *arguments, size_t *parsed);

/* Prints the help of psplat or of one command to stdout. */
void help_print_all(void);
void help_print(const struct command *command);

/* "psplat: error: MESSAGE" on stderr. */
void print_error(const char *message);
void print_warning(const char *message);

/* What a function of psplat.h says; one with a place says itself what it is. Nothing where it has
 * no message. */
void print_failure(const psplat_error *error);

/* Status of a command that ended so: bad input is the user's to mend. */
int status_of(ps_result result);

#endif
