#include "base/decimal.h"

#include <float.h>
#include <stdint.h>

#define MOST_DIGITS 19 /* that a uint64_t holds, whatever they are */
#define EXACT_POWER 22 /* the largest of ten that a double holds */
#define MOST_EXPONENT 100000

static bool is_digit(const char *at, const char *end)
{
    return at < end && *at >= '0' && *at <= '9';
}

/* Whether it is "-"; moves behind it, or a "+". */
static bool read_sign(const char **at, const char *end)
{
    bool negative = *at < end && **at == '-';
    if (*at < end && (**at == '-' || **at == '+'))
        ++*at;
    return negative;
}

/* What of a number has been read: digits times a power of ten. */
struct digits {
    uint64_t mantissa;
    int kept; /* digits in the mantissa, without zeros at its start */
    int exponent;
    bool any;
};

/* Digits that the mantissa has no room for count as zeros. */
static const char *read_digits(const char *at, const char *end, struct digits *digits,
                               bool after_point)
{
    for (; is_digit(at, end); at++) {
        digits->any = true;
        if (digits->kept < MOST_DIGITS) {
            digits->mantissa = 10 * digits->mantissa + (uint64_t)(*at - '0');
            digits->kept += digits->mantissa > 0;
            digits->exponent -= after_point && digits->exponent > -MOST_EXPONENT;
        } else if (digits->exponent < MOST_EXPONENT) {
            digits->exponent += !after_point;
        }
    }
    return at;
}

/* An "e" without digits is not part of the number. */
static const char *read_exponent(const char *at, const char *end, int *exponent)
{
    const char *from = at + 1;
    bool negative = read_sign(&from, end);
    int value = 0;
    if (!is_digit(from, end))
        return at;
    for (; is_digit(from, end); from++)
        if (value < MOST_EXPONENT)
            value = 10 * value + (*from - '0');
    *exponent += negative ? -value : value;
    return from;
}

static double scale_by_power(double value, int exponent)
{
    static const double powers[EXACT_POWER + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                   1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                   1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    for (; exponent > EXACT_POWER && value > 0 && value <= DBL_MAX; exponent -= EXACT_POWER)
        value *= powers[EXACT_POWER];
    for (; exponent < -EXACT_POWER && value > 0; exponent += EXACT_POWER)
        value /= powers[EXACT_POWER];
    if (!(value > 0 && value <= DBL_MAX))
        return value;
    return exponent < 0 ? value / powers[-exponent] : value * powers[exponent];
}

bool decimal_read(const char **at, const char *end, double *value)
{
    struct digits digits = {0};
    const char *from = *at;
    bool negative = read_sign(&from, end);
    from = read_digits(from, end, &digits, false);
    if (from < end && *from == '.')
        from = read_digits(from + 1, end, &digits, true);
    if (!digits.any)
        return false;
    if (from < end && (*from == 'e' || *from == 'E'))
        from = read_exponent(from, end, &digits.exponent);
    *at = from;
    *value = scale_by_power((double)digits.mantissa, digits.exponent);
    *value = negative ? -*value : *value;
    return true;
}

bool decimal_read_integer(const char **at, const char *end, long long *value)
{
    const char *from = *at;
    bool negative = read_sign(&from, end);
    const char *first = from;
    for (*value = 0; is_digit(from, end) && from - first < 18; from++)
        *value = 10 * *value + (*from - '0');
    if (from == first || is_digit(from, end))
        return false;
    *at = from;
    *value = negative ? -*value : *value;
    return true;
}
