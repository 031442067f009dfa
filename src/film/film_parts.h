/* film_parts.h: films of parts of a picture (--crop), which lie side by side, as one film.
 *
 * A part's film is that of the whole picture there, bit for bit (pipeline/crop.c). So is what parts
 * make together, and so what becomes of it: denoisers see across borders that parts had.
 */
#ifndef FILM_FILM_PARTS_H
#define FILM_FILM_PARTS_H

#include "film/film_sum.h"

/* Where in the picture it lies. */
struct rectangle film_parts_place(const struct film_sum *part);

/* The smallest rectangle around all of them, of which there is at least one. */
struct rectangle film_parts_around(const struct film_sum *const parts[], size_t count);

/* Whether two parts have pixels in common. */
bool film_parts_meet(const struct film_sum *a, const struct film_sum *b);

/* Pixels of all parts, none of which meet. */
size_t film_parts_pixels(const struct film_sum *const parts[], size_t count);

/* Makes one film of parts that have the same planes and passes and fill the rectangle around them.
 * The caller releases it where that fails, too. */
ps_result film_parts_join(const struct film_sum *const parts[], size_t count,
                          struct film_sum *joined, struct error *error);

#endif
