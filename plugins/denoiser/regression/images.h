/* images.h: images that are denoised together, and the buffers that all stages of regression.c
 * share.
 *
 * They show the same surfaces: indirect light, and the two parts of direct light. A plane holds a
 * float for each pixel.
 */
#ifndef PSPLAT_DENOISER_REGRESSION_WORK_H
#define PSPLAT_DENOISER_REGRESSION_WORK_H

#include "fit.h"

#include <psplat/plugin.h>
#include <stdbool.h>

enum { NOISE = REGRESSION_COLOURS, VALUES = REGRESSION_VALUES };

/* Kinds of pixels (kinds.h): GLOSSY, whose light is mostly mirrored; THIN, whose surface few pixels
 * near by show; BROAD, the others; NO_KIND, no surface. */
enum pixel_kind { NO_KIND, BROAD, THIN, GLOSSY, KINDS };

struct denoised_image {
    const ps_host *host;
    const ps_image_view *view;
    size_t width, height;
    struct regression guides;
    ps_camera camera;
    /* With a margin: irradiance / pi, and the same with outliers limited, which is fitted. The last
     * value of `clamped` is a picture of the noise of the sum of the channels. */
    float *light[VALUES], *clamped[VALUES];
    /* Without: two fits, the sum of bands so far, and for the bands 1 / F_48^2, B^2, N^2 and a
     * plane to smooth these in. Before the bands `noise` holds N, where halves tell it. */
    float *fine[VALUES], *coarse[VALUES], *sum[REGRESSION_COLOURS];
    float *inverse_square, *signal, *noise, *scratch;
    /* For all images: squares of the noise, and of a newer guess of it, over the squares of B^2,
     * sums of weights over the squares of B^2 and N^2; and each pixel_kind. */
    float *noise_near, *newer_near, *signal_weight, *noise_weight, *kind;
    float *shrinkage; /* k of the last band */
    float *error;     /* NULL, or its square so far, times inverse_square */
    float threshold;  /* least c of the band under way */
    enum pixel_kind current_kind;
    float least; /* brightness that counts as dark */
};

struct denoised_images {
    struct denoised_image of[REGRESSION_IMAGES];
    int count, halved; /* so many, the first ones, have halves */
    bool has[KINDS];   /* pixels of these */
};

static inline float brightness(const float colour[REGRESSION_COLOURS])
{
    return colour[0] + colour[1] + colour[2];
}

/* Sets of values. */
typedef float **(*image_planes)(struct denoised_image *image);

static inline float **light_of(struct denoised_image *image)
{
    return image->light;
}

static inline float **clamped_of(struct denoised_image *image)
{
    return image->clamped;
}

static inline float **fine_of(struct denoised_image *image)
{
    return image->fine;
}

static inline float **coarse_of(struct denoised_image *image)
{
    return image->coarse;
}

/* For each image by itself. */
void regression_for_each_row(struct denoised_images *images, ps_body body);

/* Fits one set, the other says what the fits say; all images together. */
void regression_fit_all(struct denoised_images *images, int bandwidth, image_planes from,
                        image_planes to);

/* The same with windows that the sums so far steer. */
void regression_fit_steered(struct denoised_images *images, int bandwidth, image_planes from,
                            image_planes to);

#endif
