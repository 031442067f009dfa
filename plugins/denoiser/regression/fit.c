/* fit.c: see fit.h. Loops take a run of LANES pixels at a time, as those of plane_fit.c do. */
#include "fit.h"

#include "plane_fit.h"

#include <string.h>

#define MARGIN REGRESSION_MARGIN
#define BLOCK 64       /* side of the squares of pixels that workers take */
#define LEAST_FIT 0.5f /* weight of blended fits below which a pixel becomes a centre */

/* The largest bandwidth around such a pixel. In one pass it is WIDE if the pixels of a narrow fit weigh less than THIN, but
 * no less than FEW. */
enum { NARROW = 24, WIDE = 48 };
#define THIN 256.0f

/* If they weigh less than FEW, D and 1 - cos(normal) are SLACK times as large. */
#define FEW 4.0f
#define SLACK 4.0f

struct work {
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
static void make_round_fit(const struct work *work, int x, int y, float slack, float (*plane)[3],
                           struct regression_fit *fit)
{
    const struct regression_parts all = {
        1, {{regression_round_window(work->light.bandwidth), work->first, work->end}}};
    regression_make_fit(&work->light, &all, x, y, slack, plane, fit);
}

/* Of each image by a window of its own. */
static void make_steered_fit(const struct work *work, int x, int y, float (*plane)[3],
                             struct regression_fit *fit)
{
    struct regression_parts images = {.count = work->end / REGRESSION_VALUES};
    for (int i = 0; i < images.count; i++)
        images.of[i] = (struct regression_part){
            .window = regression_steered_window(work->light.on, &work->steering[i],
                                                work->light.bandwidth, x, y),
            .first = i * REGRESSION_VALUES,
            .end = (i + 1) * REGRESSION_VALUES,
        };
    regression_make_fit(&work->light, &images, x, y, 1.0f, plane, fit);
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

static int centre_at(const struct work *work, size_t index, size_t size)
{
    int apart = spacing(work->light.bandwidth), place = apart / 2 + (int)index * apart;
    return place < (int)size ? place : (int)size - 1;
}

static void make_row_of_fits(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    const struct regression *to = work->light.on;
    if (to->host->cancelled(to->host))
        return;
    for (size_t i = 0; i < work->columns; i++) {
        size_t index = row * work->columns + i;
        int x = centre_at(work, i, to->width), y = centre_at(work, row, to->height);
        float(*plane)[3] = to->planes + index * (size_t)work->end;
        if (work->steering)
            make_steered_fit(work, x, y, plane, &to->fits[index]);
        else
            make_round_fit(work, x, y, 1.0f, plane, &to->fits[index]);
    }
}

/* --- what fits say, blended --- */

/* Sums over the fits that reach into a square of pixels. Weights of values that ask for narrow fits, and of the others. */
enum { NARROW_ONES, OTHERS, GROUPS };

struct block {
    int x, y, columns, rows;
    int group; /* whose weights are added to */
    _Alignas(64) float weights[GROUPS][BLOCK][BLOCK / LANES][LANES];
    float values[REGRESSION_MOST][BLOCK][BLOCK / LANES][LANES];
};

/* What a fit says of a run of pixels, in proportion to its weight there: one by geometry, times a tent that ends at
 * the centres next to it. */
static PS_INLINED void add_prediction(const struct work *work, const struct regression_fit *fit,
                                      size_t run, int x, int y, struct block *block)
{
    _Alignas(64) float w[LANES], u[LANES], v[LANES];
    int at = (x - block->x) / LANES, row = y - block->y;
    float scale = 1.0f / (float)spacing(work->light.bandwidth);
    float down = 1.0f - fabsf((float)(y - fit->y)) * scale;
    float *restrict weight = block->weights[block->group][row][at];
    if (!take_pixels(work->light.on, fit, run, w, u, v))
        return;
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        w[i] *= down * above_zero(1.0f - fabsf((float)(x + i - fit->x)) * scale);
        weight[i] += w[i];
    }
    for (int c = work->first; c < work->end; c++) {
        float a = fit->plane[c][0], b = fit->plane[c][1], d = fit->plane[c][2];
        float *restrict sum = block->values[c][row][at];
#pragma omp simd
        for (int i = 0; i < LANES; i++)
            sum[i] += w[i] * (a + b * u[i] + d * v[i]);
    }
}

PS_EVERY_ISA static void blend(const struct work *work, const struct regression_fit *fit,
                               struct block *block)
{
    int reach = spacing(work->light.bandwidth) - 1;
    int left = larger(fit->x - reach, block->x);
    int right = smaller(fit->x + reach, block->x + block->columns - 1);
    int top = larger(fit->y - reach, block->y);
    int bottom = smaller(fit->y + reach, block->y + block->rows - 1);
    for (int y = top; y <= bottom; y++) {
        size_t run = regression_run(work->light.on, left, y);
        for (int x = regression_start_of_run(left); x <= right; x += LANES)
            add_prediction(work, fit, run++, x, y, block);
    }
}

/* A centre at or before the first one that reaches a pixel. */
static size_t first_centre(const struct work *work, int pixel)
{
    int apart = spacing(work->light.bandwidth), index = (pixel - apart / 2) / apart - 1;
    return index > 0 ? (size_t)index : 0;
}

static void blend_grid(const struct work *work, struct block *block)
{
    int apart = spacing(work->light.bandwidth);
    for (size_t row = first_centre(work, block->y); row < work->rows; row++) {
        if (centre_at(work, row, work->light.on->height) - apart >= block->y + block->rows)
            break;
        for (size_t column = first_centre(work, block->x); column < work->columns; column++) {
            const struct regression_fit *fit = &work->light.on->fits[row * work->columns + column];
            if (fit->x - apart >= block->x + block->columns)
                break;
            if (fit->valid)
                blend(work, fit, block);
        }
    }
}

/* What values of a group ask for beyond a narrow fit, blended. */
static void blend_for(const struct work *narrow, int bandwidth, struct regression_fit fit,
                      struct block *block)
{
    struct work rest = *narrow;
    if (fit.weight < FEW && rest.light.bandwidth == NARROW) {
        make_round_fit(&rest, fit.x, fit.y, SLACK, fit.plane, &fit);
    } else if (fit.weight < THIN && bandwidth > NARROW && block->group != NARROW_ONES) {
        rest.light.bandwidth = smaller(bandwidth, WIDE);
        make_round_fit(&rest, fit.x, fit.y, 1.0f, fit.plane, &fit);
    }
    blend(&rest, &fit, block);
}

/* A fit around a pixel that no centre is like. By creases, where a surface ends, a narrow window is best. What is thin has few
 * pixels in it, and needs a wide one; but several passes mix what pixels show at edges, and more of a wide window seems to
 * be like them than is. Pixels that are like hardly any other learn more about their light from what is about as far away
 * and about as steep than from their own few samples. */
static void blend_one(const struct work *work, int x, int y, const bool asks[GROUPS],
                      struct block *block)
{
    const int ends[GROUPS] = {work->light.on->narrow, work->end};
    struct regression_fit fit;
    float plane[REGRESSION_MOST][3];
    struct work rest = *work;
    rest.light.bandwidth = smaller(work->light.bandwidth, NARROW);
    rest.first = asks[NARROW_ONES] ? 0 : ends[NARROW_ONES];
    rest.end = asks[OTHERS] ? ends[OTHERS] : ends[NARROW_ONES];
    make_round_fit(&rest, x, y, 1.0f, plane, &fit);
    for (int group = 0; group < GROUPS; group++) {
        rest.first = group == NARROW_ONES ? 0 : ends[NARROW_ONES];
        rest.end = ends[group];
        block->group = group;
        if (asks[group])
            blend_for(&rest, work->light.bandwidth, fit, block);
    }
}

/* A group is blended as if it were alone. */
static void blend_rest(const struct work *work, struct block *block)
{
    int narrow = work->light.on->narrow;
    memcpy(block->weights[OTHERS], block->weights[NARROW_ONES], sizeof block->weights[OTHERS]);
    for (int row = 0; row < block->rows; row++)
        for (int column = 0; column < block->columns; column++) {
            int x = block->x + column, y = block->y + row, run = column / LANES, i = column % LANES;
            const bool asks[GROUPS] = {
                narrow > 0 && block->weights[NARROW_ONES][row][run][i] < LEAST_FIT,
                narrow < work->end && block->weights[OTHERS][row][run][i] < LEAST_FIT,
            };
            if ((asks[NARROW_ONES] || asks[OTHERS]) &&
                regression_shows_surface(work->light.on, x, y))
                blend_one(work, x, y, asks, block);
        }
}

static void store_run(const struct block *block, int row, int run, int c, int group, float *out)
{
    const float *weights = block->weights[group][row][run], *values = block->values[c][row][run];
    int count = smaller(block->columns - run * LANES, LANES);
    for (int i = 0; i < count; i++)
        out[i] = weights[i] > 0.0f ? values[i] / weights[i] : 0.0f;
}

static void store_block(const struct work *work, const struct block *block)
{
    for (int row = 0; row < block->rows; row++)
        for (int c = work->first; c < work->end; c++) {
            size_t first = (size_t)(block->y + row) * work->light.on->width + (size_t)block->x;
            int group = c < work->light.on->narrow ? NARROW_ONES : OTHERS;
            for (int run = 0; run * LANES < block->columns; run++)
                store_run(block, row, run, c, group,
                          work->fitted[c] + first + (size_t)(run * LANES));
        }
}

static size_t blocks_along(size_t size)
{
    return (size + BLOCK - 1) / BLOCK;
}

static void fill_block(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    const struct regression *to = work->light.on;
    struct block block;
    if (to->host->cancelled(to->host))
        return;
    block.group = NARROW_ONES; /* until the grid is blended, which is the same for all */
    memset(block.weights[0], 0, sizeof block.weights[0]);
    memset(block.values, 0, (size_t)work->end * sizeof block.values[0]);
    block.x = (int)(index % blocks_along(to->width)) * BLOCK;
    block.y = (int)(index / blocks_along(to->width)) * BLOCK;
    block.columns = smaller((int)to->width - block.x, BLOCK);
    block.rows = smaller((int)to->height - block.y, BLOCK);
    blend_grid(work, &block);
    blend_rest(work, &block);
    store_block(work, &block);
}

void regression_fit(const struct regression *regression, int bandwidth, int count,
                    float *const values[], const struct regression_steering *steering,
                    float *const fitted[])
{
    const ps_host *host = regression->host;
    struct work work = {
        .light = {regression, bandwidth, values},
        .end = count,
        .steering = steering,
        .fitted = fitted,
        .columns = centres_along(regression->width, bandwidth),
        .rows = centres_along(regression->height, bandwidth),
    };
    host->parallel_for(host, work.rows, make_row_of_fits, &work);
    host->parallel_for(host, blocks_along(regression->width) * blocks_along(regression->height),
                       fill_block, &work);
}
