/* display_picture.h: a bloom or a tone map that is let loose on planes made by hand. */
#ifndef TESTS_SUPPORT_DISPLAY_PICTURE_H
#define TESTS_SUPPORT_DISPLAY_PICTURE_H

#include "plugin/strategy.h"

/* Runs a strategy such as "tonemap=filmic:shoulder=0.5", which must give `expected` and leave no
 * memory behind. Where that is PS_CANCELLED, the host was cancelled before. */
void run_display(const char *choice, uint32_t threads, const ps_display_view *picture,
                 ps_result expected);

#endif
