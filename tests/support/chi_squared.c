/* chi_squared.c: the regularized incomplete gamma function, by its series where that converges
 * fast and by Lentz's continued fraction elsewhere (Press et al., "Numerical recipes", 6.2). */
#include "support/chi_squared.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>

#include <cmocka.h>

#define MOST_TERMS 2000
#define PRECISION 1e-14

/* Lower tail, P(a, x), for x < a + 1. */
static double gamma_series(double a, double x)
{
    double term = 1 / a, sum = term;
    for (int i = 1; i < MOST_TERMS && term > sum * PRECISION; i++) {
        term *= x / (a + i);
        sum += term;
    }
    return sum * exp(a * log(x) - x - lgamma(a));
}

/* Upper tail, Q(a, x), for x >= a + 1. */
static double gamma_fraction(double a, double x)
{
    double b = x + 1 - a, c = 1e300, d = 1 / b, product = d;
    for (int i = 1; i < MOST_TERMS; i++) {
        double numerator = -i * (i - a);
        b += 2;
        d = 1 / (numerator * d + b);
        c = b + numerator / c;
        product *= c * d;
        if (fabs(c * d - 1) < PRECISION)
            break;
    }
    return product * exp(a * log(x) - x - lgamma(a));
}

double chi_squared_tail(double statistic, double freedom)
{
    double a = 0.5 * freedom, x = 0.5 * statistic;
    if (x <= 0)
        return 1;
    return x < a + 1 ? 1 - gamma_series(a, x) : gamma_fraction(a, x);
}

double chi_squared_probability(const double *observed, const double *expected, size_t n)
{
    double statistic = 0, surplus = 0, total = 0;
    for (size_t i = 0; i < n; i++) {
        assert_true(expected[i] >= 5);
        double difference = observed[i] - expected[i];
        statistic += difference * difference / expected[i];
        surplus += difference;
        total += expected[i];
    }
    assert_true(fabs(surplus) < 1e-6 * total);
    return chi_squared_tail(statistic, (double)(n - 1));
}
