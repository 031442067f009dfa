/* pull_push.h: fills holes of a depth map between the points that it was made of.
 *
 * Pull-push (Gortler et al. 1996, "The Lumigraph"; of depth maps Ritschel et al. 2008): levels of
 * half the size hold means of what is known, by which what is not known is filled from coarse to
 * fine. A hole is what looks far past a surface on all of its four sides.
 */
#ifndef PSPLAT_VISIBILITY_IMPERFECT_PULL_PUSH_H
#define PSPLAT_VISIBILITY_IMPERFECT_PULL_PUSH_H

#include <psplat/plugin.h>

/* A map of side x side texels, `texel` wide, in place. A level of pull-push doubles the width of
 * the holes that are found and filled; 0: none are. */
void imperfect_fill_holes(float *depths, uint32_t side, int64_t levels, float texel);

#endif
