/* main.c: chooses the command. The only place where the process's exit status is decided. */
#include "cli/command.h"

#include "base/suggestion.h"
#include "base/version.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct command *find_command(const char *name)
{
    for (size_t i = 0; i < command_count; i++)
        if (strcmp(commands[i]->name, name) == 0)
            return commands[i];
    return NULL;
}

/* Whether one of the words before "--" asks for it. */
static bool asks_for(char *const words[], size_t count, const char *letter, const char *name)
{
    for (size_t i = 0; i < count && strcmp(words[i], "--") != 0; i++)
        if ((letter && strcmp(words[i], letter) == 0) || strcmp(words[i], name) == 0)
            return true;
    return false;
}

/* A command that this program was built without. */
static bool lacks_command(const char *word)
{
#ifdef PSPLAT_EXPLORE
    (void)word;
    return false;
#else
    return strcmp(word, "explore") == 0;
#endif
}

/* A word before others that is nearly a command was meant as one. */
static bool suggest_command(const char *word)
{
    if (lacks_command(word)) {
        fprintf(stderr,
                "psplat: error: 'psplat %s' needs libmicrohttpd, which this psplat was "
                "built without\n",
                word);
        return true;
    }
    struct suggestion suggestion = suggestion_start(word);
    char hint[SUGGESTION_TEXT];
    for (size_t i = 0; i < command_count && word[0] != '-'; i++)
        suggestion_consider(&suggestion, commands[i]->name);
    suggestion_text(&suggestion, hint);
    if (suggestion.best)
        fprintf(stderr, "psplat: error: unknown command '%s'%s\n", word, hint);
    return suggestion.best != NULL;
}

static int run(const struct command *command, char *const words[], size_t count)
{
    struct argument *arguments = calloc(count + 1, sizeof *arguments);
    size_t parsed;
    if (!arguments) {
        print_error("out of memory");
        return STATUS_FAILED;
    }
    int status = STATUS_USAGE;
    if (command_parse(command, words, count, arguments, &parsed))
        status = command->run(arguments, parsed);
    free(arguments);
    return status;
}

/* Output that could not be written is a failure, even if it was only the help. */
static int finish(int status)
{
    if (fflush(stdout) != 0 || ferror(stdout)) {
        print_error("can't write to standard output");
        return STATUS_FAILED;
    }
    return status;
}

int main(int argc, char *argv[])
{
    char *const *words = argv + 1;
    size_t count = argc > 1 ? (size_t)argc - 1 : 0;
    const struct command *command = count ? find_command(words[0]) : NULL;
    bool named = command != NULL;
    if (asks_for(words, count, NULL, "--version")) {
        printf("psplat %s\n", PSPLAT_VERSION);
        return finish(STATUS_OK);
    }
    if (asks_for(words, count, "-h", "--help")) {
        if (named)
            help_print(command);
        else
            help_print_all();
        return finish(STATUS_OK);
    }
    if (named)
        return finish(run(command, words + 1, count - 1));
    if (count > 1 && suggest_command(words[0]))
        return STATUS_USAGE;
    return finish(run(commands[0], words, count));
}
