/* schedule.h: when a render of many passes stops, and when it is written on the way.
 *
 * Times are seconds of clock.h. A budget of time is kept by expecting the next pass to take as long
 * as the last one, and the last picture as long as the last one did; one pass is always made. A
 * budget of error is looked at when, at the rate of Monte Carlo (1 / sqrt(passes)), it may be met,
 * and no more often than that costs a fifth of the time, since looking means to denoise.
 */
#ifndef JOB_SCHEDULE_H
#define JOB_SCHEDULE_H

#include <stdbool.h>
#include <stdint.h>

struct schedule {
    double seconds;          /* that it may take; INFINITY: any */
    double error;            /* relative, that is good enough; 0: none is */
    double write_every;      /* a picture; INFINITY: at the end alone */
    double checkpoint_every; /* a film; likewise */
    /* Pictures to a viewer, each half a second, and no more often than a fifth of the time. */
    bool shows;
    bool checkpoints_are_cheap; /* and no more often than that costs a fiftieth of the time */
    double start;
    double pass_start, pass_seconds, picture_seconds, last_picture;
    double last_checkpoint, checkpoint_seconds;
    double last_show, show_seconds;
    uint32_t next_look; /* at the error: passes */
    double estimate;    /* of the error, when it was last looked at; negative: never */
};

/* Sets what is not a wish. */
void schedule_start(struct schedule *schedule, double now);

/* A pass begins, or has ended. */
void schedule_begin_pass(struct schedule *schedule, double now);
void schedule_end_pass(struct schedule *schedule, double now);

/* Whether there is time for another pass and its picture. */
bool schedule_has_time(const struct schedule *schedule, double now);

/* Whether a picture, or a film, is due on the way. The first picture is as soon as there is one. */
bool schedule_wants_picture(const struct schedule *schedule, double now);
bool schedule_wants_show(const struct schedule *schedule, double now);
bool schedule_wants_checkpoint(const struct schedule *schedule, double now);

/* Those were made, from `start` to `now`. */
void schedule_note_picture(struct schedule *schedule, double start, double now);
void schedule_note_show(struct schedule *schedule, double start, double now);
void schedule_note_checkpoint(struct schedule *schedule, double start, double now);

/* Whether the error ought to be looked at after so many passes; and what it is then, which took
 * some time to tell. */
bool schedule_wants_error(const struct schedule *schedule, uint32_t passes);
void schedule_note_error(struct schedule *schedule, uint32_t passes, double estimate,
                         double seconds);
bool schedule_is_good_enough(const struct schedule *schedule);

/* Share of the budgets that is used up, 0..1: the largest. */
double schedule_fraction(const struct schedule *schedule, double now);

#endif
