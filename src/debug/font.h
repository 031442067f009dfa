/* font.h: letters of 5x7 pixels, so that a picture can hold its own scale. */
#ifndef DEBUG_FONT_H
#define DEBUG_FONT_H

#include <stdbool.h>
#include <stddef.h>

#define FONT_WIDTH 5
#define FONT_HEIGHT 7
#define FONT_ADVANCE 6 /* from a letter to the next */

/* Whether a letter's pixel is set, column < FONT_WIDTH, row < FONT_HEIGHT from the top. Small
 * letters look like capitals; what the font lacks looks like '?'. */
bool font_pixel(char letter, size_t column, size_t row);

#endif
