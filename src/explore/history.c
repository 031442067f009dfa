#include "explore/history.h"

#include "compare/metric.h"
#include "explore/json_text.h"
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* Of a picture with more pixels, rows are left out. */
#define MOST_PIXELS ((size_t)1 << 19)

struct picture_sample {
    atomic_uint references;
    bool is_indirect;
    size_t width, height; /* of the picture */
    size_t rows;          /* that are kept */
    float *planes[3];     /* width * rows each; the first owns all */
};

/* --- samples
 * ----------------------------------------------------------------------------------------- */

static void copy_rows(struct picture_sample *sample, const struct shown_layer *layer, size_t step)
{
    size_t width = sample->width;
    for (size_t c = 0; c < 3; c++)
        for (size_t row = 0; row < sample->rows; row++)
            memcpy(sample->planes[c] + row * width, layer->planes[c] + row * step * width,
                   width * sizeof(float));
}

struct picture_sample *picture_sample_create(const struct shown_picture *shown)
{
    struct shown_layer layer;
    bool is_indirect = shown_picture_layer(shown, "indirect", &layer) && layer.channel_count == 3;
    if (!is_indirect &&
        !(shown_picture_layer(shown, "picture", &layer) && layer.channel_count == 3))
        return NULL;
    size_t width = shown_picture_width(shown), height = shown_picture_height(shown);
    size_t step = (width * height + MOST_PIXELS - 1) / MOST_PIXELS,
           rows = (height + step - 1) / step;
    struct picture_sample *sample = malloc(sizeof *sample);
    float *memory = malloc(3 * width * rows * sizeof *memory);
    if (!sample || !memory) {
        free(sample);
        free(memory);
        return NULL;
    }
    *sample = (struct picture_sample){
        .is_indirect = is_indirect, .width = width, .height = height, .rows = rows};
    atomic_init(&sample->references, 1);
    for (size_t c = 0; c < 3; c++)
        sample->planes[c] = memory + c * width * rows;
    copy_rows(sample, &layer, step);
    return sample;
}

struct picture_sample *picture_sample_keep(struct picture_sample *sample)
{
    if (sample)
        atomic_fetch_add(&sample->references, 1);
    return sample;
}

void picture_sample_release(struct picture_sample *sample)
{
    if (!sample || atomic_fetch_sub(&sample->references, 1) > 1)
        return;
    free(sample->planes[0]);
    free(sample);
}

double picture_sample_error(const struct picture_sample *test,
                            const struct picture_sample *reference)
{
    struct picture_pair pair = {
        .width = test->width, .height = test->rows, .channel_count = 3, .names = {"R", "G", "B"}};
    struct metric_value value;
    struct error error;
    if (test->is_indirect != reference->is_indirect || test->width != reference->width ||
        test->height != reference->height)
        return NAN;
    for (size_t c = 0; c < 3; c++) {
        pair.test[c] = test->planes[c];
        pair.reference[c] = reference->planes[c];
    }
    ps_result result = metric_evaluate(METRIC_REL_RMSE, &pair, &value, &error);
    return result == PS_OK ? value.numbers[0] : NAN;
}

/* --- histories
 * --------------------------------------------------------------------------------------- */

static bool is_power_of_two(uint32_t number)
{
    return (number & (number - 1)) == 0;
}

void history_add(struct history *history, uint32_t passes, double cpu_seconds,
                 struct picture_sample *sample)
{
    const struct history_point *last = &history->points[history->count - (history->count > 0)];
    bool replaces =
        history->count > 0 && (!is_power_of_two(last->passes) || history->count == HISTORY_POINTS);
    if (replaces)
        picture_sample_release(history->points[--history->count].sample);
    history->points[history->count++] = (struct history_point){
        .passes = passes, .cpu_seconds = cpu_seconds, .error = NAN, .sample = sample};
}

void history_clear(struct history *history)
{
    for (size_t i = 0; i < history->count; i++)
        picture_sample_release(history->points[i].sample);
    *history = (struct history){.count = 0};
}

struct history history_copy(const struct history *history)
{
    for (size_t i = 0; i < history->count; i++)
        picture_sample_keep(history->points[i].sample);
    return *history;
}

void history_measure(struct history *history, const struct picture_sample *reference, bool anew)
{
    for (size_t i = 0; i < history->count; i++) {
        struct history_point *point = &history->points[i];
        if (anew || isnan(point->error))
            point->error = picture_sample_error(point->sample, reference);
    }
}

void history_forget_errors(struct history *history)
{
    for (size_t i = 0; i < history->count; i++)
        history->points[i].error = NAN;
}

void history_take_errors(struct history *history, const struct history *measured)
{
    for (size_t i = 0; i < history->count; i++)
        for (size_t j = 0; j < measured->count; j++)
            if (history->points[i].sample == measured->points[j].sample)
                history->points[i].error = measured->points[j].error;
}

void history_write(const struct history *history, struct json_writer *writer)
{
    json_writer_open(writer, '[');
    for (size_t i = 0; i < history->count; i++) {
        const struct history_point *point = &history->points[i];
        if (!isfinite(point->error))
            continue;
        json_writer_open(writer, '{');
        json_writer_number_of(writer, "passes", point->passes);
        json_number_write_of(writer, "cpu_seconds", point->cpu_seconds);
        json_writer_number_of(writer, "error", point->error);
        json_writer_close(writer, '{');
    }
    json_writer_close(writer, '[');
}
