/* reflected_light.h: what surfaces send to the camera of light straight from the lights. */
#ifndef TESTS_SUPPORT_REFLECTED_LIGHT_H
#define TESTS_SUPPORT_REFLECTED_LIGHT_H

#include "direct/direct.h"
#include "support/statistics_of.h"

/* Mean green radiance at the lower middle of a picture of 16x16 pixels, by lights that surfaces ask
 * and by rays that they scatter, over a few seeds. */
struct estimate reflected_light(const struct lighting *lighting);

#endif
