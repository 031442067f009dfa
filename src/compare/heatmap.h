/* heatmap.h: where a picture differs from its reference, as a picture.
 *
 * The relative error of a pixel is |I-R| / (|R| + 0.01 rms R), lengths over the channels; the small
 * term keeps black pixels from showing as infinitely wrong. Its scale is logarithmic, since noise
 * of 1 % and fireflies of 100 % should both be seen: black is 0.1 % and less, purple 1 % (a third
 * of the way), orange 10 % (two thirds), pale yellow 100 % and more.
 */
#ifndef COMPARE_HEATMAP_H
#define COMPARE_HEATMAP_H

#include "compare/picture_pair.h"

/* A colour of the map, `position` in 0..1; its lightness rises evenly. */
void heatmap_colour(double position, uint8_t rgb[3]);

/* Fails where the reference is zero everywhere. */
ps_result heatmap_write(const struct picture_pair *pair, const char *path, struct error *error);

#endif
