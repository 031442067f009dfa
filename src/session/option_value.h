/* option_value.h: reads values of options. What is wrong is told in the words of the command line
 * ("--seed: expected ..."), and the result is PS_ERROR_INVALID then. */
#ifndef SESSION_OPTION_VALUE_H
#define SESSION_OPTION_VALUE_H

#include "base/error.h"
#include "base/rectangle.h"
#include "render/settings.h"

/* A whole decimal number in [minimum, maximum]. */
ps_result option_whole_number(const char *option, const char *text, double minimum, double maximum,
                              double *value, struct error *error);

/* "500M", "8G": bytes, in powers of 1024. */
ps_result option_bytes(const char *option, const char *text, double *bytes, struct error *error);

/* "90", "90s", "10m", "2h", "1d": seconds, above 0; and "2%" or "2" as a share, above 0. */
ps_result option_time(const char *option, const char *text, double *seconds, struct error *error);
ps_result option_percent(const char *option, const char *text, double *share, struct error *error);

/* Stops of exposure. */
ps_result option_exposure(const char *text, double *stops, struct error *error);

/* "X,Y,W,H" in whole pixels. */
ps_result option_rectangle(const char *option, const char *text, struct rectangle *rectangle,
                           struct error *error);

/* "WxH": pixels, each 1..65536. */
ps_result option_size(const char *text, int64_t *width, int64_t *height, struct error *error);

/* "KIND=NAME[:KEY=VALUE,...]": the kind, and a choice that the caller releases. */
ps_result option_plugin(const char *text, ps_kind *kind, struct strategy_choice *choice,
                        struct error *error);

/* Whether it is "NAME=VALUE", of which the name is not empty. */
ps_result option_assignment(const char *option, const char *text, struct error *error);

#endif
