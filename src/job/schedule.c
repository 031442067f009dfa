#include "job/schedule.h"

#include <math.h>

#define SHARE_FOR_LOOKING 0.2
#define SHARE_FOR_CHECKPOINTS 0.02
#define SHARE_FOR_SHOWS 0.2
#define SHOW_EVERY 0.5

void schedule_start(struct schedule *schedule, double now)
{
    schedule->start = now;
    schedule->pass_start = schedule->last_checkpoint = now;
    schedule->last_picture = schedule->last_show = -INFINITY;
    schedule->pass_seconds = schedule->picture_seconds = schedule->checkpoint_seconds = 0.0;
    schedule->show_seconds = 0.0;
    schedule->next_look = 1;
    schedule->estimate = -1.0;
}

void schedule_begin_pass(struct schedule *schedule, double now)
{
    schedule->pass_start = now;
}

void schedule_end_pass(struct schedule *schedule, double now)
{
    schedule->pass_seconds = now - schedule->pass_start;
}

bool schedule_has_time(const struct schedule *schedule, double now)
{
    double needed = schedule->pass_seconds + schedule->picture_seconds;
    return now - schedule->start + needed <= schedule->seconds;
}

bool schedule_wants_picture(const struct schedule *schedule, double now)
{
    return schedule->write_every < INFINITY &&
           now - schedule->last_picture >= schedule->write_every;
}

bool schedule_wants_show(const struct schedule *schedule, double now)
{
    double every = fmax(SHOW_EVERY, schedule->show_seconds / SHARE_FOR_SHOWS);
    return schedule->shows && now - schedule->last_show >= every;
}

bool schedule_wants_checkpoint(const struct schedule *schedule, double now)
{
    double every = schedule->checkpoint_every;
    if (schedule->checkpoints_are_cheap)
        every = fmax(every, schedule->checkpoint_seconds / SHARE_FOR_CHECKPOINTS);
    return now - schedule->last_checkpoint >= every;
}

void schedule_note_picture(struct schedule *schedule, double start, double now)
{
    schedule->picture_seconds = now - start;
    schedule->last_picture = now;
}

void schedule_note_show(struct schedule *schedule, double start, double now)
{
    schedule->show_seconds = now - start;
    schedule->last_show = now;
}

void schedule_note_checkpoint(struct schedule *schedule, double start, double now)
{
    schedule->checkpoint_seconds = now - start;
    schedule->last_checkpoint = now;
}

bool schedule_wants_error(const struct schedule *schedule, uint32_t passes)
{
    return schedule->error > 0.0 && passes >= schedule->next_look;
}

/* The rate is a guess: at most twice the passes. */
void schedule_note_error(struct schedule *schedule, uint32_t passes, double estimate,
                         double seconds)
{
    double ratio = estimate < 0.0 ? 1.0 : estimate / schedule->error;
    double next = fmin((double)passes * ratio * ratio, 2.0 * passes);
    double cheap = schedule->pass_seconds > 0.0
                       ? ceil(seconds / (SHARE_FOR_LOOKING * schedule->pass_seconds))
                       : 1.0;
    next = fmax(next, passes + fmax(cheap, 1.0));
    schedule->next_look = (uint32_t)fmin(ceil(next), (double)UINT32_MAX);
    schedule->estimate = estimate;
}

bool schedule_is_good_enough(const struct schedule *schedule)
{
    return schedule->estimate >= 0.0 && schedule->estimate <= schedule->error;
}

double schedule_fraction(const struct schedule *schedule, double now)
{
    double of_time = (now - schedule->start) / schedule->seconds, of_error = 0.0;
    if (schedule->estimate > 0.0)
        of_error = schedule->error * schedule->error / (schedule->estimate * schedule->estimate);
    return fmin(fmax(of_time, of_error), 1.0);
}
