/* project.h: which points of surfaces the camera sees, and where. */
#ifndef DEBUG_PROJECT_H
#define DEBUG_PROJECT_H

#include "render/state.h"

/* Whether a point, moved off its surface along `away`, is in the picture with nothing before it;
 * where, in pixels. Mirrors and glass hide what is behind them. A lens counts as a pinhole. */
bool project_visible(const struct render *render, ps_vec3 position, ps_vec3 away, float *x,
                     float *y);

#endif
