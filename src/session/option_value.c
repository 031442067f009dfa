#include "session/option_value.h"

#include "base/text.h"
#include "plugin/kind.h"
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define MOST_PIXELS 65536

ps_result option_whole_number(const char *option, const char *text, double minimum, double maximum,
                              double *value, struct error *error)
{
    if (text_to_number(text, value) && *value >= minimum && *value <= maximum &&
        floor(*value) == *value)
        return PS_OK;
    return error_set(error, PS_ERROR_INVALID,
                     "--%s: expected a whole number %.0f..%.0f, got '%.500s'", option, minimum,
                     maximum, text);
}

ps_result option_bytes(const char *option, const char *text, double *bytes, struct error *error)
{
    static const char units[] = "KMGT";
    size_t length = strlen(text);
    const char *unit = length > 1 ? strchr(units, text[length - 1]) : NULL;
    length -= unit != NULL;
    if (text_part_to_number(text, length, bytes) && *bytes > 0.0) {
        *bytes *= pow(1024.0, unit ? (double)(unit - units + 1) : 0.0);
        return PS_OK;
    }
    return error_set(error, PS_ERROR_INVALID,
                     "--%s: expected a size such as 500M or 8G, got '%.500s'", option, text);
}

ps_result option_time(const char *option, const char *text, double *seconds, struct error *error)
{
    static const struct {
        char letter;
        double seconds;
    } units[] = {{'s', 1}, {'m', 60}, {'h', 3600}, {'d', 86400}};
    size_t length = strlen(text);
    double unit = 1.0, number;
    for (size_t i = 0; i < sizeof units / sizeof units[0] && length > 1; i++)
        if (text[length - 1] == units[i].letter) {
            unit = units[i].seconds;
            length--;
            break;
        }
    if (!text_part_to_number(text, length, &number) || !(number > 0.0))
        return error_set(error, PS_ERROR_INVALID,
                         "--%s: expected a time such as 90s, 10m or 2h, got '%.500s'", option,
                         text);
    *seconds = number * unit;
    return PS_OK;
}

ps_result option_percent(const char *option, const char *text, double *share, struct error *error)
{
    size_t length = strlen(text);
    double percent;
    length -= length > 1 && text[length - 1] == '%';
    if (!text_part_to_number(text, length, &percent) || !(percent > 0.0 && percent <= 100.0))
        return error_set(error, PS_ERROR_INVALID,
                         "--%s: expected percent such as 2%%, got '%.500s'", option, text);
    *share = 0.01 * percent;
    return PS_OK;
}

ps_result option_exposure(const char *text, double *stops, struct error *error)
{
    if (text_to_number(text, stops) && *stops >= -20 && *stops <= 20)
        return PS_OK;
    return error_set(error, PS_ERROR_INVALID, "--exposure: expected a number -20..20, got '%.500s'",
                     text);
}

static bool is_side(double pixels)
{
    return pixels >= 1 && pixels <= MOST_PIXELS && pixels == floor(pixels);
}

ps_result option_size(const char *text, int64_t *width, int64_t *height, struct error *error)
{
    size_t length = strcspn(text, "x");
    double w, h;
    if (!text[length] || !text_part_to_number(text, length, &w) ||
        !text_to_number(text + length + 1, &h) || !is_side(w) || !is_side(h))
        return error_set(error, PS_ERROR_INVALID, "--size: expected WxH, each 1..%d, got '%.500s'",
                         MOST_PIXELS, text);
    *width = (int64_t)w;
    *height = (int64_t)h;
    return PS_OK;
}

ps_result option_rectangle(const char *option, const char *text, struct rectangle *rectangle,
                           struct error *error)
{
    size_t *const fields[4] = {&rectangle->x, &rectangle->y, &rectangle->width, &rectangle->height};
    char word[32];
    size_t i = 0;
    for (const char *next = text; i < 4; i++) {
        size_t length = strcspn(next, ",");
        double number;
        snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word),
                 next);
        if (next[length] != (i < 3 ? ',' : '\0') || !text_to_number(word, &number) ||
            number != floor(number) || number < 0.0 || number > 1e9)
            break;
        *fields[i] = (size_t)number;
        next += length + 1;
    }
    return i == 4 ? PS_OK
                  : error_set(error, PS_ERROR_INVALID,
                              "--%s: expected X,Y,W,H in whole pixels, got '%.500s'", option, text);
}

ps_result option_plugin(const char *text, ps_kind *kind, struct strategy_choice *choice,
                        struct error *error)
{
    struct error reason;
    const char *wanted;
    *kind = kind_parse(text, &wanted);
    if (*kind == PS_KINDS || !wanted)
        return error_set(error, PS_ERROR_INVALID,
                         "--plugin: expected KIND=NAME[:KEY=VALUE,...], got '%.200s'; 'psplat "
                         "plugins' lists the kinds",
                         text);
    ps_result result = settings_parse_choice(wanted, choice, &reason);
    return result == PS_OK
               ? PS_OK
               : error_set(error, result, "--plugin %s: %.4000s", kinds[*kind].name, reason.text);
}

ps_result option_assignment(const char *option, const char *text, struct error *error)
{
    const char *equals = strchr(text, '=');
    if (equals && equals > text)
        return PS_OK;
    return error_set(error, PS_ERROR_INVALID, "--%s: expected NAME=VALUE, got '%.500s'", option,
                     text);
}
