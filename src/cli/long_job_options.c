/* long_job_options.c: the command line of long jobs: times and percentages. */
#include "base/text.h"
#include "cli/long_job.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define CHECKPOINT_EVERY 60.0

/* "90", "90s", "1.5m", "2h", "1d". */
static bool parse_time(const char *option, const char *text, double *seconds)
{
    static const struct {
        char letter;
        double seconds;
    } units[] = {{'s', 1}, {'m', 60}, {'h', 3600}, {'d', 86400}};
    size_t length = strlen(text);
    double unit = 1.0;
    for (size_t i = 0; i < sizeof units / sizeof units[0] && length > 1; i++)
        if (text[length - 1] == units[i].letter) {
            unit = units[i].seconds;
            length--;
            break;
        }
    if (text_part_to_number(text, length, seconds) && *seconds > 0.0) {
        *seconds *= unit;
        return true;
    }
    fprintf(stderr, "psplat: error: --%s: expected a time such as 90s, 10m or 2h, got '%s'\n",
            option, text);
    return false;
}

static bool parse_percent(const char *text, double *share)
{
    size_t length = strlen(text);
    length -= length > 1 && text[length - 1] == '%';
    if (text_part_to_number(text, length, share) && *share > 0.0 && *share <= 100.0) {
        *share *= 0.01;
        return true;
    }
    fprintf(stderr, "psplat: error: --error: expected percent such as 2%%, got '%s'\n", text);
    return false;
}

static bool take_option(struct long_job *job, const struct argument *argument)
{
    const char *value = argument->value;
    if (argument_is(argument, "time"))
        return parse_time("time", value, &job->schedule.seconds);
    if (argument_is(argument, "error"))
        return parse_percent(value, &job->schedule.error);
    if (argument_is(argument, "write-every"))
        return parse_time("write-every", value, &job->schedule.write_every);
    if (argument_is(argument, "checkpoint-every"))
        return parse_time("checkpoint-every", value, &job->schedule.checkpoint_every);
    if (argument_is(argument, "checkpoint"))
        job->checkpoint = value;
    else if (argument_is(argument, "resume"))
        job->resume = true;
    else if (argument_is(argument, "mpi"))
        job->wants_mpi = true;
    return true; /* another's */
}

static bool goes_together(const struct long_job *job)
{
    const char *wrong = NULL;
    if (job->resume && !job->checkpoint)
        wrong = "--resume: which film? Name it with --checkpoint.";
    else if (job->schedule.checkpoint_every < INFINITY && !job->checkpoint)
        wrong = "--checkpoint-every: which film? Name it with --checkpoint.";
    else if (job->checkpoint && !output_holds_layers(job->checkpoint))
        wrong = "--checkpoint: a film needs a name that ends in .exr";
    if (wrong)
        print_error(wrong);
    return !wrong;
}

bool long_job_take(struct long_job *job, const struct argument *arguments, size_t count,
                   const struct pass_range *passes)
{
    *job = (struct long_job){
        .range = *passes,
        .schedule = {.seconds = INFINITY, .write_every = INFINITY, .checkpoint_every = INFINITY},
        .lock = {.descriptor = -1},
        .muted = -1,
    };
    for (size_t i = 0; i < count; i++)
        if (arguments[i].option && !take_option(job, &arguments[i]))
            return false;
    if (!goes_together(job))
        return false;
    if (job->checkpoint && !(job->schedule.checkpoint_every < INFINITY)) {
        job->schedule.checkpoint_every = CHECKPOINT_EVERY;
        job->schedule.checkpoints_are_cheap = true;
    }
    return true;
}
