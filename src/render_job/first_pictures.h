/* first_pictures.h: what a render shows before its first pass, and what of it there is time for.
 *
 * Pictures of few pixels, scaled up, each of four times as many as the one before: there is one to
 * look at within a second, whatever a pass takes. They are of draft quality, otherwise as the
 * render, and no part of its film. Their times tell what a pass will take, as a constant and a time
 * per pixel, and from that follows what a budget of time pays for: passes of the quality that was
 * asked for, or of the best for which one is done in time; or, where that is none, a picture of as
 * many pixels as there is time for, scaled up. One pass of more samples is better than several of
 * fewer.
 */
#ifndef RENDER_JOB_FIRST_PICTURES_H
#define RENDER_JOB_FIRST_PICTURES_H

#include "pipeline/render.h"
#include "settings/quality.h"

struct first_pictures {
    /* Of the caller, borrowed. */
    const struct scene *scene;
    const struct render_settings *settings; /* of the render, with the trace */
    const struct render_callbacks *callbacks;
    bool are_wanted;      /* all of them, to look at; else only as many as tell the time */
    enum quality quality; /* that was asked for */
    /* When there is to be nothing left but to write the picture, clock.h; INFINITY: whenever. */
    double end;
    /* Settings of another quality, to be used once. False where there are none. */
    bool (*make_settings)(void *user, const struct scene *scene, enum quality quality,
                          struct render_settings *settings);
    /* Told that there is another one, where they are wanted. */
    void (*show)(void *user, const struct first_pictures *first);
    void *user;
    /* What was made. */
    struct image image; /* the last of them, not scaled up; released by the caller */
    double step;        /* the sides of its pixels; 0: there is none */
    struct first_picture_time {
        double pixels, seconds, resolving; /* seconds after the passes, of `seconds` */
    } times[2];                            /* of the last two */
};

/* The last of them in the size that was asked for; its channels that `keeps` is true of. */
ps_result first_pictures_enlarge(const struct first_pictures *first,
                                 bool (*keeps)(const char *channel), struct image *large,
                                 struct error *error);

/* Makes them: none where the picture has few pixels itself, and no other where one fails or is
 * cancelled, of which the render will tell. */
void first_pictures_make(struct first_pictures *first);

/* The quality of passes that what is left of the budget pays for. False, and the last picture is
 * made of as many pixels as it does, where that is no pass. There must be a picture before. */
bool first_pictures_choose(struct first_pictures *first, enum quality *quality);

/* Of the picture that was asked for. */
double first_pictures_pixels(const struct first_pictures *first);

/* About how long a pass of draft quality takes, with the picture of it; and how long of that the
 * picture does. Seconds; 0 where there is no picture. */
double first_pictures_draft_seconds(const struct first_pictures *first);
double first_pictures_resolve_seconds(const struct first_pictures *first);

#endif
