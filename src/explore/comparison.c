#include "explore/comparison.h"

#include "compare/flip.h"
#include "compare/metric.h"
#include "explore/json_text.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Metrics read, and pairs that they made themselves they may write to. */
static float *readable(const float *plane)
{
    union {
        const float *constant;
        float *variable;
    } pointer = {plane};
    return pointer.variable;
}

/* Borrows the pictures' planes; to be ended by picture_pair_release in any case. */
static ps_result pair_up(const struct shown_picture *test, const struct shown_picture *reference,
                         const char *name, struct picture_pair *pair, struct error *error)
{
    struct shown_layer layers[2];
    *pair = (struct picture_pair){
        .width = shown_picture_width(test),
        .height = shown_picture_height(test),
        .names = {"R", "G", "B"},
    };
    if (shown_picture_width(reference) != pair->width ||
        shown_picture_height(reference) != pair->height)
        return error_set(error, PS_ERROR_INVALID, "the pictures differ in size: %zux%zu, %zux%zu",
                         pair->width, pair->height, shown_picture_width(reference),
                         shown_picture_height(reference));
    if (!shown_picture_layer(test, name, &layers[0]) ||
        !shown_picture_layer(reference, name, &layers[1]) ||
        layers[0].channel_count != layers[1].channel_count)
        return error_set(error, PS_ERROR_INVALID, "the pictures have no layer '%.100s' in common",
                         name);
    pair->channel_count = layers[0].channel_count;
    for (size_t c = 0; c < pair->channel_count; c++) {
        pair->test[c] = readable(layers[0].planes[c]);
        pair->reference[c] = readable(layers[1].planes[c]);
    }
    return picture_pair_check_finite(pair, error);
}

static void write_number(struct json_writer *writer, const char *name, double value,
                         const char *unit)
{
    json_writer_open(writer, '{');
    json_writer_text_of(writer, "name", name);
    json_number_write_of(writer, "value", value);
    json_writer_text_of(writer, "unit", unit);
    json_writer_close(writer, '{');
}

static void write_metric(struct json_writer *writer, enum metric metric,
                         const struct picture_pair *pair)
{
    struct metric_value value = {.count = 1, .numbers = {NAN}};
    struct error error;
    const char *unit = metric == METRIC_PSNR ? "dB" : "";
    if (metric_evaluate(metric, pair, &value, &error) != PS_OK)
        value = (struct metric_value){.count = 1, .numbers = {NAN}};
    for (size_t i = 0; i < value.count; i++) {
        char name[40];
        snprintf(name, sizeof name, "%s%s%s", metric_name(metric), value.count > 1 ? " " : "",
                 value.count > 1 ? pair->names[i] : "");
        write_number(writer, name, value.numbers[i], unit);
    }
}

ps_result comparison_write(const struct shown_picture *test, const struct shown_picture *reference,
                           const char *layer, struct json_writer *writer, struct error *error)
{
    struct picture_pair pair;
    ps_result result = pair_up(test, reference, layer, &pair, error);
    if (result == PS_OK)
        result = workers_create(parallel_processor_count(), &pair.workers, error);
    json_writer_open(writer, '[');
    for (int metric = 0; metric < METRIC_COUNT && result == PS_OK; metric++)
        write_metric(writer, (enum metric)metric, &pair);
    json_writer_close(writer, '[');
    picture_pair_release(&pair);
    return result;
}

static void map_difference(const struct picture_pair *pair, float *map)
{
    for (size_t i = 0; i < pair->width * pair->height; i++) {
        map[i] = 0.0f;
        for (size_t c = 0; c < pair->channel_count; c++)
            map[i] = fmaxf(map[i], fabsf(pair->test[c][i] - pair->reference[c][i]));
    }
}

static ps_result fill_map(struct picture_pair *pair, const char *metric, float *map,
                          struct error *error)
{
    if (strcmp(metric, "difference") == 0) {
        map_difference(pair, map);
        return PS_OK;
    }
    if (strcmp(metric, "flip") != 0)
        return error_set(error, PS_ERROR_INVALID, "metric: expected flip or difference");
    ps_result result = workers_create(parallel_processor_count(), &pair->workers, error);
    return result == PS_OK ? flip_map(pair, map, error) : result;
}

ps_result comparison_map(const struct shown_picture *test, const struct shown_picture *reference,
                         const char *layer, const char *metric, float **map, struct error *error)
{
    struct picture_pair pair;
    *map = NULL;
    ps_result result = pair_up(test, reference, layer, &pair, error);
    size_t bytes = pair.width * pair.height * sizeof **map;
    if (result == PS_OK) {
        *map = malloc(bytes);
        result = *map ? fill_map(&pair, metric, *map, error) : error_memory(error, bytes, "a map");
    }
    picture_pair_release(&pair);
    if (result != PS_OK) {
        free(*map);
        *map = NULL;
    }
    return result;
}
