/* picture_pair.h: two pictures of one size, plane by plane: what metrics are functions of. */
#ifndef COMPARE_PICTURE_PAIR_H
#define COMPARE_PICTURE_PAIR_H

#include "base/parallel.h"
#include "base/rectangle.h"
#include "compare/layer.h"

/* Zero-initialise before reading; release whatever came of it. */
struct picture_pair {
    size_t width, height;
    size_t left, top; /* in the whole picture */
    size_t left_out;  /* pixels that do not count; they are 0 in both pictures */
    size_t channel_count;
    const char *names[3];          /* of the channels */
    float *reference[3], *test[3]; /* planes of width * height, linear */
    struct image images[2];        /* own what the pointers point to */
    struct workers *workers;       /* for metrics; owned, NULL: the caller alone */
};

/* Fails where a file can't be read, lacks the layer (NULL: R, G, B), or the sizes or places in
 * whole pictures differ; but of two windows of one picture that lie in each other, the larger is
 * cropped to the smaller. Starts a worker for each processor. */
ps_result picture_pair_read(struct picture_pair *pair, const char *reference_path,
                            const char *test_path, const char *layer, struct error *error);
void picture_pair_release(struct picture_pair *pair);

/* Leaves only a part of both pictures; fails where it reaches beyond them. */
ps_result picture_pair_crop(struct picture_pair *pair, struct rectangle crop, struct error *error);

/* Leaves out the pixels where a channel of the reference is `bound` or more, and the eight beside
 * each: a light in the picture, with its smooth edge, would otherwise dominate the error of all
 * that it lights. Fails where nothing is left. The pictures must be finite. */
ps_result picture_pair_leave_out(struct picture_pair *pair, double bound, struct error *error);

/* Fails where a picture holds NaN or infinities, and says how many and where the first is. */
ps_result picture_pair_check_finite(const struct picture_pair *pair, struct error *error);

/* Fails where the reference is zero everywhere; `what` is the ratio that it leaves undefined. */
ps_result picture_pair_check_reference(const struct picture_pair *pair, const char *what,
                                       struct error *error);

#endif
