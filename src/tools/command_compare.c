/* command_compare.c: psplat compare: how far is a picture from its reference? */
#include "base/text.h"
#include "cli/command.h"
#include "compare/heatmap.h"
#include "compare/metric.h"
#include "tools/option_parse.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OPTION_LAYER, OPTION_CROP, OPTION_BELOW, OPTION_METRIC, OPTION_FAIL, OPTION_HEATMAP };

static const struct option options[] = {
    [OPTION_LAYER] = {'l', "layer", "NAME", "compare NAME.R, NAME.G, NAME.B, or the channel NAME"},
    [OPTION_CROP] = {0, "crop", "X,Y,W,H", "compare this part only; 0,0 is the upper left corner"},
    [OPTION_BELOW] = {0, "below", "NUMBER",
                      "leave out pixels that reach it in the reference, and those beside them"},
    [OPTION_METRIC] = {'m', "metric", "NAME", "print this metric; may be repeated; default: all"},
    [OPTION_FAIL] = {0, "fail", "'METRIC>NUMBER'",
                     "exit with status 1 if so; also <, >=, <=; may be repeated"},
    [OPTION_HEATMAP] = {0, "heatmap", "FILE.png",
                        "draw the relative error: black 0.1 %, purple 1, orange 10, yellow 100"},
};

struct request {
    const char *paths[2]; /* the reference, and what is tested against it */
    size_t path_count;
    const char *layer, *heatmap;
    bool cropped;
    struct rectangle crop;
    bool bounded;
    double bound;                          /* of the reference, above which pixels do not count */
    bool any_chosen, chosen[METRIC_COUNT]; /* what is printed */
    struct metric_limit *limits;           /* owned */
    size_t limit_count;
};

static bool parse_option(const struct argument *argument, struct request *request)
{
    struct error error;
    enum metric metric;
    ps_result result = PS_OK;
    switch (argument->option - options) {
    case OPTION_LAYER:
        request->layer = argument->value;
        break;
    case OPTION_CROP:
        request->cropped = true;
        return parse_rectangle(argument->option->name, argument->value, &request->crop);
    case OPTION_BELOW:
        request->bounded = text_to_number(argument->value, &request->bound);
        if (!request->bounded)
            result =
                error_set(&error, PS_ERROR_INVALID, "expected a number, got '%s'", argument->value);
        break;
    case OPTION_METRIC:
        result = metric_find(argument->value, strlen(argument->value), &metric, &error);
        if (result == PS_OK)
            request->any_chosen = request->chosen[metric] = true;
        break;
    case OPTION_FAIL:
        result =
            metric_limit_parse(argument->value, &request->limits[request->limit_count++], &error);
        break;
    case OPTION_HEATMAP:
        request->heatmap = argument->value;
        break;
    }
    if (result != PS_OK)
        fprintf(stderr, "psplat: error: --%s: %s\n", argument->option->name, error.text);
    return result == PS_OK;
}

static bool parse_arguments(const struct argument *arguments, size_t count, struct request *request)
{
    for (size_t i = 0; i < count; i++) {
        if (arguments[i].option) {
            if (!parse_option(&arguments[i], request))
                return false;
        } else if (request->path_count++ < 2) {
            request->paths[request->path_count - 1] = arguments[i].value;
        }
    }
    if (request->path_count != 2)
        print_error("compare: expected two pictures, the reference and the one to test. "
                    "Try 'psplat compare --help'.");
    return request->path_count == 2;
}

static void print_value(FILE *stream, enum metric metric, const struct metric_value *value)
{
    fprintf(stream, "%s", metric_name(metric));
    for (size_t i = 0; i < value->count; i++) {
        if (isnan(value->numbers[i])) /* whose sign printf would show */
            fprintf(stream, " nan");
        else
            fprintf(stream, " %.7g", value->numbers[i]);
    }
}

/* What is printed, and what is limited. */
static bool is_needed(const struct request *request, enum metric metric)
{
    bool needed = !request->any_chosen || request->chosen[metric];
    for (size_t i = 0; i < request->limit_count; i++)
        needed = needed || request->limits[i].metric == metric;
    return needed;
}

static int check_limits(const struct request *request, const struct metric_value *values)
{
    int status = STATUS_OK;
    for (size_t i = 0; i < request->limit_count; i++) {
        const struct metric_limit *limit = &request->limits[i];
        if (!metric_limit_refuses(limit, &values[limit->metric]))
            continue;
        status = STATUS_FAILED;
        fprintf(stderr, "psplat: failed: %s%s%s%.7g: ", metric_name(limit->metric),
                limit->above ? ">" : "<", limit->inclusive ? "=" : "", limit->bound);
        print_value(stderr, limit->metric, &values[limit->metric]);
        fprintf(stderr, "\n");
    }
    return status;
}

static int compare(const struct request *request, struct picture_pair *pair)
{
    struct metric_value values[METRIC_COUNT];
    struct error error;
    ps_result result = picture_pair_check_finite(pair, &error);
    if (result == PS_OK && request->bounded)
        result = picture_pair_leave_out(pair, request->bound, &error);
    for (enum metric i = 0; i < METRIC_COUNT && result == PS_OK; i++)
        if (is_needed(request, i))
            result = metric_evaluate(i, pair, &values[i], &error);
    if (result == PS_OK && request->heatmap)
        result = heatmap_write(pair, request->heatmap, &error);
    if (result != PS_OK) {
        print_error(error.text);
        return STATUS_FAILED;
    }
    for (enum metric i = 0; i < METRIC_COUNT; i++)
        if (!request->any_chosen || request->chosen[i]) {
            print_value(stdout, i, &values[i]);
            printf("\n");
        }
    return check_limits(request, values);
}

static int read_and_compare(const struct request *request)
{
    struct picture_pair pair = {0};
    struct error error;
    int status = STATUS_OK;
    if (picture_pair_read(&pair, request->paths[0], request->paths[1], request->layer, &error) !=
        PS_OK)
        status = STATUS_FAILED;
    else if (request->cropped && picture_pair_crop(&pair, request->crop, &error) != PS_OK)
        status = STATUS_USAGE;
    if (status == STATUS_OK)
        status = compare(request, &pair);
    else
        print_error(error.text);
    picture_pair_release(&pair);
    return status;
}

static int run(const struct argument *arguments, size_t count)
{
    struct request request = {.limits = calloc(count + 1, sizeof *request.limits)};
    int status = STATUS_USAGE;
    if (!request.limits) {
        print_error("out of memory");
        return STATUS_FAILED;
    }
    if (parse_arguments(arguments, count, &request))
        status = read_and_compare(&request);
    free(request.limits);
    return status;
}

const struct command command_compare = {
    .name = "compare",
    .operands = "REFERENCE.exr TEST.exr",
    .summary = "measures how far a picture is from its reference",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
