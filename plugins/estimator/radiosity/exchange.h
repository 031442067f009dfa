/* exchange.h: how much light two elements exchange: their form factor times area, shadows included;
 * see links.h.
 *
 * Areas are in squares of the scene's radius. All functions: any thread.
 */
#ifndef PSPLAT_ESTIMATOR_RADIOSITY_EXCHANGE_H
#define PSPLAT_ESTIMATOR_RADIOSITY_EXCHANGE_H

#include "element.h"

struct exchange {
    float value;   /* F_pq A_p; without shadows first */
    float most;    /* at most, about: what pairs are divided by */
    float visible; /* share of it that shadow rays say is there */
    bool is_clear; /* nothing stands between */
};

/* Whether some of each lies before the other. */
bool exchange_is_possible(const struct elements *elements, uint32_t p, uint32_t q);

struct exchange exchange_without_shadows(const struct elements *elements, uint32_t p, uint32_t q);

void exchange_add_shadows(const struct elements *elements, uint32_t p, uint32_t q,
                          struct exchange *exchange);

bool exchange_is_clear(const struct elements *elements, uint32_t p, uint32_t q,
                       const struct exchange *exchange);

#endif
