#include "session/remark.h"

#include <stdio.h>

bool remark_dark_pixels(const struct statistics *statistics, char text[REMARK_TEXT])
{
    double dark = statistics_counter(statistics, "pixels without weight");
    snprintf(text, REMARK_TEXT, "no indirect light reached %.0f pixel%s", dark,
             dark == 1.0 ? "" : "s");
    return dark > 0.0;
}
