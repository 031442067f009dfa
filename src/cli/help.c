/* help.c: help texts, made from the tables of commands and options. */
#include "cli/command.h"

#include <stdio.h>
#include <string.h>

static void print_option(const struct option *option)
{
    char left[64];
    char letter[5] = "    ";
    if (option->letter) {
        letter[0] = '-';
        letter[1] = option->letter;
        letter[2] = ',';
    }
    snprintf(left, sizeof left, "%s--%s%s%s", letter, option->name, option->argument ? " " : "",
             option->argument ? option->argument : "");
    printf("  %-32s %s\n", left, option->help);
}

void help_print(const struct command *command)
{
    printf("usage: psplat %s [options] %s\n%s\n\n", command->name, command->operands,
           command->summary);
    for (size_t i = 0; i < command->option_count; i++)
        print_option(&command->options[i]);
    print_option(&(struct option){'h', "help", NULL, "print this help"});
    print_option(&(struct option){0, "version", NULL, "print the version"});
}

void help_print_all(void)
{
    printf("usage: psplat [render] [options] SCENE.psd|MODEL\n       psplat COMMAND [options] ...\n"
           "Renders indirect light by photon splatting.\n\ncommands:\n");
    for (size_t i = 0; i < command_count; i++)
        printf("  %-10s %s\n", commands[i]->name, commands[i]->summary);
    printf("\n'psplat COMMAND --help' tells about a command, psplat(1) about everything.\n\n");
    help_print(commands[0]);
}
