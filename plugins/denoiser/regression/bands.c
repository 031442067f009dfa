#include "bands.h"

#include "box.h"

#include <psplat/isa.h>
#include <psplat/math.h>

/* Times the noise that a band must exceed where the band before was kept; past the first one, where the noise is guessed of a
 * single pass: that has some of the light in it; and where nothing was kept. */
#define CAUTION 2.0f
#define GUESSED_CAUTION 1.2f
#define ALONE 4.0f
#define PIXELS_CAUTION 1.5f    /* in place of CAUTION for the last band, of the pixels themselves */
#define PIXELS_WINDOW 4        /* R of the window of that band */
#define BROAD_AMONG_THIN 0.03f /* what a pixel of one kind counts for among the other's */
#define AROUND 0.25f /* of a neighbourhood's light, by which dark pixels are measured at least */

static const int bandwidths[] = {48, 24, 12, 6, 3}; /* of the bands */

/* The widest fit, by whose square all is measured: a neighbourhood's dark corner must not be ruled by its lamp. */
static void begin_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    for (size_t i = row * work->width; i < (row + 1) * work->width; i++) {
        float bright = brightness_at(work->coarse, i);
        work->scale[i] = 1.0f / (bright * bright + work->least * work->least);
        work->kept[i] = 1.0f;
        if (work->error)
            work->error[i] = work->coarse[NOISE][i] * work->coarse[NOISE][i] * work->scale[i];
        for (int c = 0; c < REGRESSION_COLOURS; c++)
            work->sum[c][i] = work->coarse[c][i];
    }
}

/* A row of pixels, and the kind under way. */
struct row {
    const struct work *work;
    size_t first;
    float own;         /* its number */
    float broad_share; /* of those of another kind, what BROAD ones count for */
};

static struct row row_of(const struct work *work, uint64_t row)
{
    return (struct row){
        .work = work,
        .first = row * work->width,
        .own = (float)work->under_way,
        .broad_share = work->under_way == THIN ? BROAD_AMONG_THIN : 0.0f,
    };
}

/* What a pixel of that kind counts for in the means of the kind under way. */
static PS_INLINED float share_of(const struct row *row, float kind)
{
    return kind == row->own ? 1.0f : kind == (float)BROAD ? row->broad_share : 0.0f;
}

PS_EVERY_ISA static void measure(const struct row row)
{
    const struct work *work = row.work;
    const float *restrict kind = work->kind + row.first, *restrict scale = work->scale + row.first;
    const float *restrict fine[VALUES], *restrict coarse[VALUES];
    float *restrict signal = work->signal + row.first, *restrict noise = work->noise + row.first;
    for (int c = 0; c < VALUES; c++) {
        fine[c] = work->fine[c] + row.first;
        coarse[c] = work->coarse[c] + row.first;
    }
#pragma omp simd
    for (size_t i = 0; i < work->width; i++) {
        float weight = share_of(&row, kind[i]) * scale[i];
        float band = fine[0][i] + fine[1][i] + fine[2][i];
        band -= coarse[0][i] + coarse[1][i] + coarse[2][i];
        float chance = fine[NOISE][i] - coarse[NOISE][i];
        signal[i] = band * band * weight;
        noise[i] = chance * chance * weight;
    }
}

static void measure_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    measure(row_of(user, row));
}

PS_EVERY_ISA static void count(const struct row row)
{
    const float *restrict kind = row.work->kind + row.first;
    float *restrict near_by = row.work->near_by + row.first;
    float *restrict around = row.work->around + row.first;
#pragma omp simd
    for (size_t i = 0; i < row.work->width; i++)
        near_by[i] = around[i] = share_of(&row, kind[i]);
}

static void count_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    count(row_of(user, row));
}

/* Replaces values by their sums over a square around. */
static void sum_around(const struct work *work, int radius, float *plane)
{
    struct regression_box box = {work->width, work->height, (size_t)radius, plane, work->room};
    regression_box_sums(work->host, &box);
}

/* Sums over pixels that count for so much in all become means; where there are none, sums are 0. */
static PS_INLINED float mean_of(float sum, float count)
{
    return sum / (count > 0.0f ? count : 1.0f);
}

/* What is kept of a band of mean square S, of which N is noise: 1 - (c N / S)^2, with the limit c N. */
static PS_INLINED float keep_of(float signal, float limit)
{
    bool some = signal > limit;
    float share = (some ? limit : 1.0f) / (some ? signal : 1.0f);
    return 1.0f - share * share;
}

/* Of a band of mean square S of which N is noise, and of which the share k is kept: k^2 N + (1 - k)^2 (S - N), Stein's
 * estimate of the risk. Of what S exceeds N by, as much as half of the caution is taken for chance. */
static PS_INLINED float risk_of_band(float signal, float noise, float caution, float keep)
{
    float lost = ps_max(signal - 0.5f * caution * noise, 0.0f);
    return keep * keep * noise + (1.0f - keep) * (1.0f - keep) * lost;
}

/* Of the kind's pixels, what is kept and the risk of that, in place of S and N; of others 0. */
PS_EVERY_ISA static void judge(const struct row row)
{
    const struct work *work = row.work;
    const float *restrict kind = work->kind + row.first;
    const float *restrict near_by = work->near_by + row.first;
    const float *restrict around = work->around + row.first;
    float *restrict kept = work->kept + row.first;
    float *restrict signal = work->signal + row.first, *restrict noise = work->noise + row.first;
    float least = work->caution, own = row.own;
#pragma omp simd
    for (size_t i = 0; i < work->width; i++) {
        float squares = mean_of(signal[i], near_by[i]), chance = mean_of(noise[i], around[i]);
        float caution = ALONE + (least - ALONE) * kept[i];
        float keep = keep_of(squares, caution * chance);
        float risk = risk_of_band(squares, chance, caution, keep);
        bool is_own = kind[i] == own;
        kept[i] = is_own ? keep : kept[i];
        signal[i] = is_own ? keep : 0.0f;
        noise[i] = is_own ? risk : 0.0f;
    }
}

PS_EVERY_ISA static void add(const struct row row)
{
    const struct work *work = row.work;
    const float *restrict keep = work->signal + row.first, *restrict risk = work->noise + row.first;
    for (int c = 0; c < REGRESSION_COLOURS; c++) {
        const float *restrict fine = work->fine[c] + row.first;
        const float *restrict coarse = work->coarse[c] + row.first;
        float *restrict sum = work->sum[c] + row.first;
#pragma omp simd
        for (size_t i = 0; i < work->width; i++)
            sum[i] += keep[i] * (fine[i] - coarse[i]);
    }
    if (!work->error)
        return;
    float *restrict error = work->error + row.first;
#pragma omp simd
    for (size_t i = 0; i < work->width; i++)
        error[i] += risk[i];
}

static void add_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    judge(row_of(user, row));
    add(row_of(user, row));
}

/* Adds the difference of `fine` and `coarse` of the first `count` images, to the pixels of one kind. One picture of the
 * noise may have less of it than there is: of that, more pixels are asked. */
static void add_band_of_kind(struct works *works, int count, int radius, enum pixel_kind kind)
{
    struct work *first = &works->of[0];
    for (int i = 0; i < count; i++)
        works->of[i].under_way = kind;
    first->host->parallel_for(first->host, first->height, count_row, first);
    sum_around(first, radius, first->near_by);
    sum_around(first, 2 * radius, first->around);
    for (int i = 0; i < count; i++) {
        struct work *work = &works->of[i];
        work->host->parallel_for(work->host, work->height, measure_row, work);
        sum_around(work, radius, work->signal);
        sum_around(work, 2 * radius, work->noise);
        work->host->parallel_for(work->host, work->height, add_row, work);
    }
}

static void add_band(struct works *works, int count, int radius)
{
    for (int kind = NO_KIND + 1; kind < KINDS; kind++)
        if (works->has[kind])
            add_band_of_kind(works, count, radius, (enum pixel_kind)kind);
}

static void copy_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    for (size_t x = 0; x < work->width; x++)
        for (int c = 0; c < VALUES; c++)
            work->fine[c][row * work->width + x] =
                work->body[c][regression_at(&work->guides, (int)x, (int)row)];
}

static void swap_fits(struct work *work)
{
    for (int c = 0; c < VALUES; c++) {
        float *plane = work->fine[c];
        work->fine[c] = work->coarse[c];
        work->coarse[c] = plane;
    }
}

/* Pixels are measured by the light that narrow fits found there: the dark side of an edge by its own, of which an error there may be
 * a multiple, and only as far as it is dark by that of its neighbourhood. */
static void rescale_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    for (size_t i = row * work->width; i < (row + 1) * work->width; i++) {
        float bright = ps_max(brightness_at(work->coarse, i), 0.0f), before = work->scale[i];
        work->scale[i] = 1.0f / (bright * bright + AROUND * AROUND / before);
        if (work->error)
            work->error[i] *= work->scale[i] / before;
    }
}

/* The pixels themselves, of images whose noise is known. */
static void add_pixels(struct works *works)
{
    for (int i = 0; i < works->halved; i++) {
        struct work *work = &works->of[i];
        work->host->parallel_for(work->host, work->height, copy_row, work);
        work->host->parallel_for(work->host, work->height, rescale_row, work);
        work->caution = PIXELS_CAUTION;
    }
    if (works->halved > 0)
        add_band(works, works->halved, PIXELS_WINDOW);
}

void regression_add_bands(struct works *works)
{
    regression_fit_all(works, bandwidths[0], body_of, coarse_of);
    regression_for_each_row(works, begin_row);
    for (size_t k = 1; k < sizeof bandwidths / sizeof bandwidths[0]; k++) {
        regression_fit_steered(works, bandwidths[k], body_of, fine_of);
        for (int i = 0; i < works->count; i++)
            works->of[i].caution = k > 1 && i >= works->halved ? GUESSED_CAUTION : CAUTION;
        add_band(works, works->count, bandwidths[k]);
        for (int i = 0; i < works->count; i++)
            swap_fits(&works->of[i]);
    }
    add_pixels(works);
}
