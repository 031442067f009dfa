/* job_options.h: when a render of many passes ends, what it keeps on the way, and which processes
 * share it. */
#ifndef SESSION_JOB_OPTIONS_H
#define SESSION_JOB_OPTIONS_H

#include "base/error.h"
#include <stdbool.h>

/* Made by job_options_init. */
struct job_options {
    double seconds;          /* passes until so much time is used up; INFINITY: any */
    double error;            /* passes until the error, relative, is no larger; 0: not asked for */
    double write_every;      /* seconds between pictures on the way; INFINITY: none */
    char *checkpoint;        /* the film's file, owned; NULL: none is kept */
    double checkpoint_every; /* seconds; 0: not given */
    bool resume, mpi;
};

struct job_options job_options_init(void);
void job_options_release(struct job_options *options);

/* PS_ERROR_INVALID where the name does not end in .exr. */
ps_result job_options_set_checkpoint(struct job_options *options, const char *path,
                                     struct error *error);

/* Whether passes go on until a budget is used up. */
bool job_options_have_budget(const struct job_options *options);

/* PS_ERROR_INVALID where they do not go together. */
ps_result job_options_check(const struct job_options *options, struct error *error);

#endif
