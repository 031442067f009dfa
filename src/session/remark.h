/* remark.h: what is said of a picture that was made. */
#ifndef SESSION_REMARK_H
#define SESSION_REMARK_H

#include "base/statistics.h"
#include <stdbool.h>

#define REMARK_TEXT 128

/* Pixels that look black, or ambient, for want of splats; false where there are none. */
bool remark_dark_pixels(const struct statistics *statistics, char text[REMARK_TEXT]);

#endif
