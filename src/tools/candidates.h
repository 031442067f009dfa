/* candidates.h: what may stand next on a command line, for the shells' completions.
 *
 * Everything comes from the tables that the help is made of: commands, options with the form of
 * what they take ("FILE.exr", "rays|shadowmap"), operands; and from those of plugins, layers, and
 * the scene that is named.
 */
#ifndef TOOLS_CANDIDATES_H
#define TOOLS_CANDIDATES_H

#include "cli/command.h"

/* Prints what may stand in place of the last of `count` words, which follow the program's name;
 * count > 0. A line each:
 *
 *     WORD <tab> - <tab> HELP              a word that begins with the last one
 *     WORD <tab> + <tab> HELP              another, which may go on without a blank
 *     :files <tab> - <tab> [.SUFFIX ...]   the shell should offer files with one of these suffixes;
 *                                          none: all files
 *     :folders <tab> - <tab>               or folders
 *
 * Of files, what counts is the word from behind `=`, where it is --OPTION=FILE. What is wrong on
 * the line is not told: no words are. */
void candidates_print(const char *const words[], size_t count);

#endif
