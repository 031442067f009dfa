#include "tools/option_parse.h"

#include "cli/command.h"
#include "session/option_value.h"

static bool print_unless_good(ps_result result, const struct error *error)
{
    if (result != PS_OK)
        print_error(error->text);
    return result == PS_OK;
}

bool parse_whole_number(const char *option, const char *text, double minimum, double maximum,
                        double *value)
{
    struct error error;
    return print_unless_good(option_whole_number(option, text, minimum, maximum, value, &error),
                             &error);
}

bool parse_rectangle(const char *option, const char *text, struct rectangle *rectangle)
{
    struct error error;
    return print_unless_good(option_rectangle(option, text, rectangle, &error), &error);
}

bool parse_exposure(const char *text, double *stops)
{
    struct error error;
    return print_unless_good(option_exposure(text, stops, &error), &error);
}
