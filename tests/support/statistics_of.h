/* statistics_of.h: the mean of a render and how far it may be off by noise alone. */
#ifndef TESTS_SUPPORT_STATISTICS_OF_H
#define TESTS_SUPPORT_STATISTICS_OF_H

#include <stddef.h>

struct estimate {
    double mean;
    double standard_error; /* of the mean */
};

/* Of what independent runs gave, at least two. */
struct estimate estimate_of(const double *values, int count);

/* Mean over the picture of a channel, over `seeds` renders of a text that holds "%d" where the seed
 * goes. */
struct estimate estimate_channel(const char *text, const char *const choices[], const char *channel,
                                 int seeds);

/* Fails, after printing all figures, unless |mean / expected - 1| is at most `bias` plus four
 * standard errors, and the standard error itself is small enough for that to mean something (5 %).
 */
void expect_estimate(const char *what, struct estimate estimate, double expected, double bias);

/* The same where what is expected is an estimate itself. */
void expect_agreement(const char *what, struct estimate estimate, struct estimate truth,
                      double bias);

#endif
