/* pixel_metrics.h: metrics that look at one pixel at a time; metric.h has their definitions. */
#ifndef COMPARE_PIXEL_METRICS_H
#define COMPARE_PIXEL_METRICS_H

#include "compare/picture_pair.h"

/* `numbers`: one out; pixel_bias one for each channel. */
ps_result pixel_thesis_rmse(const struct picture_pair *pair, double *numbers, struct error *error);
ps_result pixel_rel_rmse(const struct picture_pair *pair, double *numbers, struct error *error);
ps_result pixel_relmse(const struct picture_pair *pair, double *numbers, struct error *error);
ps_result pixel_bias(const struct picture_pair *pair, double *numbers, struct error *error);
ps_result pixel_psnr(const struct picture_pair *pair, double *numbers, struct error *error);
ps_result pixel_max(const struct picture_pair *pair, double *numbers, struct error *error);
ps_result pixel_p99(const struct picture_pair *pair, double *numbers, struct error *error);

#endif
