#include "render_job/first_pictures.h"

#include "base/clock.h"
#include "image/enlarge.h"
#include "pipeline/planes.h"
#include <math.h>

#define FIRST_PIXELS 2500.0 /* of the first picture */
#define FINEST_STEP 4.0     /* where the pixels of all pictures are a twelfth of those of a pass */

/* Of the sides of its pixels: a picture is made where they are so much smaller than before. */
#define WORTHWHILE 0.8

/* A first pass may take longer than first pictures tell, which matters where there is none that
 * takes less. */
#define MARGIN 1.15

/* A pass of draft quality takes this share of its time for what no quality changes. */
#define FIXED_SHARE 0.75

/* The picture, or the part of it, that is rendered. */
static struct rectangle window_of(const struct first_pictures *first)
{
    return planes_window(first->settings, first->scene->width, first->scene->height);
}

static double pixels_at(const struct first_pictures *first, double step)
{
    struct rectangle window = window_of(first);
    return ceil((double)window.width / step) * ceil((double)window.height / step);
}

double first_pictures_pixels(const struct first_pictures *first)
{
    return pixels_at(first, 1);
}

/* Seconds that a pixel adds. The first picture's time holds what no other has to do again. */
static double seconds_of_pixel(const struct first_pictures *first)
{
    const struct first_picture_time *before = &first->times[0], *last = &first->times[1];
    double mean = last->seconds / last->pixels, slope = mean;
    if (before->pixels > 0.0)
        slope = (last->seconds - before->seconds) / (last->pixels - before->pixels);
    return fmin(fmax(slope, 0.25 * mean), mean);
}

static double seconds_for(const struct first_pictures *first, double pixels)
{
    const struct first_picture_time *last = &first->times[1];
    return last->seconds + seconds_of_pixel(first) * (pixels - last->pixels);
}

double first_pictures_draft_seconds(const struct first_pictures *first)
{
    return first->step > 0.0 ? seconds_for(first, pixels_at(first, 1)) : 0.0;
}

double first_pictures_resolve_seconds(const struct first_pictures *first)
{
    const struct first_picture_time *last = &first->times[1];
    return first->step > 0.0 ? last->resolving / last->pixels * pixels_at(first, 1) : 0.0;
}

static bool make(struct first_pictures *first, double step)
{
    const struct render_callbacks callbacks = {
        .user = first->callbacks->user,
        .cancelled = first->callbacks->cancelled,
    };
    struct render_settings settings;
    struct statistics statistics;
    struct image image;
    struct error error;
    if (!first->make_settings(first->user, first->scene, QUALITY_DRAFT, &settings))
        return false;
    settings.trace = first->settings->trace;
    statistics_init(&statistics);
    double start = clock_seconds();
    ps_result result =
        render_coarse(first->scene, &settings, step, &callbacks, &statistics, &image, &error);
    if (result == PS_OK) {
        double seconds = clock_seconds() - start;
        double resolving = statistics_seconds(&statistics, "resolve");
        image_release(&first->image);
        first->image = image;
        first->step = step;
        first->times[0] = first->times[1];
        first->times[1] = (struct first_picture_time){pixels_at(first, step), seconds, resolving};
        if (first->are_wanted)
            first->show(first->user, first);
    } else {
        image_release(&image);
    }
    statistics_destroy(&statistics);
    settings_release(&settings);
    return result == PS_OK;
}

ps_result first_pictures_enlarge(const struct first_pictures *first,
                                 bool (*keeps)(const char *channel), struct image *large,
                                 struct error *error)
{
    struct rectangle window = window_of(first);
    const struct enlargement to = {first->step, window.width, window.height};
    ps_result result =
        image_enlarge(&first->image, to, keeps, first->settings->workers, large, error);
    large->window =
        (struct picture_window){window.x, window.y, first->scene->width, first->scene->height};
    return result;
}

/* Two tell the time, and others are made where they cost little beside a pass, and beside what is
 * left. */
static bool is_worth_making(const struct first_pictures *first, double step, unsigned made)
{
    if (made < 2)
        return true;
    double seconds = seconds_for(first, pixels_at(first, step));
    return first->are_wanted && step >= FINEST_STEP &&
           seconds <= 0.25 * first_pictures_draft_seconds(first) &&
           seconds <= 0.1 * (first->end - clock_seconds());
}

void first_pictures_make(struct first_pictures *first)
{
    double step = sqrt(pixels_at(first, 1) / FIRST_PIXELS);
    if (step < FINEST_STEP)
        return;
    for (unsigned made = 0; is_worth_making(first, step, made) && make(first, step); made++)
        step *= 0.5;
}

/* That a picture may have which is made within so many seconds. */
static double step_within(const struct first_pictures *first, double seconds)
{
    const struct first_picture_time *last = &first->times[1];
    double pixels = last->pixels + (seconds - last->seconds) / seconds_of_pixel(first);
    return sqrt(pixels_at(first, 1) / fmax(pixels, last->pixels));
}

/* The best quality, up to that which was asked for, of which a pass is done in so many seconds. */
static bool find_quality(const struct first_pictures *first, double seconds, enum quality *quality)
{
    double draft = first_pictures_draft_seconds(first);
    for (int tried = (int)first->quality; tried > QUALITY_DRAFT; tried--) {
        double effort = quality_effort((enum quality)tried) / quality_effort(QUALITY_DRAFT);
        *quality = (enum quality)tried;
        if (seconds >= draft * (FIXED_SHARE + (1.0 - FIXED_SHARE) * effort))
            return true;
    }
    *quality = QUALITY_DRAFT;
    return seconds >= MARGIN * draft;
}

/* Another picture tells the time better, and there may be enough of it after all. */
bool first_pictures_choose(struct first_pictures *first, enum quality *quality)
{
    first->are_wanted = false; /* the picture follows */
    for (;;) {
        double left = first->end - clock_seconds();
        bool found = find_quality(first, left, quality);
        double step = step_within(first, left);
        if (found || step > WORTHWHILE * first->step || !make(first, step))
            return found;
    }
}
