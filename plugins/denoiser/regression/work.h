/* work.h: what is at work on each image (regression.c). */
#ifndef PSPLAT_DENOISER_REGRESSION_WORK_H
#define PSPLAT_DENOISER_REGRESSION_WORK_H

#include "fit.h"

#include <psplat/plugin.h>
#include <stdbool.h>

enum { NOISE = REGRESSION_COLOURS, VALUES = REGRESSION_VALUES };

/* Kinds of pixels (kinds.h): those whose light is mostly mirrored; of the others, those that few pixels near by are like, and the rest. No surface
 * is seen in pixels of none. */
enum pixel_kind { NO_KIND, BROAD, THIN, GLOSSY, KINDS };

struct work {
    const ps_host *host;
    const ps_image_view *image;
    size_t width, height;
    struct regression guides;
    ps_camera camera;
    /* With a margin: irradiance / pi, and what of it is fitted, with its noise: the sum of the channels'. */
    float *light[VALUES], *body[VALUES];
    /* Without: two fits, their sum so far, and for the bands 1 / F_48^2, B^2, N^2 and room to smooth those in. Before
     * the bands `noise` holds N, where halves tell it. */
    float *fine[VALUES], *coarse[VALUES], *sum[REGRESSION_COLOURS];
    float *scale, *signal, *noise, *room;
    float *near_by, *around; /* pixels of the kind in the squares of B^2 and N^2, for all images */
    float *kind;             /* pixel_kind, for all images */
    float *kept;             /* k of the band before */
    float *error;            /* where it is asked for: its square, times `scale` */
    float caution;           /* with the band under way */
    enum pixel_kind under_way;
    float least; /* brightness that counts as dark */
};

struct works {
    struct work of[REGRESSION_IMAGES];
    int count, halved; /* so many, the first ones, have halves */
    bool has[KINDS];   /* pixels of these */
};

static inline float brightness(const float colour[REGRESSION_COLOURS])
{
    return colour[0] + colour[1] + colour[2];
}

/* Sets of values. */
typedef float **(*work_planes)(struct work *work);

static inline float **light_of(struct work *work)
{
    return work->light;
}

static inline float **body_of(struct work *work)
{
    return work->body;
}

static inline float **fine_of(struct work *work)
{
    return work->fine;
}

static inline float **coarse_of(struct work *work)
{
    return work->coarse;
}

/* Of each image by itself. */
void regression_for_each_row(struct works *works, ps_body body);

/* Fits one set, the other says what the fits say; all images together. */
void regression_fit_all(struct works *works, int bandwidth, work_planes from, work_planes to);

/* The same with windows that the sums so far steer. */
void regression_fit_steered(struct works *works, int bandwidth, work_planes from, work_planes to);

#endif
