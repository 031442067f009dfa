#include "bands.h"

#include "box.h"

#include <psplat/math.h>

/* Times the noise that a band must exceed where the band before was kept; past the first one, where the noise is guessed of a
 * single pass: that has some of the light in it; and where nothing was kept. */
#define CAUTION 2.0f
#define GUESSED_CAUTION 1.2f
#define ALONE 4.0f
#define PIXELS_CAUTION 1.5f /* in place of CAUTION for the last band, of the pixels themselves */
#define PIXELS_WINDOW 4     /* R of the window of that band */
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

static bool is_in_class(const struct work *work, size_t pixel)
{
    return shows_gloss(work, pixel) == work->glossy;
}

static void measure_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    for (size_t i = row * work->width; i < (row + 1) * work->width; i++) {
        if (!is_in_class(work, i)) {
            work->signal[i] = work->noise[i] = 0.0f;
            continue;
        }
        float noise = work->fine[NOISE][i] - work->coarse[NOISE][i];
        float band = brightness_at(work->fine, i) - brightness_at(work->coarse, i);
        work->signal[i] = band * band * work->scale[i];
        work->noise[i] = noise * noise * work->scale[i];
    }
}

static void count_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    for (size_t x = 0; x < work->width; x++) {
        size_t i = row * work->width + x;
        bool shown = regression_shows_surface(&work->guides, (int)x, (int)row);
        work->near_by[i] = work->around[i] = shown && is_in_class(work, i) ? 1.0f : 0.0f;
    }
}

/* Replaces values by their sums over a square around. */
static void sum_around(const struct work *work, int radius, float *plane)
{
    struct regression_box box = {work->width, work->height, (size_t)radius, plane, work->room};
    regression_box_sums(work->host, &box);
}

/* Of a band of mean square S of which N is noise, and of which the share k is kept: k^2 N + (1 - k)^2 (S - N), Stein's
 * estimate of the risk. Of what S exceeds N by, as much as half of the caution is taken for chance. */
static float risk_of_band(float signal, float noise, float caution, float keep)
{
    float lost = ps_max(signal - 0.5f * caution * noise, 0.0f);
    return keep * keep * noise + (1.0f - keep) * (1.0f - keep) * lost;
}

static float one_over(float count)
{
    return count > 0.0f ? 1.0f / count : 0.0f;
}

static void add_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    for (size_t i = row * work->width; i < (row + 1) * work->width; i++) {
        if (!is_in_class(work, i))
            continue;
        float signal = work->signal[i] * one_over(work->near_by[i]);
        float noise = work->noise[i] * one_over(work->around[i]);
        float caution = ALONE + (work->caution - ALONE) * work->kept[i], limit = caution * noise;
        float share = signal > limit ? limit / signal : 1.0f, keep = 1.0f - share * share;
        work->kept[i] = keep;
        for (int c = 0; c < REGRESSION_COLOURS; c++)
            work->sum[c][i] += keep * (work->fine[c][i] - work->coarse[c][i]);
        if (work->error)
            work->error[i] += risk_of_band(signal, noise, caution, keep);
    }
}

/* Adds the difference of `fine` and `coarse` of the first `count` images, to the pixels of one class: what gloss mirrors
 * has noise of its own, which says nothing about the walls around. One picture of the noise may have less of it than there
 * is: of that, more pixels are asked. */
static void add_band_of_class(struct works *works, int count, int radius, bool glossy)
{
    struct work *first = &works->of[0];
    for (int i = 0; i < count; i++)
        works->of[i].glossy = glossy;
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
    add_band_of_class(works, count, radius, false);
    if (works->of[0].image->gloss)
        add_band_of_class(works, count, radius, true);
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
