/* inject.h: the photons that an injection makes of a scene text, without a picture. */
#ifndef TESTS_SUPPORT_INJECT_H
#define TESTS_SUPPORT_INJECT_H

#include "base/statistics.h"
#include <psplat/host.h>

struct injected {
    ps_photon *photons;
    size_t count;
    float spread; /* see photons.h */
    struct statistics *statistics;
};

/* The photons of one pass; `choice` is such as "photon:count=1000", for one bounce, or "photon
 * bounces=all". A failure fails the test. Release it with injected_release. */
struct injected inject_text(const char *text, const char *choice, uint32_t pass, uint32_t threads);
void injected_release(struct injected *injected);

/* Calls body with a host that has the scene of the text, and no strategies. */
void with_host_of(const char *text, void (*body)(const ps_host *host));

/* The message with which the strategy refuses to start on this scene; fails the test if it does
 * not. The caller frees it. */
char *injection_refusal(const char *text, const char *choice);

/* Sum of the photons' power, all bounces and lobes: red, green, blue. */
struct total_power {
    double r, g, b;
};
struct total_power power_of(const struct injected *injected);

/* Mean of that over the first `passes` passes. */
struct total_power mean_power(const char *text, const char *choice, uint32_t passes);

/* Fails, after printing the figures, unless each colour's ratio is within `tolerance` of 1. */
void expect_power(const char *what, struct total_power power, struct total_power expected,
                  double tolerance);

#endif
