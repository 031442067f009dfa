#include "support/statistics_of.h"

#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define MOST_SEEDS 64

static double render_mean(const char *text, int seed, const char *const choices[],
                          const char *channel)
{
    size_t bytes = strlen(text) + 32;
    char *seeded = malloc(bytes);
    const char *place = strstr(text, "%d");
    assert_non_null(seeded);
    assert_non_null(place);
    snprintf(seeded, bytes, "%.*s%d%s", (int)(place - text), text, seed, place + 2);
    struct rendering rendering = render_text(seeded, 2, choices);
    double mean = mean_of_all(&rendering.image, channel);
    rendering_release(&rendering);
    free(seeded);
    return mean;
}

struct estimate estimate_of(const double *values, int count)
{
    double sum = 0, squares = 0;
    for (int i = 0; i < count; i++)
        sum += values[i];
    double mean = sum / count;
    for (int i = 0; i < count; i++)
        squares += (values[i] - mean) * (values[i] - mean);
    return (struct estimate){mean, sqrt(squares / (count - 1) / count)};
}

struct estimate estimate_channel(const char *text, const char *const choices[], const char *channel,
                                 int seeds)
{
    double means[MOST_SEEDS];
    assert_true(seeds >= 2 && seeds <= MOST_SEEDS);
    for (int i = 0; i < seeds; i++)
        means[i] = render_mean(text, i + 1, choices, channel);
    return estimate_of(means, seeds);
}

void expect_agreement(const char *what, struct estimate estimate, struct estimate truth,
                      double bias)
{
    double off = estimate.mean / truth.mean - 1;
    double noise = hypot(estimate.standard_error, truth.standard_error) / truth.mean;
    print_message("%-60s off by %+.3f %%, noise %.3f %%, bias allowed %.1f %%\n", what, 100 * off,
                  100 * noise, 100 * bias);
    assert_true(noise < 0.05);
    assert_true(fabs(off) <= bias + 4 * noise + 1e-4);
}

void expect_estimate(const char *what, struct estimate estimate, double expected, double bias)
{
    expect_agreement(what, estimate, (struct estimate){expected, 0}, bias);
}
