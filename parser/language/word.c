#include "parser/language/word.h"

#include "base/text.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define LONGEST_NAME ((size_t)WORD_NAME - 2) /* so that one that was cut is longer */
#define LARGEST_WHOLE 9007199254740992.0     /* 2^53: any double counts up to it in ones */

bool word_is_digit(char c)
{
    return c >= '0' && c <= '9';
}

bool word_is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

size_t word_number_length(const char *text)
{
    size_t n = 0;
    while (word_is_digit(text[n]) || text[n] == '.')
        n++;
    if (text[n] == 'e' || text[n] == 'E') {
        size_t exponent = n + 1;
        if (text[exponent] == '+' || text[exponent] == '-')
            exponent++;
        while (word_is_digit(text[exponent]))
            n = ++exponent;
    }
    return n;
}

size_t word_name_length(const char *text)
{
    size_t length = 0;
    while (word_is_letter(text[length]) || (length > 0 && word_is_digit(text[length])))
        length++;
    return length;
}

void word_copy_name(const char *text, size_t length, char name[WORD_NAME])
{
    if (length > LONGEST_NAME + 1)
        length = LONGEST_NAME + 1;
    memcpy(name, text, length);
    name[length] = '\0';
}

bool word_is_name(const char *text, char name[WORD_NAME])
{
    text += strspn(text, WORD_BLANKS);
    size_t length = word_name_length(text);
    if (length == 0 || length > LONGEST_NAME ||
        text[length + strspn(text + length, WORD_BLANKS)] != '\0')
        return false;
    word_copy_name(text, length, name);
    return true;
}

void word_write_number(double value, char text[WORD_NUMBER])
{
    if (value == floor(value) && fabs(value) <= LARGEST_WHOLE)
        snprintf(text, WORD_NUMBER, "%.0f", value + 0.0); /* -0 is 0 */
    else
        text_from_number(value, text, WORD_NUMBER);
}
