/* film_sum.h: the sum of any passes of a render, the same in whatever order and groups they are
 * added (exact_plane.h): what several machines share, or interrupted jobs leave, adds up to the
 * film of one.
 *
 * The cost: 8 bytes for each value of a pixel, or 16 where sums are large, and a sweep over the
 * film in each pass.
 */
#ifndef FILM_FILM_SUM_H
#define FILM_FILM_SUM_H

#include "base/parallel.h"
#include "film/exact_plane.h"
#include "film/film.h"
#include "film/pass_set.h"

/* Values that a pixel has in the sum: those of the film, of the odd passes, and of halves of the
 * passes; and r^2 + g^2 + b^2 of each pass's indirect light, which gives its variance. */
enum {
    FILM_SUM_OF_ODD = FILM_PLANES,
    FILM_SUM_OF_HALF = 2 * FILM_PLANES,
    FILM_SUM_OF_SQUARES = 3 * FILM_PLANES,
    FILM_SUM_PLANES
};

struct film_sum {
    size_t width, height;
    struct picture_window window; /* where in the picture it lies */
    struct pass_set passes;
    struct exact_plane planes[FILM_SUM_PLANES]; /* high is NULL where the film has no such plane */
    uint32_t *object, *material;                /* of pass 0, owned; NULL where the film has none */
};

/* The sum of no passes, with the planes of a film. The caller releases it where that fails, too. */
ps_result film_sum_create(const struct film *film, struct film_sum *sum, struct error *error);
/* A film of no pass with the planes of a sum, for film_sum_round. */
ps_result film_sum_create_film(const struct film_sum *sum, struct film *film, struct error *error);

void film_sum_release(struct film_sum *sum);

/* Makes it the sum of no passes again; ids stay. */
void film_sum_clear(struct film_sum *sum);
size_t film_sum_bytes(const struct film_sum *sum);

/* Whether a film has the place and the planes of the sum. */
bool film_sum_fits(const struct film_sum *sum, const struct film *film);

/* Adds a film that fits and holds pass `film->number` alone, which is not in the sum yet. When out
 * of memory, PS_ERROR_MEMORY, the sum is lost: it is of no passes then. */
ps_result film_sum_add(struct film_sum *sum, const struct film *film, struct workers *workers,
                       struct error *error);

/* Whether both have the same planes; and the same place, too. */
bool film_sum_has_planes_of(const struct film_sum *a, const struct film_sum *b);
bool film_sum_is_alike(const struct film_sum *a, const struct film_sum *b);

/* Adds another sum, of other passes and the same planes; likewise. */
ps_result film_sum_merge(struct film_sum *sum, const struct film_sum *other,
                         struct workers *workers, struct error *error);

/* Rounds the sums to a film of the same planes, which then holds all passes of the sum. */
void film_sum_round(const struct film_sum *sum, struct film *film, struct workers *workers);

#endif
