/* metric.c: the metrics by name, and bounds on them. */
#include "compare/metric.h"

#include "base/suggestion.h"
#include "base/text.h"
#include "compare/flip.h"
#include "compare/pixel_metrics.h"
#include "compare/ssim.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const struct {
    const char *name;
    ps_result (*evaluate)(const struct picture_pair *pair, double *numbers, struct error *error);
} metrics[METRIC_COUNT] = {
    [METRIC_THESIS_RMSE] = {"thesis_rmse", pixel_thesis_rmse},
    [METRIC_REL_RMSE] = {"rel_rmse", pixel_rel_rmse},
    [METRIC_RELMSE] = {"relmse", pixel_relmse},
    [METRIC_BIAS] = {"bias", pixel_bias},
    [METRIC_PSNR] = {"psnr", pixel_psnr},
    [METRIC_SSIM] = {"ssim", ssim_mean},
    [METRIC_MAX] = {"max", pixel_max},
    [METRIC_P99] = {"p99", pixel_p99},
    [METRIC_FLIP] = {"flip", flip_mean},
};

const char *metric_name(enum metric metric)
{
    return metrics[metric].name;
}

static void list_names(char *text, size_t size)
{
    size_t used = 0;
    for (int i = 0; i < METRIC_COUNT && used < size; i++)
        used +=
            (size_t)snprintf(text + used, size - used, "%s%s", i > 0 ? ", " : "", metrics[i].name);
}

ps_result metric_find(const char *name, size_t length, enum metric *metric, struct error *error)
{
    char word[32], list[128];
    snprintf(word, sizeof word, "%.*s", length < sizeof word ? (int)length : (int)sizeof word,
             name);
    for (int i = 0; i < METRIC_COUNT; i++)
        if (strcmp(word, metrics[i].name) == 0) {
            *metric = (enum metric)i;
            return PS_OK;
        }
    struct suggestion suggestion = suggestion_start(word);
    char hint[SUGGESTION_TEXT];
    for (int i = 0; i < METRIC_COUNT; i++)
        suggestion_consider(&suggestion, metrics[i].name);
    suggestion_text(&suggestion, hint);
    if (suggestion.best)
        return error_set(error, PS_ERROR_INVALID, "unknown metric '%s'%s", word, hint);
    list_names(list, sizeof list);
    return error_set(error, PS_ERROR_INVALID, "unknown metric '%s'; there are: %s", word, list);
}

ps_result metric_evaluate(enum metric metric, const struct picture_pair *pair,
                          struct metric_value *value, struct error *error)
{
    value->count = metric == METRIC_BIAS ? pair->channel_count : 1;
    return metrics[metric].evaluate(pair, value->numbers, error);
}

ps_result metric_limit_parse(const char *text, struct metric_limit *limit, struct error *error)
{
    size_t length = strcspn(text, "<>");
    if (length == 0 || text[length] == '\0')
        return error_set(error, PS_ERROR_INVALID, "expected METRIC>NUMBER (or <, >=, <=), got '%s'",
                         text);
    limit->above = text[length] == '>';
    limit->inclusive = text[length + 1] == '=';
    const char *number = text + length + (limit->inclusive ? 2 : 1);
    if (!text_to_number(number, &limit->bound))
        return error_set(error, PS_ERROR_INVALID, "expected a number behind '%.*s', got '%s'",
                         (int)(number - text), text, number);
    return metric_find(text, length, &limit->metric, error);
}

bool metric_limit_refuses(const struct metric_limit *limit, const struct metric_value *value)
{
    for (size_t i = 0; i < value->count; i++) {
        double number = value->numbers[i];
        if (isnan(number) || (limit->inclusive && number == limit->bound) ||
            (limit->above ? number > limit->bound : number < limit->bound))
            return true;
    }
    return false;
}
