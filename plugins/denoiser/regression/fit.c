/* fit.c: see fit.h. Loops take a run of LANES pixels at a time, as those of plane_fit.c do. */
#include "fit.h"

#include "plane_fit.h"

#include <string.h>

#define MARGIN REGRESSION_MARGIN
#define BLOCK 64       /* side of the squares of pixels that workers take */
#define LEAST_FIT 0.5f /* weight of blended fits below which a pixel becomes a centre */

/* The largest bandwidth around such a pixel. In one pass it is WIDE if the pixels of a narrow fit
 * weigh less than THIN, but no less than FEW. */
enum { NARROW = 24, WIDE = 48 };
#define THIN 256.0f

/* If they weigh less than FEW, D and 1 - cos(normal) are SLACK times as large. */
#define FEW 4.0f
#define SLACK 4.0f

struct fit_job {
    struct regression_light light;
    int first, end;                             /* values that are fitted */
    const struct regression_steering *steering; /* of each image, or NULL */
    float *const *fitted;
    size_t columns, rows; /* of fits */
};

_Static_assert(MARGIN % LANES == 0 && BLOCK % LANES == 0, "they begin where runs do");

size_t regression_runs_of_row(size_t width)
{
    return (width + (size_t)LANES - 1) / LANES + 2 * (MARGIN / LANES);
}

size_t regression_runs(size_t width, size_t height)
{
    return regression_runs_of_row(width) * (height + (size_t)2 * MARGIN);
}

/* --- fits --- */

/* Of the values that are fitted, all together. */
static void make_round_fit(const struct fit_job *job, int x, int y, float slack, float (*plane)[3],
                           struct regression_fit *fit)
{
    const struct regression_parts all = {
        1, {{regression_round_window(job->light.bandwidth), job->first, job->end}}};
    regression_make_fit(&job->light, &all, x, y, slack, plane, fit);
}

/* Of each image by a window of its own. */
static void make_steered_fit(const struct fit_job *job, int x, int y, float (*plane)[3],
                             struct regression_fit *fit)
{
    struct regression_parts images = {.count = job->end / REGRESSION_VALUES};
    for (int i = 0; i < images.count; i++)
        images.of[i] = (struct regression_part){
            .window = regression_steered_window(job->light.on, &job->steering[i],
                                                job->light.bandwidth, x, y),
            .first = i * REGRESSION_VALUES,
            .end = (i + 1) * REGRESSION_VALUES,
        };
    regression_make_fit(&job->light, &images, x, y, 1.0f, plane, fit);
}

/* --- the grid of fits --- */

static int spacing(int bandwidth)
{
    return bandwidth * 2 / 3;
}

static size_t centres_along(size_t size, int bandwidth)
{
    return (size + (size_t)spacing(bandwidth) - 1) / (size_t)spacing(bandwidth);
}

/* As many as for the smallest bandwidth, whose centres are two pixels apart. */
_Static_assert(sizeof(struct regression_fit) / 4 <= REGRESSION_FITS_PIXEL, "fits of a pixel");
_Static_assert(REGRESSION_VALUES * sizeof(float[3]) / 4 <= REGRESSION_PLANES_PIXEL,
               "planes of a pixel");

static size_t most_centres(size_t width, size_t height)
{
    return centres_along(width, REGRESSION_SMALLEST) * centres_along(height, REGRESSION_SMALLEST);
}

size_t regression_fits_bytes(size_t width, size_t height)
{
    return most_centres(width, height) * sizeof(struct regression_fit);
}

size_t regression_planes_bytes(size_t width, size_t height, int count)
{
    return most_centres(width, height) * (size_t)count * sizeof(float[3]);
}

static int centre_at(const struct fit_job *job, size_t index, size_t size)
{
    int apart = spacing(job->light.bandwidth), place = apart / 2 + (int)index * apart;
    return place < (int)size ? place : (int)size - 1;
}

static void make_row_of_fits(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct fit_job *job = user;
    const struct regression *to = job->light.on;
    if (to->host->cancelled(to->host))
        return;
    for (size_t i = 0; i < job->columns; i++) {
        size_t index = row * job->columns + i;
        int x = centre_at(job, i, to->width), y = centre_at(job, row, to->height);
        float(*plane)[3] = to->planes + index * (size_t)job->end;
        if (job->steering)
            make_steered_fit(job, x, y, plane, &to->fits[index]);
        else
            make_round_fit(job, x, y, 1.0f, plane, &to->fits[index]);
    }
}

/* --- what fits say, blended --- */

/* Sums over the fits that reach into a square of pixels, with weights for each group of values:
 * images with halves, and those without. */
enum { WITH_HALVES, WITHOUT_HALVES, GROUPS };

struct block {
    int x, y, columns, rows;
    int group; /* whose weights are added to */
    _Alignas(64) float weights[GROUPS][BLOCK][BLOCK / LANES][LANES];
    float values[REGRESSION_MOST][BLOCK][BLOCK / LANES][LANES];
};

/* What a fit says of a run of pixels, in proportion to its weight there: one by geometry, times a
 * tent that ends at the centres next to it. */
static PS_INLINED void add_prediction(const struct fit_job *job, const struct regression_fit *fit,
                                      size_t run, int x, int y, struct block *block)
{
    _Alignas(64) float w[LANES], u[LANES], v[LANES];
    int at = (x - block->x) / LANES, row = y - block->y;
    float scale = 1.0f / (float)spacing(job->light.bandwidth);
    float down = 1.0f - fabsf((float)(y - fit->y)) * scale;
    float *restrict weight = block->weights[block->group][row][at];
    if (!take_pixels(job->light.on, fit, run, w, u, v))
        return;
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        w[i] *= down * above_zero(1.0f - fabsf((float)(x + i - fit->x)) * scale);
        weight[i] += w[i];
    }
    for (int c = job->first; c < job->end; c++) {
        float a = fit->plane[c][0], b = fit->plane[c][1], d = fit->plane[c][2];
        float *restrict sum = block->values[c][row][at];
#pragma omp simd
        for (int i = 0; i < LANES; i++)
            sum[i] += w[i] * (a + b * u[i] + d * v[i]);
    }
}

PS_EVERY_ISA static void blend(const struct fit_job *job, const struct regression_fit *fit,
                               struct block *block)
{
    int reach = spacing(job->light.bandwidth) - 1;
    int left = larger(fit->x - reach, block->x);
    int right = smaller(fit->x + reach, block->x + block->columns - 1);
    int top = larger(fit->y - reach, block->y);
    int bottom = smaller(fit->y + reach, block->y + block->rows - 1);
    for (int y = top; y <= bottom; y++) {
        size_t run = regression_run(job->light.on, left, y);
        for (int x = regression_start_of_run(left); x <= right; x += LANES)
            add_prediction(job, fit, run++, x, y, block);
    }
}

/* A centre at or before the first one that reaches a pixel. */
static size_t first_centre(const struct fit_job *job, int pixel)
{
    int apart = spacing(job->light.bandwidth), index = (pixel - apart / 2) / apart - 1;
    return index > 0 ? (size_t)index : 0;
}

static void blend_grid(const struct fit_job *job, struct block *block)
{
    int apart = spacing(job->light.bandwidth);
    for (size_t row = first_centre(job, block->y); row < job->rows; row++) {
        if (centre_at(job, row, job->light.on->height) - apart >= block->y + block->rows)
            break;
        for (size_t column = first_centre(job, block->x); column < job->columns; column++) {
            const struct regression_fit *fit = &job->light.on->fits[row * job->columns + column];
            if (fit->x - apart >= block->x + block->columns)
                break;
            if (fit->valid)
                blend(job, fit, block);
        }
    }
}

/* Blends the narrow fit of a group, or a wider or looser one where it needs that. */
static void blend_for(const struct fit_job *narrow, int bandwidth, struct regression_fit fit,
                      struct block *block)
{
    struct fit_job rest = *narrow;
    if (fit.weight < FEW && rest.light.bandwidth == NARROW) {
        make_round_fit(&rest, fit.x, fit.y, SLACK, fit.plane, &fit);
    } else if (fit.weight < THIN && bandwidth > NARROW && block->group != WITH_HALVES) {
        rest.light.bandwidth = smaller(bandwidth, WIDE);
        make_round_fit(&rest, fit.x, fit.y, 1.0f, fit.plane, &fit);
    }
    blend(&rest, &fit, block);
}

/* A fit of its own for a pixel that the fits of the grid do not cover. Near creases, where a
 * surface ends, a narrow window is best. On thin surfaces (weight below THIN) it holds too few
 * pixels, so images without halves, which are of one pass, take a WIDE one; several passes mix
 * surfaces at edges, and a wide window would take in pixels that only seem to be alike. Pixels with
 * hardly any match (weight below FEW) are fitted with looser limits (SLACK). */
static void blend_one(const struct fit_job *job, int x, int y, const bool needs_fit[GROUPS],
                      struct block *block)
{
    const int ends[GROUPS] = {job->light.on->narrow, job->end};
    struct regression_fit fit;
    float plane[REGRESSION_MOST][3];
    struct fit_job rest = *job;
    rest.light.bandwidth = smaller(job->light.bandwidth, NARROW);
    rest.first = needs_fit[WITH_HALVES] ? 0 : ends[WITH_HALVES];
    rest.end = needs_fit[WITHOUT_HALVES] ? ends[WITHOUT_HALVES] : ends[WITH_HALVES];
    make_round_fit(&rest, x, y, 1.0f, plane, &fit);
    for (int group = 0; group < GROUPS; group++) {
        rest.first = group == WITH_HALVES ? 0 : ends[WITH_HALVES];
        rest.end = ends[group];
        block->group = group;
        if (needs_fit[group])
            blend_for(&rest, job->light.bandwidth, fit, block);
    }
}

/* A group is blended as if it were alone. */
static void blend_rest(const struct fit_job *job, struct block *block)
{
    int narrow = job->light.on->narrow;
    memcpy(block->weights[WITHOUT_HALVES], block->weights[WITH_HALVES],
           sizeof block->weights[WITHOUT_HALVES]);
    for (int row = 0; row < block->rows; row++)
        for (int column = 0; column < block->columns; column++) {
            int x = block->x + column, y = block->y + row, run = column / LANES, i = column % LANES;
            const bool needs_fit[GROUPS] = {
                narrow > 0 && block->weights[WITH_HALVES][row][run][i] < LEAST_FIT,
                narrow < job->end && block->weights[WITHOUT_HALVES][row][run][i] < LEAST_FIT,
            };
            if ((needs_fit[WITH_HALVES] || needs_fit[WITHOUT_HALVES]) &&
                regression_shows_surface(job->light.on, x, y))
                blend_one(job, x, y, needs_fit, block);
        }
}

PS_EVERY_ISA static void store_row(const float *restrict weights, const float *restrict values,
                                   int count, float *restrict out)
{
#pragma omp simd
    for (int i = 0; i < count; i++) {
        bool some = weights[i] > 0.0f;
        out[i] = (some ? values[i] : 0.0f) / (some ? weights[i] : 1.0f);
    }
}

static void store_block(const struct fit_job *job, const struct block *block)
{
    for (int row = 0; row < block->rows; row++)
        for (int c = job->first; c < job->end; c++) {
            size_t first = (size_t)(block->y + row) * job->light.on->width + (size_t)block->x;
            int group = c < job->light.on->narrow ? WITH_HALVES : WITHOUT_HALVES;
            store_row((const float *)block->weights[group][row],
                      (const float *)block->values[c][row], block->columns, job->fitted[c] + first);
        }
}

static size_t blocks_along(size_t size)
{
    return (size + BLOCK - 1) / BLOCK;
}

static void fill_block(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct fit_job *job = user;
    const struct regression *to = job->light.on;
    struct block block;
    if (to->host->cancelled(to->host))
        return;
    block.group = WITH_HALVES; /* until the grid is blended, which is the same for all */
    memset(block.weights[0], 0, sizeof block.weights[0]);
    memset(block.values, 0, (size_t)job->end * sizeof block.values[0]);
    block.x = (int)(index % blocks_along(to->width)) * BLOCK;
    block.y = (int)(index / blocks_along(to->width)) * BLOCK;
    block.columns = smaller((int)to->width - block.x, BLOCK);
    block.rows = smaller((int)to->height - block.y, BLOCK);
    blend_grid(job, &block);
    blend_rest(job, &block);
    store_block(job, &block);
}

void regression_fit(const struct regression *regression, int bandwidth, int count,
                    float *const values[], const struct regression_steering *steering,
                    float *const fitted[])
{
    const ps_host *host = regression->host;
    struct fit_job job = {
        .light = {regression, bandwidth, values},
        .end = count,
        .steering = steering,
        .fitted = fitted,
        .columns = centres_along(regression->width, bandwidth),
        .rows = centres_along(regression->height, bandwidth),
    };
    host->parallel_for(host, job.rows, make_row_of_fits, &job);
    host->parallel_for(host, blocks_along(regression->width) * blocks_along(regression->height),
                       fill_block, &job);
}
