/* option_parse.h: numbers and rectangles on the command lines of the tools. What is wrong is
 * printed. */
#ifndef TOOLS_OPTION_PARSE_H
#define TOOLS_OPTION_PARSE_H

#include "base/rectangle.h"
#include <stdbool.h>

/* Whole decimal number in [minimum, maximum]; false, and an error that names the option, otherwise.
 */
bool parse_whole_number(const char *option, const char *text, double minimum, double maximum,
                        double *value);

/* Stops of exposure; likewise. */
bool parse_exposure(const char *text, double *stops);

/* "X,Y,W,H" in whole pixels; false, and an error that names the option, otherwise. */
bool parse_rectangle(const char *option, const char *text, struct rectangle *rectangle);

#endif
