#include "session/job_options.h"

#include "session/output.h"
#include "session/word_list.h"
#include <math.h>
#include <stdlib.h>

struct job_options job_options_init(void)
{
    return (struct job_options){.seconds = INFINITY, .write_every = INFINITY};
}

void job_options_release(struct job_options *options)
{
    free(options->checkpoint);
    *options = job_options_init();
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
    const char *needs_checkpoint = options->checkpoint             ? NULL
                                   : options->resume               ? "resume"
                                   : options->checkpoint_every > 0 ? "checkpoint-every"
                                                                   : NULL;
    if (needs_checkpoint)
        return error_set(error, PS_ERROR_INVALID,
                         "--%s needs --checkpoint FILE.exr, which names the film",
                         needs_checkpoint);
    return PS_OK;
}
