#include "cli/command.h"

#include "base/suggestion.h"
#include "base/text.h"
#include <stdio.h>
#include <string.h>

const struct command *const commands[] = {
    &command_render,  &command_check, &command_plugins, &command_info,  &command_compare,
    &command_diff,    &command_view,  &command_schema,  &command_debug, &command_merge,
    &command_resolve, &command_new,   &command_import,  &command_fmt,   &command_complete,
#ifdef PSPLAT_EXPLORE
    &command_explore,
#endif
};
const size_t command_count = sizeof commands / sizeof commands[0];

void print_error(const char *message)
{
    fprintf(stderr, "psplat: error: %s\n", message);
}

void print_warning(const char *message)
{
    fprintf(stderr, "psplat: warning: %s\n", message);
}

void print_failure(const psplat_error *error)
{
    if (error->has_place)
        fprintf(stderr, "%s\n", error->message);
    else if (error->message[0])
        print_error(error->message);
}

static bool usage_error(const struct command *command, const char *what, const char *word,
                        const char *hint)
{
    fprintf(stderr, "psplat: error: %s '%s'%s\nTry 'psplat %s --help'.\n", what, word, hint,
            command->name);
    return false;
}

static bool unknown_option(const struct command *command, const char *word)
{
    bool is_long = strncmp(word, "--", 2) == 0;
    char hint[80] = "";
    struct suggestion suggestion = suggestion_start(is_long ? word + 2 : "");
    for (size_t i = 0; i < command->option_count && is_long; i++)
        suggestion_consider(&suggestion, command->options[i].name);
    if (suggestion.best)
        snprintf(hint, sizeof hint, "; did you mean '--%s'?", suggestion.best);
    return usage_error(command, "unknown option", word, hint);
}

static const struct option *find_long(const struct command *command, const char *name,
                                      size_t length)
{
    for (size_t i = 0; i < command->option_count; i++) {
        const struct option *option = &command->options[i];
        if (strlen(option->name) == length && strncmp(option->name, name, length) == 0)
            return option;
    }
    return NULL;
}

static const struct option *find_letter(const struct command *command, char letter)
{
    for (size_t i = 0; i < command->option_count; i++)
        if (command->options[i].letter == letter)
            return &command->options[i];
    return NULL;
}

/* Of the command, written alone: no value of another option, which begins with '-' for a number at
 * most. */
static bool is_option(const struct command *command, const char *word)
{
    if (word[0] != '-' || !word[1])
        return false;
    return word[1] == '-' ? find_long(command, word + 2, strlen(word + 2)) != NULL
                          : !word[2] && find_letter(command, word[1]);
}

/* Reads one option at words[0] (and its value at words[1], or behind '='); returns the words used,
 * 0 on an error. */
static size_t parse_option(const struct command *command, char *const words[], size_t left,
                           struct argument *argument)
{
    const char *word = words[0], *attached = NULL;
    if (word[1] == '-') {
        size_t length = strcspn(word + 2, "=");
        argument->option = find_long(command, word + 2, length);
        attached = word[2 + length] == '=' ? word + 3 + length : NULL;
    } else {
        argument->option = find_letter(command, word[1]);
        attached = word[2] ? word + 2 : NULL;
    }
    if (!argument->option)
        return unknown_option(command, word);
    if (!argument->option->argument)
        return attached ? usage_error(command, "a value is given to option", word, "") : 1;
    if (!attached && (left < 2 || is_option(command, words[1])))
        return usage_error(command, "a value is missing after option", word, "");
    argument->value = attached ? attached : words[1];
    return attached ? 1 : 2;
}

bool command_parse(const struct command *command, char *const words[], size_t count,
                   struct argument *arguments, size_t *parsed)
{
    bool only_operands = false;
    *parsed = 0;
    for (size_t i = 0; i < count;) {
        struct argument *argument = &arguments[*parsed];
        *argument = (struct argument){.option = NULL};
        if (!only_operands && strcmp(words[i], "--") == 0) {
            only_operands = true;
            i++;
            continue;
        }
        size_t used = 1;
        if (!only_operands && words[i][0] == '-' && words[i][1])
            used = parse_option(command, words + i, count - i, argument);
        else
            argument->value = words[i];
        if (used == 0)
            return false;
        i += used;
        (*parsed)++;
    }
    return true;
}

int status_of(ps_result result)
{
    return result == PS_OK ? STATUS_OK : result == PS_ERROR_INVALID ? STATUS_USAGE : STATUS_FAILED;
}
