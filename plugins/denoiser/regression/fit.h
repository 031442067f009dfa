/* fit.h: planes fitted to a picture along the surfaces that it shows.
 *
 * Around a centre p, a pixel, a plane over the tangent plane of p is fitted to the values E of the
 * pixels q near it (Moon et al. 2014, "Adaptive rendering based on weighted local regression";
 * Bitterli et al. 2016, "Nonlinearly weighted first-order regression for denoising Monte Carlo
 * renderings"):
 *
 *     minimize  sum over q of w(p, q) (E(q) - e_0 - e_u u(q) - e_v v(q))^2
 *     w = T(r^2 / R^2) T((1 - n_p.n_q) / (1 - cos(normal))) T(h^2 / D^2 + (g_p - g_q)^2 / G^2)
 *     T(s) = max(0, 1 - s)^2   (Tukey's biweight)
 *
 * with u, v the position of q in the tangent plane of p, r its distance in pixels, R the bandwidth,
 * h^2 the sum of squares of either point's distance from the other's tangent plane, and g the share
 * of the reflectance that is gloss. A slope of E costs no bias, as it would a mean. Where light
 * steers the windows, they are ellipses in place of discs of radius R (steering.h). Centres lie 2/3
 * R apart; between them planes are blended. Pixels that no centre is like become centres; if hardly
 * any pixel is like one, D and 1 - cos(normal) are four times as large around it.
 *
 * Pictures are planes of floats with a margin, so that no loop asks for bounds. The runs of 16
 * pixels of a row, of all planes, lie one after the other, since a fit takes what is near in all of
 * them: pixel (x, y) is regression_at().
 */
#ifndef PSPLAT_DENOISER_REGRESSION_FIT_H
#define PSPLAT_DENOISER_REGRESSION_FIT_H

#include <psplat/plugin.h>
#include <stdbool.h>

enum { REGRESSION_SMALLEST = 3, REGRESSION_LARGEST = 64 }; /* bandwidths, in pixels */
enum { REGRESSION_LANES = 16 }; /* pixels of a run, which are taken at a time */

/* Values of an image: three colours, and one more. Those of several images that show the same
 * surfaces are fitted together, since most of the work is to weigh pixels. */
enum { REGRESSION_COLOURS = 3, REGRESSION_VALUES };
enum { REGRESSION_IMAGES = 3, REGRESSION_MOST = REGRESSION_IMAGES * REGRESSION_VALUES };

struct regression_bounds;
struct regression_fit;

/* What is known of an image's light, by which windows of fits are steered (steering.h). */
struct regression_steering {
    float *const *light; /* REGRESSION_COLOURS planes without a margin; borrowed */
    float least;         /* brightness that counts as dark */
};

/* A picture's surfaces, and how fits stop at them. The planes, `bounds` and `fits` are the
 * caller's. */
struct regression {
    const ps_host *host;
    size_t width, height;
    size_t runs_of_row;             /* regression_runs_of_row() */
    size_t runs_apart;              /* floats: REGRESSION_LANES for each plane that lies there */
    float *normal[3], *position[3]; /* of length 1; in the scene's units */
    float *gloss;                   /* share of the reflectance that is not diffuse */
    float *size;      /* of a pixel there, in the scene's units; 0: no surface is seen */
    float bend_scale; /* 1 / (1 - cos(normal)) */
    /* So many values, the first ones, ask for narrow fits around pixels that no centre is like. */
    int narrow;
    float distance;                   /* D, in the scene's units; 0: in proportion to R */
    struct regression_bounds *bounds; /* regression_bounds_find() */
    struct regression_fit *fits;      /* room for regression_fits_bytes() */
    float (*planes)[3];               /* room for regression_planes_bytes() */
};

/* How bright an image is there: the sum of its colours. */
static inline float brightness_at(float *const planes[], size_t at)
{
    return planes[0][at] + planes[1][at] + planes[2][at];
}

/* Pixels around a picture, whose floats are 0: whole runs. */
enum { REGRESSION_MARGIN = REGRESSION_LARGEST };

/* Runs of a row, and of a plane, with the margin. */
size_t regression_runs_of_row(size_t width);
size_t regression_runs(size_t width, size_t height);

/* The run that holds a pixel, and the pixel's place in a plane. It may lie in the margin. */
static inline size_t regression_run(const struct regression *regression, int x, int y)
{
    return (size_t)(y + REGRESSION_MARGIN) * regression->runs_of_row +
           (size_t)(x + REGRESSION_MARGIN) / REGRESSION_LANES;
}

static inline size_t regression_at(const struct regression *regression, int x, int y)
{
    return regression_run(regression, x, y) * regression->runs_apart +
           (size_t)(x + REGRESSION_MARGIN) % REGRESSION_LANES;
}

/* The column where the run begins that holds a pixel. */
static inline int regression_start_of_run(int x)
{
    return (x + REGRESSION_MARGIN) / REGRESSION_LANES * REGRESSION_LANES - REGRESSION_MARGIN;
}

static inline bool regression_shows_surface(const struct regression *regression, int x, int y)
{
    return regression->size[regression_at(regression, x, y)] > 0.0f;
}

/* Whether pixel b, of these places in a plane, may show the surface that a does. */
static inline bool regression_is_like(const struct regression *regression, size_t a, size_t b)
{
    const float flat = 0.98f; /* cosine of the normals above which pixels may show one surface */
    float cosine = 0.0f, height = 0.0f;
    for (int i = 0; i < 3; i++) {
        float n = regression->normal[i][a];
        cosine += n * regression->normal[i][b];
        height += n * (regression->position[i][b] - regression->position[i][a]);
    }
    return regression->size[b] > 0.0f && cosine > flat && fabsf(height) < regression->size[a];
}

size_t regression_fits_bytes(size_t width, size_t height);
size_t regression_planes_bytes(size_t width, size_t height, int count);
#define REGRESSION_FITS_PIXEL 24   /* bytes of them for each pixel, at most */
#define REGRESSION_PLANES_PIXEL 12 /* the same for each image */

/* Fits `count` values, at most REGRESSION_MOST planes with a margin, by a bandwidth in pixels. Puts
 * what the planes of all fits say at each pixel into `fitted`, planes without a margin; 0 where no
 * surface is seen. Each image is fitted as if it were alone, to the last bit. `steering`: of each
 * image's grid of fits, or NULL. Runs on all workers; after the host was cancelled, what `fitted`
 * holds means nothing. */
void regression_fit(const struct regression *regression, int bandwidth, int count,
                    float *const values[], const struct regression_steering *steering,
                    float *const fitted[]);

#endif
