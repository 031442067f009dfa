/* id_colour.h: a colour for each number, so that neighbouring areas can be told apart. */
#ifndef DEBUG_ID_COLOUR_H
#define DEBUG_ID_COLOUR_H

#include "debug/canvas.h"

/* By a hash of the number: never dark, and the same in every picture. Different numbers may, by
 * chance, look alike. */
struct colour id_colour(uint64_t id);

/* For few numbers in a row, of which a legend can tell: hues that are far apart. */
struct colour series_colour(unsigned number);

#endif
