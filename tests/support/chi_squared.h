/* chi_squared.h: goodness of fit, for tests of random directions. */
#ifndef TESTS_SUPPORT_CHI_SQUARED_H
#define TESTS_SUPPORT_CHI_SQUARED_H

#include <stddef.h>

/* How likely counts at least so far from `expected` are, if the expectation is right: small values
 * speak against it. The counts must sum to the same total, and each expected count be at least 5.
 */
double chi_squared_probability(const double *observed, const double *expected, size_t n);

/* The upper tail of the distribution with `freedom` degrees at `statistic`. */
double chi_squared_tail(double statistic, double freedom);

#endif
