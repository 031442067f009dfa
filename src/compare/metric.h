/* metric.h: how much a picture differs from its reference, as numbers.
 *
 * I is the test picture, R the reference; "display" values are sRGB-encoded and clipped to 0..1,
 * not rounded. Means and sums run over all pixels and channels, in double and in one order; pixels
 * that are left out do not count, but SSIM and FLIP, which look at neighbourhoods, take them as
 * black in both pictures. The pictures must be finite (picture_pair_check_finite).
 */
#ifndef COMPARE_METRIC_H
#define COMPARE_METRIC_H

#include "compare/picture_pair.h"
#include <stdbool.h>

enum metric {
    METRIC_THESIS_RMSE, /* RMSE of 0..255 display values, added over channels (thesis, 5.1) */
    METRIC_REL_RMSE,    /* sqrt(sum (I-R)^2 / sum R^2), linear */
    METRIC_RELMSE,      /* mean of (I-R)^2 / (R^2 + 0.01), linear */
    METRIC_BIAS,        /* mean I / mean R, linear, one for each channel */
    METRIC_PSNR,        /* 10 log10(1 / mean (I-R)^2) of display values, dB */
    METRIC_SSIM,        /* ssim.h */
    METRIC_MAX,         /* largest |I-R|, linear */
    METRIC_P99,         /* 99th percentile over pixels of the channels' largest |I-R|, linear */
    METRIC_FLIP,        /* flip.h */
    METRIC_COUNT
};

struct metric_value {
    size_t count; /* of numbers: the channels' for bias, else 1 */
    double numbers[3];
};

const char *metric_name(enum metric metric);

/* The metric whose name is the first `length` characters of `name`; the error suggests one. */
ps_result metric_find(const char *name, size_t length, enum metric *metric, struct error *error);

ps_result metric_evaluate(enum metric metric, const struct picture_pair *pair,
                          struct metric_value *value, struct error *error);

/* A bound on a metric, beyond which a picture is refused: "rel_rmse>0.05". */
struct metric_limit {
    enum metric metric;
    bool above;     /* refuses numbers above the bound, else below */
    bool inclusive; /* and the bound itself */
    double bound;
};

ps_result metric_limit_parse(const char *text, struct metric_limit *limit, struct error *error);

/* Whether any number is refused. NaN always is. */
bool metric_limit_refuses(const struct metric_limit *limit, const struct metric_value *value);

#endif
