#include "base/text.h"

#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST_NUMBER 64
#define LONGEST_WORD 64

static const char *skip_digits(const char *p)
{
    while (*p >= '0' && *p <= '9')
        p++;
    return p;
}

/* Whether the text is sign, digits with at most one point, exponent: and nothing else. */
static bool is_decimal(const char *text)
{
    const char *p = text;
    if (*p == '+' || *p == '-')
        p++;
    const char *whole = p;
    p = skip_digits(p);
    size_t digits = (size_t)(p - whole);
    if (*p == '.') {
        const char *fraction = ++p;
        p = skip_digits(p);
        digits += (size_t)(p - fraction);
    }
    if (digits == 0)
        return false;
    if (*p == 'e' || *p == 'E') {
        p++;
        if (*p == '+' || *p == '-')
            p++;
        const char *exponent = p;
        p = skip_digits(p);
        if (p == exponent)
            return false;
    }
    return *p == '\0';
}

bool text_to_number(const char *text, double *value)
{
    if (!is_decimal(text))
        return false;
    /* strtod wants the locale's decimal point; give it that one, which is one or more bytes. */
    char local[LONGEST_NUMBER + 16];
    size_t length = strlen(text);
    if (length > LONGEST_NUMBER)
        return false;
    const char *point = strchr(text, '.');
    const char *local_point = localeconv()->decimal_point;
    if (point && strlen(local_point) < 16)
        snprintf(local, sizeof local, "%.*s%s%s", (int)(point - text), text, local_point,
                 point + 1);
    else
        memcpy(local, text, length + 1);
    *value = strtod(local, NULL);
    return isfinite(*value);
}

bool text_part_to_number(const char *text, size_t length, double *value)
{
    char part[64];
    if (length >= sizeof part)
        return false;
    memcpy(part, text, length);
    part[length] = '\0';
    return text_to_number(part, value);
}

void text_delocalize(char *text)
{
    const char *local_point = localeconv()->decimal_point;
    char *found = strcmp(local_point, ".") ? strstr(text, local_point) : NULL;
    if (found) {
        size_t width = strlen(local_point);
        *found = '.';
        memmove(found + 1, found + width, strlen(found + width) + 1);
    }
}

void text_from_number(double value, char *text, size_t size)
{
    for (int precision = 7; precision <= 17; precision++) {
        snprintf(text, size, "%.*g", precision, value);
        if (strtod(text, NULL) == value)
            break;
    }
    text_delocalize(text);
}

void text_from_float(float value, char *text, size_t size)
{
    for (int precision = 7; precision <= 9; precision++) {
        snprintf(text, size, "%.*g", precision, (double)value);
        if (strtof(text, NULL) == value)
            break;
    }
    text_delocalize(text);
}

size_t text_distance(const char *a, const char *b)
{
    size_t a_length = strlen(a), b_length = strlen(b);
    if (a_length > LONGEST_WORD || b_length > LONGEST_WORD)
        return SIZE_MAX;
    size_t rows[3][LONGEST_WORD + 1];
    size_t *before = rows[0], *previous = rows[1], *current = rows[2];
    for (size_t j = 0; j <= b_length; j++)
        previous[j] = j;
    for (size_t i = 1; i <= a_length; i++) {
        current[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            size_t best = previous[j - 1] + (a[i - 1] != b[j - 1]);
            if (previous[j] + 1 < best)
                best = previous[j] + 1;
            if (current[j - 1] + 1 < best)
                best = current[j - 1] + 1;
            bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped && before[j - 2] + 1 < best)
                best = before[j - 2] + 1;
            current[j] = best;
        }
        size_t *recycled = before;
        before = previous;
        previous = current;
        current = recycled;
    }
    return previous[b_length];
}

const char *text_of_size(double bytes, char text[TEXT_SIZE_LENGTH])
{
    if (bytes < 1024 * 0x1p20)
        snprintf(text, TEXT_SIZE_LENGTH, "%.0f MiB", ceil(bytes * 0x1p-20));
    else
        snprintf(text, TEXT_SIZE_LENGTH, "%.1f GiB", bytes * 0x1p-30);
    text_delocalize(text);
    return text;
}

bool text_has_suffix(const char *text, const char *suffix)
{
    size_t length = strlen(text), suffix_length = strlen(suffix);
    return length > suffix_length && strcmp(text + length - suffix_length, suffix) == 0;
}

bool text_is_near(const char *word, const char *candidate)
{
    size_t length = strlen(candidate);
    size_t tolerance = length <= 3 ? 1 : length <= 7 ? 2 : 3;
    return text_distance(word, candidate) <= tolerance;
}
