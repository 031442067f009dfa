#include "session/job_options.h"

#include "base/text.h"
#include "session/output.h"
#include "session/word_list.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct job_options job_options_init(void)
{
    return (struct job_options){.seconds = INFINITY, .write_every = INFINITY};
}

void job_options_release(struct job_options *options)
{
    free(options->checkpoint);
    *options = job_options_init();
}

ps_result job_options_parse_time(const char *name, const char *value, double *seconds,
                                 struct error *error)
{
    static const struct {
        char letter;
        double seconds;
    } units[] = {{'s', 1}, {'m', 60}, {'h', 3600}, {'d', 86400}};
    size_t length = strlen(value);
    double unit = 1.0, number;
    for (size_t i = 0; i < sizeof units / sizeof units[0] && length > 1; i++)
        if (value[length - 1] == units[i].letter) {
            unit = units[i].seconds;
            length--;
            break;
        }
    if (!text_part_to_number(value, length, &number) || !(number > 0.0))
        return error_set(error, PS_ERROR_INVALID,
                         "--%s: expected a time such as 90s, 10m or 2h, got '%.500s'", name, value);
    *seconds = number * unit;
    return PS_OK;
}

ps_result job_options_parse_percent(const char *value, double *share, struct error *error)
{
    size_t length = strlen(value);
    double percent;
    length -= length > 1 && value[length - 1] == '%';
    if (!text_part_to_number(value, length, &percent) || !(percent > 0.0 && percent <= 100.0))
        return error_set(error, PS_ERROR_INVALID,
                         "--error: expected percent such as 2%%, got '%.500s'", value);
    *share = 0.01 * percent;
    return PS_OK;
}

ps_result job_options_set_checkpoint(struct job_options *options, const char *path,
                                     struct error *error)
{
    if (!output_holds_layers(path))
        return error_set(error, PS_ERROR_INVALID,
                         "--checkpoint: a film needs a name that ends in .exr");
    return word_replace(&options->checkpoint, path, error);
}

bool job_options_have_budget(const struct job_options *options)
{
    return options->seconds < INFINITY || options->error > 0.0;
}

ps_result job_options_check(const struct job_options *options, struct error *error)
{
    const char *lonely = options->checkpoint             ? NULL
                         : options->resume               ? "resume"
                         : options->checkpoint_every > 0 ? "checkpoint-every"
                                                         : NULL;
    if (lonely)
        return error_set(error, PS_ERROR_INVALID, "--%s: which film? Name it with --checkpoint.",
                         lonely);
    return PS_OK;
}
